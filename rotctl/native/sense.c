// mechanics/state.py: momentum, contacts, bias, the trunk's axes.
#include "layout.h"
#include "small.h"

// Whether a body is the character's: it is the first tree, loose things on the ground follow.
static int own(const mjModel* m, int body) { return m->body_rootid[body] == 1; }

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
    r->com_velocity[i] = r->linear[i] / s->c.mass;
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
  r->count = 0;
  for (int i = 0; i < d->ncon; i++) {
    const mjContact* k = d->contact + i;
    int first = m->geom_bodyid[k->geom[0]], second = m->geom_bodyid[k->geom[1]];
    if (own(m, first) == own(m, second) || k->efc_address < 0) continue;
    if (k->dist > s->c.touch &&
        !(s->c.look_ahead && k->dist + s->c.look_ahead * d->efc_vel[k->efc_address] < 0))
      continue;
    if (r->count == CONTACTS) return FAILED;
    int j = r->count++;
    double sign = own(m, first) ? -1 : 1;
    r->body[j] = own(m, first) ? first : second;
    r->row[j] = k->efc_address;
    memcpy(r->position[j], k->pos, sizeof r->position[j]);
    for (int a = 0; a < 9; a++) r->frame[j][a] = sign * k->frame[a];
    r->friction[j][0] = k->friction[0], r->friction[j][1] = k->friction[1];
    r->gap[j] = k->dist;
  }
  return r->count;
}
