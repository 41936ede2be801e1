// behaviours/rolling/remembering.py with mechanics/excursion.py: what a roll remembers;
// behaviours/rolling/rolling.py: what it wants.
#include "layout.h"
#include "rotations.h"
#include "small.h"

// motion/pose_pair.py `over_phase`
static double over_phase(const double* waves, int count, double phase) {
  double total = waves[0];
  for (int n = 1; 2 * n < count; n++)
    total += waves[2 * n - 1] * cos(n * phase) + waves[2 * n] * sin(n * phase);
  return total;
}

// behaviours/rolling/obliqueness.py: the trunk's axis that should stay on the rolling axis
static void incline(const Roll* r, const double* trunk, RollMemory* it) {
  double tilt = over_phase(r->oblique, r->oblique_waves, it->phase) * (mjPI / 180);
  for (int i = 0; i < 3; i++) it->axis[i] = cos(tilt) * it->axis[i] + sin(tilt) * trunk[3 * i + 2];
}

// `integrate` and `keep_phase`: the memory of one control period later.
static void turn_along(const Roll* r, const Reading* now, RollMemory* it) {
  const double *left = r->axes + 3, *trunk = now->trunk_axes;
  double turn[3], orientation[4], carried[3], off[3], across[3];
  for (int i = 0; i < 3; i++) {
    turn[i] = now->angular_velocity[i] * r->period;
    it->axis[i] = trunk[3 * i + r->column] * r->sign;
  }
  if (r->oblique_waves) incline(r, trunk, it);
  turn_on(orientation, it->orientation, turn);
  turn_vector(carried, orientation, left);
  cross(off, carried, it->axis);
  double pull = fmin(1, r->period / r->correction_time);
  for (int i = 0; i < 3; i++) off[i] *= pull, it->angle[i] += turn[i];
  turn_on(it->orientation, orientation, off);
  double front[3] = {trunk[0], trunk[3], trunk[6]};
  cross(across, r->front, front);
  double turned = atan2(along(left, across), along(r->front, front)) + r->slope;
  double phase = it->phase + along(left, turn);
  double drift = modulo(turned - phase + mjPI, 2 * mjPI) - mjPI;
  it->phase = phase + drift * fmin(1, r->period / r->phase_time);
}

// `error`: what is missing to the wanted excursion.
static void missing_turn(const Roll* r, const RollMemory* it, double time, double* missing) {
  const double* left = r->axes + 3;
  double difference[3], carried[3], across[3];
  for (int i = 0; i < 3; i++)
    difference[i] = it->first_angle[i] + time * r->angular_velocity[i] - it->angle[i];
  memcpy(missing, difference, sizeof difference);
  if (r->integral) return;
  turn_vector(carried, it->orientation, left);
  turn_between(across, carried, left);
  double plain = along(left, difference);
  for (int i = 0; i < 3; i++) missing[i] = across[i] + left[i] * plain;
}

// motion/reference.py and motion/pose_pair.py `at`: both poses (2, nu) at a phase.
static void poses_at(const Roll* r, double phase, int nu, double* a, double* b) {
  double* pose[2] = {a, b};
  if (r->rows) {
    double place = modulo(phase / (2 * mjPI), 1) * r->rows;
    int row = place < r->rows ? (int)place : r->rows - 1;
    const double *from = r->table + 2 * row * nu, *rise = r->rise + 2 * row * nu;
    for (int p = 0; p < 2; p++)
      for (int i = 0; i < nu; i++)
        pose[p][i] = from[p * nu + i] + (place - row) * rise[p * nu + i];
    return;
  }
  double wave[WAVES] = {1};
  for (int n = 1; 2 * n < r->waves; n++)
    wave[2 * n - 1] = cos(n * phase), wave[2 * n] = sin(n * phase);
  for (int p = 0; p < 2; p++) {
    const double* rows = r->coefficients + r->waves * p * nu;
    for (int i = 0; i < nu; i++) {
      double angle = rows[i];
      for (int n = 1; n < r->waves; n++) angle += wave[n] * rows[n * nu + i];
      pose[p][i] = fmin(fmax(angle, r->low[i]), r->high[i]);
    }
  }
}

// behaviours/rolling/catching.py `share`, `rise` and `spread`
static void spread(const Catch* c, const Reading* now, const RollMemory* it, double* pose) {
  const double* turning = now->angular_velocity;
  double rate = turning[0] * it->axis[1] - turning[1] * it->axis[0];
  double rise = it->axis[2] + c->lead * rate;
  for (int side = 0; side < 2; side++) {
    double share = fmin(fmax(c->gain * ((side ? rise : -rise) - c->free), 0), 1);
    for (int i = 0; i < c->count; i++) {
      int motor = c->motor[side * c->count + i];
      if (motor < 0) continue;
      double angle = pose[motor], out = angle + share * c->out[i];
      pose[motor] = fmin(fmax(out, fmin(c->low[motor], angle)), fmax(c->high[motor], angle));
    }
  }
}

// behaviours/rolling/alighting.py `turns` and `moved`, of both poses
static void alight(const Alighting* g, const mjData* d, const Roll* r, const Reading* now,
                   const RollMemory* it, double* a, double* b) {
  const double *left = r->axes + 3, *middle = d->subtree_com + 3;
  double ahead = g->lead * along(left, now->com_velocity), lean[3], *pose[2] = {a, b};
  for (int i = 0; i < 3; i++) lean[i] = it->axis[i] - left[i];
  for (int limb = 0, first = 0; limb < g->limbs; first = g->end[limb++]) {
    const double *place = d->xipos + 3 * g->body[limb], *moving = d->cvel + 6 * g->body[limb];
    double off[3], turned[3], way[3], arm[8], scale = g->reach * g->reach;
    for (int i = 0; i < 3; i++) off[i] = place[i] - middle[i], way[i] = place[i] - now->com[i];
    cross(turned, moving, off);
    double share = fmin(fmax(-(moving[5] + turned[2]) / g->sinking, 0), 1);
    double missing = share * (ahead + along(way, lean));
    for (int k = first; k < g->end[limb]; k++) {
      const double* anchor = d->xanchor + 3 * g->joint[k];
      for (int i = 0; i < 3; i++) off[i] = place[i] - anchor[i];
      cross(turned, d->xaxis + 3 * g->joint[k], off);
      arm[k - first] = along(left, turned);
      scale += arm[k - first] * arm[k - first];
    }
    for (int k = first; k < g->end[limb]; k++) {
      int motor = g->motor[k];
      double by = fmin(fmax(arm[k - first] * missing / scale, -g->most), g->most);
      for (int p = 0; p < 2; p++) {
        double angle = pose[p][motor], low = fmin(g->low[motor], angle);
        pose[p][motor] = fmin(fmax(angle + by, low), fmax(g->high[motor], angle));
      }
    }
  }
}

// behaviours/rolling/waiting.py `settled`
static void settle(const double* angles, double waits, int nu, double* pose) {
  for (int i = 0; i < nu; i++) {
    if (!isnan(angles[i])) pose[i] += waits * (angles[i] - pose[i]);
  }
}

// `advance` and `command`: `it` is the memory of the period before, and then of this one.
static void roll_on(const Self* s, const mjData* d, const Roll* r, const Reading* now,
                    RollMemory* it, const Command* w) {
  turn_along(r, now, it);
  double back = 0, waits = 0;
  double* up = r->task[0].velocity + 2;
  *up = r->velocity[2];
  if (r->pace) keep_pace(r, d, now, it, &back, &waits);
  if (r->lift_waves) {
    double turns = along(r->axes + 3, now->angular_velocity) / (2 * mjPI);
    *up += turns * over_phase(r->lift, r->lift_waves, it->phase);
  }
  poses_at(r, it->phase - back, s->nu, w->pose_a, w->pose_b);
  if (r->waiting) {
    settle(r->waiting, waits, s->nu, w->pose_a);
    settle(r->waiting, waits, s->nu, w->pose_b);
  }
  if (r->catch) spread(r->catch, now, it, w->pose_a), spread(r->catch, now, it, w->pose_b);
  if (r->alighting) alight(r->alighting, d, r, now, it, w->pose_a, w->pose_b);
  for (int i = 0; i < 3; i++) r->task[0].target[i] = it->origin[i] + d->time * r->velocity[i];
  missing_turn(r, it, d->time, r->task[1].target);
}
