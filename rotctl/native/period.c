// simulation/episode.py: one control period of a roll, from the state to the next one.
#include <setjmp.h>

#include "layout.h"
#include "small.h"

static _Thread_local jmp_buf way_out;
static _Thread_local char* last_words;

static void give_up(const char* why) {
  strncpy(last_words, why, sizeof((Run*)0)->error - 1);
  longjmp(way_out, 1);
}

// simulation/stepping.py `complaint`, and whether the character is still over the ground.
static int in_order(const Run* run, int i) {
  const mjData* d = run->data;
  double late = fabs(d->time - i * run->period), *com = d->subtree_com + 3;
  return late <= 0.5 * run->period && rotctl_sound(run->self->m, d) && com[0] >= run->extent[0] &&
         com[0] <= run->extent[1] && fabs(com[1]) <= run->extent[2];
}

// simulation/ground_forces.py `begin`
static void begin_sums(Sums* s, const Reading* now) {
  s->count = now->count;
  s->total_peak = s->penetration = 0;
  for (int a = 0; a < 3; a++) s->total[a] = 0;
  for (int k = 0; k < now->count; k++) {
    s->body[k] = now->body[k], s->peak[k] = 0;
    for (int a = 0; a < 3; a++) {
      s->position[k][a] = now->position[k][a], s->normal[k][a] = now->frame[k][a];
      s->force[k][a] = s->now[k][a] = 0;
    }
  }
}

static void look(Run* run) {
  rotctl_ground_add(run->self->m, run->data, &run->sums);
  if (run->data->ncon >= run->most) ((void (*)(void))run->crowd)();
}

// Row `i` of the log and the control period that it is about; i periods have been before. FAILED
// before the physics moves where the reference has to take over.
static int one_period(Run* run, int i) {
  Self* s = run->self;
  mjData* d = run->data;
  RollMemory before = run->memory;
  s->mj.step1(s->m, d);
  if (!in_order(run, i) || rotctl_read(s, d, run->reading) == FAILED) return FAILED;
  roll_on(s, d, run->roll, run->reading, &run->memory, run->command);
  if (rotctl_decide(s, d, run->reading, run->command, run->answer) == FAILED) {
    run->memory = before;
    return FAILED;
  }
  put_decision(run, i);
  memcpy(d->ctrl, run->answer->torque, sizeof(double) * s->nu);
  begin_sums(&run->sums, run->reading);
  s->mj.step2(s->m, d);
  look(run);
  for (int k = 1; k < run->substeps; k++) {
    s->mj.step(s->m, d);
    look(run);
  }
  put_forces(run, i);
  run->command->blend = run->answer->blend;
  return 1;
}

// The same, where MuJoCo may give up: then `error` says why, and the data are worth nothing.
int rotctl_period(Run* run, int i) {
  void (**listener)(const char*) = run->self->mj.error;
  void (*usual)(const char*) = *listener;
  last_words = run->error;
  *listener = give_up;
  int said = setjmp(way_out) ? FAILED : one_period(run, i);
  *listener = usual;
  return said;
}
