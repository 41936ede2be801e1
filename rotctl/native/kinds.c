// control/kinds.py: each kind of objective is one function of its name.
#include "layout.h"
#include "small.h"

// Along the task's axes: the error, and what acceleration, stiffness and damping ask for.
static void wish(const Task* t, const double* missing, const double* velocity, double* wanted,
                 double* error) {
  double slip[3], slip_along[3], along[3];
  for (int i = 0; i < 3; i++) slip[i] = t->velocity[i] - velocity[i];
  rotate(error, t->axes, missing);
  rotate(slip_along, t->axes, slip);
  rotate(along, t->axes, t->acceleration);
  for (int i = 0; i < 3; i++)
    wanted[i] = along[i] + t->stiffness[i] * error[i] + t->damping[i] * slip_along[i];
}

int rotctl_kind_linear(const Self* s, const mjData* d, const Reading* r, const Task* t, double* rows,
                       double* wanted, double* weight, double* error) {
  (void)d;
  double missing[3];
  for (int i = 0; i < 3; i++) missing[i] = t->target[i] - r->com[i];
  wish(t, missing, r->com_velocity, wanted, error);
  for (int i = 0; i < 3; i++) {
    wanted[i] *= s->c.mass, weight[i] = t->weight[i];
    for (int j = 0; j < 3; j++) rows[6 * i + j] = t->axes[3 * i + j], rows[6 * i + 3 + j] = 0;
  }
  return 3;
}

int rotctl_kind_spin(const Self* s, const mjData* d, const Reading* r, const Task* t, double* rows,
                     double* wanted, double* weight, double* error) {
  (void)s, (void)d;
  double along[3], world[3], rate[3];
  wish(t, t->target, r->angular_velocity, along, error);
  rotate_back(world, t->axes, along);
  rotate(rate, r->inertia, world);
  rotate(wanted, t->axes, rate);
  for (int i = 0; i < 3; i++) {
    weight[i] = t->weight[i];
    for (int j = 0; j < 3; j++) rows[6 * i + j] = 0, rows[6 * i + 3 + j] = t->axes[3 * i + j];
  }
  return 3;
}

int rotctl_kind_angular_momentum(const Self* s, const mjData* d, const Reading* r, const Task* t,
                                 double* rows, double* wanted, double* weight, double* error) {
  (void)s, (void)d;
  double turning[3], world[3], rate[3], along[3], missing[3], slip[3];
  rotate(error, t->axes, t->target);
  rotate(turning, t->axes, t->acceleration);
  for (int i = 0; i < 3; i++) {
    turning[i] += t->stiffness[i] * error[i];
    missing[i] = t->velocity[i] - r->angular[i];
  }
  rotate(slip, t->axes, missing);
  rotate_back(world, t->axes, turning);
  rotate(rate, r->inertia, world);
  rotate(along, t->axes, rate);
  for (int i = 0; i < 3; i++) {
    wanted[i] = along[i] + t->damping[i] * slip[i];
    weight[i] = t->weight[i];
    for (int j = 0; j < 3; j++) rows[6 * i + j] = 0, rows[6 * i + 3 + j] = t->axes[3 * i + j];
  }
  return 3;
}

// Rows of a Jacobian J (3, nv) along the axes, and what they should give, less dJ/dt qdot.
static int motion(const Self* s, const mjData* d, const Task* t, const double* J,
                  const double* J_dot, const double* missing, double* rows, double* wanted,
                  double* weight, double* error) {
  int nv = s->nv;
  double velocity[3], rest[3], rest_along[3];
  for (int i = 0; i < 3; i++) {
    velocity[i] = dot(J + i * nv, d->qvel, nv);
    rest[i] = dot(J_dot + i * nv, d->qvel, nv);
    weight[i] = t->weight[i];
  }
  wish(t, missing, velocity, wanted, error);
  rotate(rest_along, t->axes, rest);
  for (int i = 0; i < 3; i++) {
    wanted[i] -= rest_along[i];
    for (int v = 0; v < nv; v++)
      rows[i * nv + v] = t->axes[3 * i] * J[v] + t->axes[3 * i + 1] * J[nv + v] +
                         t->axes[3 * i + 2] * J[2 * nv + v];
  }
  return 3;
}

int rotctl_kind_point(const Self* s, const mjData* d, const Reading* r, const Task* t, double* rows,
                      double* wanted, double* weight, double* error) {
  (void)r;
  double place[3], missing[3], J[3 * DOFS], J_dot[3 * DOFS];
  rotate(place, d->xmat + 9 * t->body, t->point);
  for (int i = 0; i < 3; i++) {
    place[i] += d->xpos[3 * t->body + i];
    missing[i] = t->target[i] - place[i];
  }
  s->mj.jac(s->m, d, J, 0, place, t->body);
  s->mj.jacDot(s->m, d, J_dot, 0, place, t->body);
  return motion(s, d, t, J, J_dot, missing, rows, wanted, weight, error);
}

int rotctl_kind_attitude(const Self* s, const mjData* d, const Reading* r, const Task* t,
                         double* rows, double* wanted, double* weight, double* error) {
  (void)r;
  double missing[3], J[3 * DOFS], J_dot[3 * DOFS];
  rotation_to(missing, d->xquat + 4 * t->body, t->target);
  s->mj.jac(s->m, d, 0, J, d->xpos + 3 * t->body, t->body);
  s->mj.jacDot(s->m, d, 0, J_dot, d->xpos + 3 * t->body, t->body);
  return motion(s, d, t, J, J_dot, missing, rows, wanted, weight, error);
}

int rotctl_kind_limits(const Self* s, const mjData* d, const Reading* r, const Task* t, double* rows,
                       double* wanted, double* weight, double* error) {
  (void)r;
  int k = 0;
  double margin = t->point[0];
  error[1] = 0;
  for (int i = 0; i < s->nu; i++) {
    double q = d->qpos[i + ROOT + 1], low = s->c.joint_range[2 * i], high = s->c.joint_range[2 * i + 1];
    double back = fmax(low + margin - q, 0) - fmax(q - high + margin, 0);
    if (back == 0) continue;
    memset(rows + k * s->nv, 0, sizeof(double) * s->nv);
    rows[k * s->nv + i + ROOT] = 1;
    wanted[k] = t->stiffness[0] * back - t->damping[0] * d->qvel[i + ROOT];
    weight[k] = t->weight[0] * fmin(fabs(back) / margin, 1);
    error[1] = fmax(error[1], fabs(back));
    k++;
  }
  error[0] = k, error[2] = 0;
  return k;
}

int rotctl_kind_joints(const Self* s, const mjData* d, const Reading* r, const Task* t, double* rows,
                       double* wanted, double* weight, double* error) {
  (void)r;
  int first = s->m->body_jntadr[t->body], count = s->m->body_jntnum[t->body];
  error[0] = error[1] = error[2] = 0;
  if (t->body == 1 || count == 0) return 0;
  int angle = s->m->jnt_qposadr[first], dof = s->m->jnt_dofadr[first];
  memset(rows, 0, sizeof(double) * count * s->nv);
  for (int i = 0; i < count; i++) {
    rows[i * s->nv + dof + i] = 1;
    error[i] = t->target[i] - d->qpos[angle + i];
    wanted[i] = t->acceleration[i] + t->stiffness[i] * error[i] +
                t->damping[i] * (t->velocity[i] - d->qvel[dof + i]);
    weight[i] = t->weight[i];
  }
  return count;
}
