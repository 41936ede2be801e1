// behaviours/rolling/pacing.py: what a pace asks for at one instant, put into a roll's tasks.
#include "layout.h"
#include "rotations.h"
#include "small.h"

static const double SLIP = 0.5, TURN = 2 * mjPI;

// `commanded`
static double commanded(const Pace* p, double time) {
  int i = 0;
  while (i < p->changes && p->times[i] <= time) i++;
  return p->rates[i];
}

static double ahead(const Roll* r, const mjData* d, const Reading* now) {
  double from[3];
  for (int i = 0; i < 3; i++) {
    double middle = d->xipos[3 * r->pace->over[0] + i];
    for (int k = 1; k < r->pace->count; k++) middle += d->xipos[3 * r->pace->over[k] + i];
    from[i] = now->com[i] - middle / r->pace->count;
  }
  return along(r->axes, from);
}

// `tick`
static void tick(const Roll* r, const mjData* d, const Reading* now, RollMemory* it) {
  const Pace* p = r->pace;
  double way[3], come = along(r->axes + 3, it->angle) / TURN;
  for (int i = 0; i < 3; i++) way[i] = now->com[i] - it->origin[i];
  if (p->by_speed) come = along(r->axes, way) / p->travel;
  double asked = commanded(p, d->time), late = it->due + asked * r->period - come;
  it->late = asked ? fmin(fmax(late, -p->patience), SLIP) : 0;
  it->due = come + it->late;
}

// `_brake`; an easing of 0 is none
static double brake_of(const Pace* p, double asked, double speed) {
  if (asked || !p->easing) return p->brake;
  return 1 + (p->brake - 1) * fmin(fabs(speed) / p->easing, 1);
}

// `_near`
static double near(double before, double width) {
  return fabs(before) < width ? 0.5 + 0.5 * cos(mjPI * before / width) : 0;
}

// `at`; `back` is how far the poses go back [rad], `waiting` how far they come to that of a wait
static void keep_pace(const Roll* r, const mjData* d, const Reading* now, RollMemory* it, double* back,
                      double* waiting) {
  const Pace* p = r->pace;
  tick(r, d, now, it);
  double turn = it->phase / TURN, before = modulo(p->wait - turn + 0.5, 1) - 0.5;
  double here = near(before, p->width);
  double asked = commanded(p, d->time);
  double share = asked ? fmin(fmax(1 + p->gain * it->late, 0), p->most) : 0;
  double early = fmax(1 - share, 0), flow = fmax(p->own, asked) * (1 - p->calm * early);
  double base = flow * (1 + (fmax(share, 1) - 1) * here);
  double rate = base * (1 - p->swing * cos(TURN * (turn - p->swing_from)));
  double speed = p->travel * base * (1 - p->surge * cos(TURN * (turn - p->surge_from)));
  double waits = early * near(before, before > 0 ? p->approach : p->leave);
  double brake = 1 + waits * (brake_of(p, asked, along(r->axes, now->com_velocity)) - 1);
  rate += waits * (p->settling[0] * before - rate);
  speed += waits * (p->settling[1] * (p->ahead - ahead(r, d, now)) - speed);
  for (int i = 0; i < 3; i++) {
    r->task[0].velocity[i] = speed * r->way[i];
    r->task[1].velocity[i] = TURN * rate * r->axes[3 + i];
    r->task[0].damping[i] = p->usual[i] * (i == 0 ? brake : 1);
    r->task[1].damping[i] = p->usual[3 + i] * (i == 1 ? brake : 1);
  }
  *back = TURN * (waits * p->back);
  double slow = fmin(fmax(1 - along(r->axes + 3, now->angular_velocity) / TURN / flow, 0), 1);
  *waiting = fmax(early * near(before, before > 0 ? p->width : p->leave), slow * near(before, p->approach));
}
