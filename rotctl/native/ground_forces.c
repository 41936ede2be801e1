// simulation/ground_forces.py: adds up what the ground does to the character.
#include "layout.h"
#include "small.h"

static double length(const double* v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The nearest slot of that body; a new one if it has none; -1 if there is no room.
static int slot(Sums* s, int body, const double* position, const double* normal, double sign) {
  int nearest = -1;
  double least = INFINITY;
  for (int i = 0; i < s->count; i++) {
    if (s->body[i] != body) continue;
    double d[3] = {s->position[i][0] - position[0], s->position[i][1] - position[1],
                   s->position[i][2] - position[2]};
    double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (squared < least) least = squared, nearest = i;
  }
  if (nearest >= 0 || s->count == SLOTS) return nearest;
  int i = s->count++;
  s->body[i] = body;
  s->peak[i] = 0;
  for (int a = 0; a < 3; a++) {
    s->position[i][a] = position[a], s->normal[i][a] = sign * normal[a];
    s->force[i][a] = s->now[i][a] = 0;
  }
  return i;
}

// Normal and two tangential forces of a contact of three dimensions.
static void decode(const mjModel* m, const mjContact* k, const double* row, double* local) {
  if (m->opt.cone == mjCONE_ELLIPTIC) {
    memcpy(local, row, 3 * sizeof *local);
    return;
  }
  local[0] = row[0] + row[1] + row[2] + row[3];
  local[1] = k->friction[0] * (row[0] - row[1]);
  local[2] = k->friction[1] * (row[2] - row[3]);
}

// simulation/stepping.py `trouble`: whether there is no warning and all is finite.
int rotctl_sound(const mjModel* m, const mjData* d) {
  for (int i = 0; i < mjNWARNING; i++)
    if (d->warning[i].number) return 0;
  for (int i = 0; i < m->nq; i++)
    if (!isfinite(d->qpos[i])) return 0;
  for (int i = 0; i < m->nv; i++)
    if (!isfinite(d->qvel[i])) return 0;
  return 1;
}

// One physics step has been made; its contacts and forces are still in `d`.
void rotctl_ground_add(const mjModel* m, const mjData* d, Sums* s) {
  double sum[3] = {0};
  for (int i = 0; i < d->ncon; i++) {
    const mjContact* k = d->contact + i;
    int first = m->geom_bodyid[k->geom[0]], second = m->geom_bodyid[k->geom[1]];
    int is_first = own(m, first);
    if (is_first == own(m, second) || k->efc_address < 0) continue;
    s->penetration = fmax(s->penetration, -k->dist);
    double local[3], force[3], sign = is_first ? -1 : 1;
    decode(m, k, d->efc_force + k->efc_address, local);
    if (local[0] == 0 && local[1] == 0 && local[2] == 0) continue;
    for (int a = 0; a < 3; a++) {
      const double* f = k->frame + a;
      force[a] = sign * (f[0] * local[0] + f[3] * local[1] + f[6] * local[2]);
      sum[a] += force[a];
    }
    int at = slot(s, is_first ? first : second, k->pos, k->frame, sign);
    for (int a = 0; at >= 0 && a < 3; a++) s->now[at][a] += force[a];
  }
  for (int i = 0; i < s->count; i++) {
    s->peak[i] = fmax(s->peak[i], length(s->now[i]));
    for (int a = 0; a < 3; a++) s->force[i][a] += s->now[i][a], s->now[i][a] = 0;
  }
  for (int a = 0; a < 3; a++) s->total[a] += sum[a];
  s->total_peak = fmax(s->total_peak, length(sum));
}
