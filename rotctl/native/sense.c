// mechanics/state.py: momentum, contacts, bias, the trunk's axes.
#include "layout.h"
#include "small.h"

// Whether a body is the character's: it is the first tree, loose things on the ground follow.
static int own(const mjModel* m, int body) { return m->body_rootid[body] == 1; }

// A contact of the character's `body`; sign turns its frame out of the ground.
typedef struct {
  const mjContact* at;
  int body;
  double sign;
} Seen;

// mechanics/merging.py: whether two contacts are one to control.
static int are_one(const Constants* c, const Seen* a, const Seen* b) {
  double square = 0, parallel = 0;
  for (int i = 0; i < 3; i++) {
    double d = a->at->pos[i] - b->at->pos[i];
    square += d * d;
    parallel += a->sign * a->at->frame[i] * (b->sign * b->at->frame[i]);
  }
  return a->body == b->body && square < c->merge_distance * c->merge_distance &&
         parallel >= c->merge_parallel;
}

// mechanics/merging.py `merged`: keeps the deepest of those that are one. Returns how many.
static int merge(const Constants* c, Seen* seen, int n) {
  int order[SEEN], kept = 0;  // deepest first
  unsigned char taken[SEEN] = {0};
  for (int i = 0; i < n; i++) {
    int k = i;
    for (; k > 0 && seen[order[k - 1]].at->dist > seen[i].at->dist; k--) order[k] = order[k - 1];
    order[k] = i;
  }
  for (int k = 0; k < n; k++) {
    int other = 0;
    while (other < n && !(taken[other] && are_one(c, seen + order[k], seen + other))) other++;
    taken[order[k]] = other == n;
  }
  for (int i = 0; i < n; i++)
    if (taken[i]) seen[kept++] = seen[i];
  return kept;
}

// FAILED on too many contacts.
int rotctl_read(Self* s, mjData* d, Reading* r) {
  const mjModel* m = s->m;
  int nv = s->nv;
  double p[DOFS], about[3];
  if (nv > DOFS) return FAILED;
  s->mj.mulM(m, d, p, d->qvel);
  memcpy(r->rotation, d->xmat + 9, sizeof r->rotation);
  memcpy(r->com, d->subtree_com + 3, sizeof r->com);
  for (int i = 0; i < 3; i++) r->offset[i] = r->com[i] - d->qpos[i], r->linear[i] = p[i];
  rotate(r->angular, r->rotation, p + 3);
  cross(about, r->offset, r->linear);
  for (int i = 0; i < 3; i++) {
    r->angular[i] -= about[i];
    r->com_velocity[i] = r->linear[i] / m->body_subtreemass[1];  // what it weighs now
  }
  const double* I = d->crb + 10;
  double xx = I[0], yy = I[1], zz = I[2], xy = I[3], xz = I[4], yz = I[5];
  double full[9] = {xx, xy, xz, xy, yy, yz, xz, yz, zz};
  memcpy(r->inertia, full, sizeof full);
  double L[9];
  memcpy(L, full, sizeof full);
  cholesky(L, 3);
  double* w = r->angular_velocity;
  for (int i = 0; i < 3; i++) w[i] = (r->angular[i] - dot(L + 3 * i, w, i)) / L[4 * i];
  for (int i = 2; i >= 0; i--) {
    for (int k = i + 1; k < 3; k++) w[i] -= L[3 * k + i] * w[k];
    w[i] /= L[4 * i];
  }
  double* axes = r->trunk_axes;
  memset(axes, 0, sizeof r->trunk_axes);
  for (int t = 0; t < s->c.trunk_count; t++)
    for (int i = 0; i < 9; i++) axes[i] += d->xmat[9 * s->c.trunk[t] + i] * s->c.trunk_weight[t];
  for (int k = 0; k < 3; k++) {
    double length = sqrt(axes[k] * axes[k] + axes[3 + k] * axes[3 + k] + axes[6 + k] * axes[6 + k]);
    for (int i = 0; i < 3; i++) axes[3 * i + k] /= length;
  }
  for (int i = 0; i < nv; i++) {
    s->bias[i] = d->qfrc_bias[i] - d->qfrc_passive[i];
    if (!s->c.sees_disturbance) s->bias[i] += d->qfrc_fluid[i];
    s->diagonal[i] = d->M[m->M_rowadr[i] + m->M_rownnz[i] - 1];
  }
  if (s->c.sees_disturbance) {
    double pushed[DOFS] = {0};
    for (int b = 1; b < m->nbody; b++) {
      const double* x = d->xfrc_applied + 6 * b;
      if (x[0] || x[1] || x[2] || x[3] || x[4] || x[5])
        s->mj.applyFT(m, d, x, x + 3, d->xipos + 3 * b, b, pushed);
    }
    for (int i = 0; i < nv; i++) s->bias[i] -= pushed[i];
  }
  memcpy(r->bias, s->bias, sizeof(double) * nv);
  Seen seen[SEEN];
  int n = 0;
  for (int i = 0; i < d->ncon; i++) {
    const mjContact* k = d->contact + i;
    int first = m->geom_bodyid[k->geom[0]], second = m->geom_bodyid[k->geom[1]];
    if (own(m, first) == own(m, second) || k->efc_address < 0) continue;
    if (k->dist > s->c.touch &&
        !(s->c.look_ahead && k->dist + s->c.look_ahead * d->efc_vel[k->efc_address] < 0))
      continue;
    if (n == SEEN) return FAILED;
    seen[n++] = own(m, first) ? (Seen){k, first, -1} : (Seen){k, second, 1};
  }
  r->count = merge(&s->c, seen, n);
  if (r->count > CONTACTS) return FAILED;
  for (int j = 0; j < r->count; j++) {
    const mjContact* k = seen[j].at;
    r->body[j] = seen[j].body;
    r->row[j] = k->efc_address;
    memcpy(r->position[j], k->pos, sizeof r->position[j]);
    for (int a = 0; a < 9; a++) r->frame[j][a] = seen[j].sign * k->frame[a];
    r->friction[j][0] = k->friction[0], r->friction[j][1] = k->friction[1];
    r->gap[j] = k->dist;
  }
  return r->count;
}
