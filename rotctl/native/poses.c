// control/pose.py: stable PD torques towards two poses.
#include "layout.h"
#include "small.h"

static void pose_torques(Self* s, mjData* d, const Command* w) {
  const mjModel* m = s->m;
  const Constants* c = &s->c;
  int nu = s->nu, nv = s->nv;
  double h = fmax(w->pose_horizon, c->period), force[2 * DOFS] = {0}, acceleration[2 * DOFS];
  if (w->pose_explicit) h = 0;
  memcpy(s->scratch->M, d->M, sizeof(mjtNum) * m->nC);
  for (int i = 0; i < nu; i++) {
    int v = i + ROOT;
    double inertia = s->diagonal[v] - c->armature[i];
    double stiffness = w->pose_stiffness * inertia, damping = w->pose_damping * inertia;
    double qd = d->qvel[v], predicted = d->qpos[v + 1] + h * qd;
    s->tau_a[i] = stiffness * (w->pose_a[i] - predicted) - damping * qd;
    s->tau_b[i] = stiffness * (w->pose_b[i] - predicted) - damping * qd;
    s->scratch->M[m->M_rowadr[v] + m->M_rownnz[v] - 1] += h * damping;
    force[v] = s->tau_a[i] - s->bias[v], force[nv + v] = s->tau_b[i] - s->bias[v];
  }
  if (w->pose_explicit) {
    for (int i = 0; i < nu; i++) s->difference[i] = s->tau_a[i] - s->tau_b[i];
    return;
  }
  for (int i = 0; i < ROOT; i++) force[i] = force[nv + i] = -s->bias[i];
  s->mj.factorM(m, s->scratch);
  s->mj.solveM(m, s->scratch, acceleration, force, 2);
  for (int i = 0; i < nu; i++) {
    int v = i + ROOT;
    double damping = h * w->pose_damping * (s->diagonal[v] - c->armature[i]);
    s->tau_a[i] -= damping * acceleration[v];
    s->tau_b[i] -= damping * acceleration[nv + v];
    s->difference[i] = s->tau_a[i] - s->tau_b[i];
  }
}
