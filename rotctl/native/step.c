// One control step of the condensed form, in C.
//
// The Python that each file here names is the reference and says what is computed and why. This
// is the same mathematics on preallocated memory; a test holds both to the same torques. Whatever
// fails here (a solver that stops short, too many contacts, a kind that is not here) is done
// again by the reference, which alone decides whether it counts as a failure.

#include "layout.h"
#include "small.h"

#include "sense.c"
#include "ground_forces.c"

#include "kinds.c"
#include "poses.c"
#include "stack.c"

#include "active_set.c"
#include "cone.c"
#include "condensed.c"
#include "pgs.c"

#ifndef ROTCTL_SOURCE
#define ROTCTL_SOURCE "unknown"
#endif

// So that a library built from other source, or for another MuJoCo, is refused.
const char* rotctl_source(void) { return ROTCTL_SOURCE; }
int rotctl_mujoco_version(void) { return mjVERSION_HEADER; }

void rotctl_free(Self* s) {
  double* all[] = {s->bias, s->diagonal, s->jacobian, s->solved, s->tau_a, s->tau_b,
                   s->difference, s->torque, s->A, s->BB, s->GG, s->reach, s->Q, s->H, s->f,
                   s->Hs, s->fs, s->x, s->lower, s->upper, s->work, s->spare, s->spare2};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
  free(s);
}

Self* rotctl_new(const mjModel* m, mjData* scratch, const Functions* mj, const Constants* c,
                 const Kind* kind, const unsigned char* motion) {
  Self* s = calloc(1, sizeof(Self));
  if (!s) return 0;
  int nv = m->nv, nu = m->nu, n = nu + 4 * CONTACTS + 1;
  s->m = m, s->scratch = scratch, s->mj = *mj, s->c = *c, s->nv = nv, s->nu = nu;
  s->kind = kind, s->motion = motion;
  struct {
    double** p;
    size_t size;
  } need[] = {
      {&s->bias, nv}, {&s->diagonal, nv}, {&s->jacobian, (ROWS + 1) * nv},
      {&s->solved, (ROWS + 1) * nv}, {&s->tau_a, nu}, {&s->tau_b, nu}, {&s->difference, nu},
      {&s->torque, nu}, {&s->A, ROWS * FORCES}, {&s->BB, ROWS * ROWS}, {&s->GG, FORCES * FORCES},
      {&s->reach, ROWS * (FORCES + 2 + nv)}, {&s->Q, ROWS * ROWS}, {&s->H, n * n}, {&s->f, n},
      {&s->Hs, n * n}, {&s->fs, n}, {&s->x, n}, {&s->lower, n}, {&s->upper, n},
      {&s->work, n * (n + 7)}, {&s->spare, n * n}, {&s->spare2, n * n}};
  for (size_t i = 0; i < sizeof need / sizeof *need; i++)
    if (!(*need[i].p = malloc(need[i].size * sizeof(double)))) {
      rotctl_free(s);
      return 0;
    }
  return s;
}

// control/supervisor.py: whether candidate `k` of the first pass is used in the second.
static int keeps(const Self* s, const mjData* d, const Command* w, int k, const double* force) {
  double torque[3] = {0, 0, 0};
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 3; i++) torque[a] += s->maps[3 + a][3 * k + i] * force[3 * k + i];
  if (sqrt(dot(force + 3 * k, force + 3 * k, 3)) > w->threshold_force) return 1;
  if (sqrt(dot(torque, torque, 3)) > w->threshold_torque) return 1;
  if (w->supervisor == AS_WRITTEN) return 0;
  return dot(s->jacobian + 3 * k * s->nv, d->qvel, s->nv) < w->threshold_separation;
}

// What a pass over the contacts `kept` (m of k) counts: their rows and the tasks', if they weigh.
static void choose(const Self* s, Pass* p, const int* kept, int m, int k) {
  p->n = 0, p->m = m;
  for (int i = 0; i < 3 * m; i++) {
    p->force[i] = 3 * kept[i / 3] + i % 3;
    if (s->weight[p->force[i]] > 0) p->row[p->n++] = p->force[i];
  }
  for (int i = 3 * k; i < 3 * k + s->motion_rows; i++)
    if (s->weight[i] > 0) p->row[p->n++] = i;
}

// What the tasks were to give, and what the decision gives them.
static void tell(const Self* s, const Pass* p, const Command* w, const double* force, Answer* out) {
  double rates[6];
  for (int a = 0; a < 6; a++) {
    rates[a] = s->free_rates[a];
    for (int i = 0; i < 3 * p->m; i++) rates[a] += s->maps[a][p->force[i]] * force[i];
    out->rates_predicted[a] = rates[a], out->rates_wanted[a] = 0;
  }
  for (int t = 0; t < w->tasks; t++) {
    int over_motion = s->motion[w->task[t].kind];
    for (int i = 0; i < 3; i++) out->predicted[t][i] = 0;
    for (int i = 0; i < s->row_count[t] && i < 3; i++) {
      int at = s->first_row[t] + i;
      double sum = 0;
      if (over_motion) {
        sum = s->drift[at] + s->wanted[at] + dot(s->solved + at * s->nv + ROOT, out->torque, s->nu);
        for (int j = 0; j < 3 * p->m; j++) sum += s->A[at * FORCES + p->force[j]] * force[j];
      } else {
        sum = dot(s->rate_rows[at], rates, 6);
        for (int a = 0; a < 6; a++) out->rates_wanted[a] += s->rate_rows[at][a] * s->rate_wanted[at];
      }
      out->predicted[t][i] = sum;
    }
  }
}

// Whether a contact may not be used; control/task.py `candidates`.
static int holds_out(const mjData* d, const Reading* r, const Command* w, int contact) {
  int body = r->body[contact];
  if (w->held_out[body] || !w->behind) return w->held_out[body];
  const double *place = d->xpos + 3 * body, *axes = d->xmat + 9 * body, *p = r->position[contact];
  double x = (p[0] - place[0]) * axes[0], y = (p[1] - place[1]) * axes[3];
  return x + y + (p[2] - place[2]) * axes[6] < w->behind[body];
}

// control/controller.py `decide`. FAILED where the reference has to take over.
int rotctl_decide(Self* s, mjData* d, const Reading* r, const Command* w, Answer* out) {
  const Constants* c = &s->c;
  int contact[CONTACTS], kept[CONTACTS], k = 0, m = 0, head;
  double force[FORCES], gamma;
  Pass pass;
  if (w->tasks > TASKS || !(w->pose_weight > 0)) return FAILED;
  pose_torques(s, d, w);
  memset(out->used, 0, sizeof out->used);
  memset(out->force, 0, sizeof(double) * 3 * r->count);
  for (int i = 0; i < r->count; i++)
    if (!holds_out(d, r, w, i)) kept[k] = k, contact[k++] = i;
  if (collect(s, d, r, contact, k, w, out) == FAILED) return FAILED;
  choose(s, &pass, kept, k, k);
  if (solve_pass(s, &pass, w, 0, force, &gamma, &out->residual, &head) == FAILED) return FAILED;
  for (int i = 0; i < k; i++)
    if (w->supervisor == NO_SUPERVISOR || keeps(s, d, w, i, force)) kept[m++] = i;
  if (m < k) {
    for (int i = 0; i < m; i++)  // edges only move down: kept[i] >= i
      for (int e = 0; e < 4; e++) s->x[4 * i + e] = s->x[head + 4 * kept[i] + e];
    s->x[4 * m] = gamma;
    choose(s, &pass, kept, m, k);
    if (solve_pass(s, &pass, w, 1, force, &gamma, &out->residual, &head) == FAILED) return FAILED;
  }
  for (int i = 0; i < s->nu; i++) {
    if (!isfinite(s->torque[i])) return FAILED;
    out->torque[i] = fmin(fmax(s->torque[i], -c->torque_limit[i]), c->torque_limit[i]);
  }
  out->blend = fmin(fmax(gamma, 0), 1);
  tell(s, &pass, w, force, out);
  for (int i = 0; i < m; i++) {
    int at = contact[kept[i]];
    const double* F = s->frame[kept[i]];
    out->used[at] = 1;
    rotate_back(out->force[at], F, force + 3 * i);
  }
  return r->count;
}

#include "pace.c"
#include "roll.c"

#include "row.c"
#include "period.c"

#include "skeleton.c"
