// simulation/record.py: one control period as a row of the log. What a compiled period never
// has (a fallback, a disturbance) stays zero, as it was allocated.
#include "layout.h"
#include "small.h"

static void put(double* column, int i, const double* from, int n) {
  memcpy(column + (size_t)i * n, from, sizeof(double) * n);
}

static void put_single(float* column, int slots, const double* from, int n) {
  for (int k = 0; k < slots * n; k++) column[k] = (float)from[k];
}

// Before the physics moves: the state, what was wanted of it and what was decided.
static void put_decision(const Run* run, int i) {
  const Rows* to = run->rows;
  const mjModel* m = run->self->m;
  const mjData* d = run->data;
  const Reading* now = run->reading;
  const Answer* said = run->answer;
  const RollMemory* it = &run->memory;
  put(to->time, i, &d->time, 1);
  put(to->qpos, i, d->qpos, m->nq);
  put(to->qvel, i, d->qvel, m->nv);
  put(to->ctrl, i, said->torque, m->nu);
  put(to->com, i, now->com, 3);
  put(to->com_velocity, i, now->com_velocity, 3);
  put(to->linear_momentum, i, now->linear, 3);
  put(to->angular_momentum, i, now->angular, 3);
  put(to->angular_velocity, i, now->angular_velocity, 3);
  put(to->angular_excursion, i, it->angle, 3);
  put(to->linear_momentum_rate_desired, i, said->rates_wanted, 3);
  put(to->angular_momentum_rate_desired, i, said->rates_wanted + 3, 3);
  put(to->linear_momentum_rate_predicted, i, said->rates_predicted, 3);
  put(to->angular_momentum_rate_predicted, i, said->rates_predicted + 3, 3);
  put(to->blend, i, &said->blend, 1);
  put(to->phase, i, &it->phase, 1);
  put(to->trunk_axis, i, it->axis, 3);
  put(to->trunk_axes, i, now->trunk_axes, 9);
  put(to->axes, i, run->roll->axes, 9);
  for (int t = 0; t < to->tasks; t++) {
    int at = i * to->tasks + t;
    put(to->target, at, run->command->task[t].target, 4);
    put(to->velocity, at, run->command->task[t].velocity, 3);
    put(to->error, at, said->error[t], 3);
    put(to->wanted, at, said->wanted[t], 3);
    put(to->predicted, at, said->predicted[t], 3);
  }
  int slots = now->count < to->capacity ? now->count : to->capacity;
  size_t first = (size_t)i * to->capacity;
  to->count[i] = now->count;
  put_single(to->force_predicted + 3 * first, slots, said->force[0], 3);
  memcpy(to->used + first, said->used, slots);
  put(to->residual, i, &said->residual, 1);
}

// After it: what the ground did.
static void put_forces(const Run* run, int i) {
  const Rows* to = run->rows;
  const Sums* sums = &run->sums;
  int slots = sums->count < to->capacity ? sums->count : to->capacity;
  size_t first = (size_t)i * to->capacity;
  memcpy(to->body + first, sums->body, sizeof(int) * slots);
  put_single(to->position + 3 * first, slots, sums->position[0], 3);
  put_single(to->normal + 3 * first, slots, sums->normal[0], 3);
  put_single(to->force_peak + first, slots, sums->peak, 1);
  for (int k = 0; k < slots; k++)
    for (int a = 0; a < 3; a++)
      to->force_realised[3 * (first + k) + a] = (float)(sums->force[k][a] / run->substeps);
  for (int a = 0; a < 3; a++) to->ground_force[3 * i + a] = sums->total[a] / run->substeps;
  put(to->ground_force_peak, i, &sums->total_peak, 1);
  put(to->penetration, i, &sums->penetration, 1);
}
