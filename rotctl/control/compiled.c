// One control step of the condensed form with mju_boxQP, in C.
//
// The Python beside this file is the reference and says what is computed and why
// (mechanics/state.py, control/pose.py, terms.py, condensed.py, supervisor.py). This is the
// same mathematics on preallocated memory; a test holds both to the same torques. Whatever
// fails here (a solver that stops short, too many contacts) is done again by the reference,
// which alone decides whether it counts as a failure.

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>

enum { CONTACTS = 64, ROWS = 3 * CONTACTS, ROOT = 6, DOFS = 256 };
enum { FAILED = -1, AS_WRITTEN = 0, MODIFIED = 1, NO_SUPERVISOR = 2 };

// MuJoCo's functions, found by Python in the library that it has loaded already.
typedef struct {
  void (*mulM)(const mjModel*, const mjData*, mjtNum*, const mjtNum*);
  void (*solveM)(const mjModel*, mjData*, mjtNum*, const mjtNum*, int);
  void (*factorM)(const mjModel*, mjData*);
  int (*boxQP)(mjtNum*, mjtNum*, int*, const mjtNum*, const mjtNum*, int, const mjtNum*,
               const mjtNum*);
} Functions;

// Constants of a run; mirrored by `Constants` in compiled.py.
typedef struct {
  double period, friction, diagonal, tolerance, slack;
  double linear_momentum, angular_momentum, out_of_plane, pose, contact_velocity;
  double contact_force, blend;
  double linear_stiffness[3], linear_damping[3], angular_stiffness[3], angular_damping[3];
  double pose_stiffness, pose_damping;
  double threshold_force, threshold_torque, threshold_separation;
  double touch, look_ahead;
  double mass, gravity[3];
  int supervisor, trunk_count;
  int trunk[16];
  double trunk_weight[16];
  const double *torque_limit, *armature;  // (nu)
  const unsigned char* excluded;          // (nbody)
} Constants;

// What `rotctl_read` finds; mirrored by `Reading` in compiled.py.
typedef struct {
  double com[3], com_velocity[3], linear[3], angular[3], inertia[9], angular_velocity[3];
  double rotation[9], offset[3], trunk_axes[9];
  double position[CONTACTS][3], frame[CONTACTS][9], friction[CONTACTS][2];
  double gap[CONTACTS];
  int body[CONTACTS];
  long long row[CONTACTS];
  int count;
} Reading;

// What a behaviour wants; mirrored by `Wishes` in compiled.py. Poses are (nu).
typedef struct {
  double com[3], com_velocity[3], excursion_error[3], angular_velocity[3], blend;
  const double *pose_a, *pose_b;
} Wishes;

// What `rotctl_decide` decides; mirrored by `Answer` in compiled.py. Torque is (nu).
typedef struct {
  double force[CONTACTS][3];
  double rates_wanted[6], rates_predicted[6], blend, residual;
  double* torque;
  unsigned char used[CONTACTS];
} Answer;

typedef struct {
  const mjModel* m;
  mjData* scratch;
  Functions mj;
  Constants c;
  int nv, nu;
  double *bias, *diagonal;                             // (nv)
  double *jacobian, *solved;                           // (ROWS + 1, nv)
  double *tau_a, *tau_b, *difference, *torque;         // (nu)
  double *A, *BB, *GG;                                 // (ROWS, ROWS) of all candidates
  double maps[6][ROWS], drift[ROWS], pull[ROWS];       // of all candidates
  double *reach, *Q;                                   // (ROWS, ROWS + nv), (ROWS, ROWS)
  double *H, *f, *Hs, *fs, *x, *lower, *upper, *work;  // one quadratic program
  double *t1, *t2;
} Self;

// Whether a body is the character's: it is the first tree, loose things on the ground follow.
static int own(const mjModel* m, int body) { return m->body_rootid[body] == 1; }

static double dot(const double* a, const double* b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void cross(double* out, const double* a, const double* b) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static void rotate(double* out, const double* R, const double* v) {
  for (int i = 0; i < 3; i++) out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

// out (n, n), zero so far, becomes s rows' rows; rows (k, n) with leading dimension ld.
static void square(double* out, int ld_out, const double* rows, int k, int n, int ld, double s) {
  for (int r = 0; r < k; r++)
    for (int i = 0; i < n; i++) {
      double a = s * rows[r * ld + i];
      for (int j = i; j < n; j++) out[i * ld_out + j] += a * rows[r * ld + j];
    }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) out[i * ld_out + j] = out[j * ld_out + i];
}

// Cholesky factor of a (n, n) in place, lower triangle; 0 if not positive definite.
static int cholesky(double* a, int n) {
  for (int j = 0; j < n; j++) {
    double d = a[j * n + j] - dot(a + j * n, a + j * n, j);
    if (!(d > 0)) return 0;
    d = sqrt(d);
    a[j * n + j] = d;
    for (int i = j + 1; i < n; i++) a[i * n + j] = (a[i * n + j] - dot(a + i * n, a + j * n, j)) / d;
  }
  return 1;
}

int rotctl_mujoco_version(void) { return mjVERSION_HEADER; }

// Sizes that the Python side must share, so that a library built from other source is refused.
int rotctl_layout(void) {
  return 2 * sizeof(Constants) + 7 * sizeof(Reading) + 49 * sizeof(Wishes) + 343 * sizeof(Answer);
}

void rotctl_free(Self* s) {
  double* all[] = {s->bias, s->diagonal, s->jacobian, s->solved, s->tau_a,
                   s->tau_b, s->difference, s->torque, s->A, s->BB, s->GG, s->reach, s->Q,
                   s->H, s->f, s->Hs, s->fs, s->x, s->lower, s->upper, s->work, s->t1, s->t2};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
  free(s);
}

Self* rotctl_new(const mjModel* m, mjData* scratch, const Functions* mj, const Constants* c) {
  Self* s = calloc(1, sizeof(Self));
  if (!s) return 0;
  int nv = m->nv, nu = m->nu, n = nu + 4 * CONTACTS + 1;
  s->m = m, s->scratch = scratch, s->mj = *mj, s->c = *c, s->nv = nv, s->nu = nu;
  struct {
    double** p;
    size_t size;
  } need[] = {
      {&s->bias, nv}, {&s->diagonal, nv}, {&s->jacobian, (ROWS + 1) * nv},
      {&s->solved, (ROWS + 1) * nv}, {&s->tau_a, nu}, {&s->tau_b, nu}, {&s->difference, nu},
      {&s->torque, nu}, {&s->A, ROWS * ROWS}, {&s->BB, ROWS * ROWS}, {&s->GG, ROWS * ROWS},
      {&s->reach, ROWS * (ROWS + 2 + nv)}, {&s->Q, ROWS * ROWS}, {&s->H, n * n}, {&s->f, n},
      {&s->Hs, n * n}, {&s->fs, n}, {&s->x, n}, {&s->lower, n}, {&s->upper, n},
      {&s->work, n * (n + 7)}, {&s->t1, n * n}, {&s->t2, n * n}};
  for (size_t i = 0; i < sizeof need / sizeof *need; i++)
    if (!(*need[i].p = malloc(need[i].size * sizeof(double)))) {
      rotctl_free(s);
      return 0;
    }
  return s;
}

// mechanics/state.py: momentum, contacts, bias, the trunk's axes. FAILED on too many contacts.
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
    s->diagonal[i] = d->M[m->M_rowadr[i] + m->M_rownnz[i] - 1];
  }
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

// control/pose.py: stable PD torques towards two poses.
static void pose_torques(Self* s, mjData* d, const Wishes* w) {
  const mjModel* m = s->m;
  const Constants* c = &s->c;
  int nu = s->nu, nv = s->nv;
  double h = c->period, force[2 * DOFS] = {0}, acceleration[2 * DOFS];
  memcpy(s->scratch->M, d->M, sizeof(mjtNum) * m->nC);
  for (int i = 0; i < nu; i++) {
    int v = i + ROOT;
    double inertia = s->diagonal[v] - c->armature[i];
    double stiffness = c->pose_stiffness * inertia, damping = c->pose_damping * inertia;
    double qd = d->qvel[v], predicted = d->qpos[v + 1] + h * qd;
    s->tau_a[i] = stiffness * (w->pose_a[i] - predicted) - damping * qd;
    s->tau_b[i] = stiffness * (w->pose_b[i] - predicted) - damping * qd;
    s->scratch->M[m->M_rowadr[v] + m->M_rownnz[v] - 1] += h * damping;
    force[v] = s->tau_a[i] - s->bias[v], force[nv + v] = s->tau_b[i] - s->bias[v];
  }
  for (int i = 0; i < ROOT; i++) force[i] = force[nv + i] = -s->bias[i];
  s->mj.factorM(m, s->scratch);
  s->mj.solveM(m, s->scratch, acceleration, force, 2);
  for (int i = 0; i < nu; i++) {
    int v = i + ROOT;
    double damping = h * c->pose_damping * (s->diagonal[v] - c->armature[i]);
    s->tau_a[i] -= damping * acceleration[v];
    s->tau_b[i] -= damping * acceleration[nv + v];
    s->difference[i] = s->tau_a[i] - s->tau_b[i];
  }
}

// The scaled program in s->Hs, s->fs between its bounds, from and to s->x.
static int minimise(Self* s, int n, double* residual) {
  if (s->mj.boxQP(s->x, s->work, 0, s->Hs, s->fs, n, s->lower, s->upper) < 0) return FAILED;
  double worst = 0, largest = 0;
  for (int i = 0; i < n; i++) {
    double step = s->x[i] - dot(s->Hs + i * n, s->x, n) - s->fs[i];
    step = fmin(fmax(step, s->lower[i]), s->upper[i]) - s->x[i];
    worst = fmax(worst, fabs(step)), largest = fmax(largest, fabs(s->x[i]));
  }
  *residual = worst / (1 + largest);
  return *residual <= s->c.tolerance ? 1 : FAILED;
}

// One quadratic program [head, lambda, gamma] in s->H, s->f (n = head + 3m + 1), forces as
// sums of pyramid edges; the start is in s->x if `warm`. Fills tau (head), force, gamma.
static int solve_cone(Self* s, int head, int m, int warm, double* tau, double* force,
                      double* gamma, double* residual) {
  const Constants* c = &s->c;
  double mu = c->friction;
  int n3 = head + 3 * m + 1, n = head + 4 * m + 1;
  const double E[3][4] = {{1, 1, 1, 1}, {mu, mu, -mu, -mu}, {mu, -mu, mu, -mu}};
  double* half = s->t1;  // H times the edges (n3, n)
  for (int i = 0; i < n3; i++) {
    const double* row = s->H + i * n3;
    double* out = half + i * n;
    memcpy(out, row, sizeof(double) * head);
    for (int k = 0; k < m; k++)
      for (int e = 0; e < 4; e++)
        out[head + 4 * k + e] = row[head + 3 * k] * E[0][e] + row[head + 3 * k + 1] * E[1][e] +
                                row[head + 3 * k + 2] * E[2][e];
    out[n - 1] = row[n3 - 1];
  }
  double *Hs = s->Hs, *scale = s->t2;
  memcpy(Hs, half, sizeof(double) * head * n);
  memcpy(s->fs, s->f, sizeof(double) * head);
  for (int k = 0; k < m; k++)
    for (int e = 0; e < 4; e++) {
      double* out = Hs + (head + 4 * k + e) * n;
      const double* in = half + (head + 3 * k) * n;
      for (int j = 0; j < n; j++) out[j] = E[0][e] * in[j] + E[1][e] * in[n + j] + E[2][e] * in[2 * n + j];
      const double* fk = s->f + head + 3 * k;
      s->fs[head + 4 * k + e] = E[0][e] * fk[0] + E[1][e] * fk[1] + E[2][e] * fk[2];
    }
  memcpy(Hs + (n - 1) * n, half + (n3 - 1) * n, sizeof(double) * n);
  s->fs[n - 1] = s->f[n3 - 1];
  for (int i = 0; i < n; i++) scale[i] = 1 / sqrt(Hs[i * n + i] + 1e-12);
  double check = 0;
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) check += Hs[i * n + j] *= scale[i] * scale[j];
    Hs[i * n + i] += c->diagonal;
    s->fs[i] *= scale[i];
    check += s->fs[i];
    s->lower[i] = i < head ? -c->torque_limit[i] / scale[i] : 0;
    double upper = i < head ? c->torque_limit[i] : i < n - 1 ? INFINITY : 1;
    s->upper[i] = upper / scale[i];
    double x = warm ? s->x[i] / scale[i] : 0;
    s->x[i] = x < s->lower[i] ? s->lower[i] : x > s->upper[i] ? s->upper[i] : x;
  }
  if (!isfinite(check)) return FAILED;
  if (minimise(s, n, residual) == FAILED) return FAILED;
  // One proximal step: the addition to the diagonal now holds x near the solution.
  double before = *residual;
  memcpy(s->t1, s->x, sizeof(double) * n);
  for (int i = 0; i < n; i++) s->fs[i] -= c->diagonal * s->x[i];
  if (minimise(s, n, residual) == FAILED) {
    memcpy(s->x, s->t1, sizeof(double) * n);
    *residual = before;
  }
  for (int i = 0; i < n; i++) s->x[i] *= scale[i];
  memcpy(tau, s->x, sizeof(double) * head);
  for (int k = 0; k < m; k++)
    for (int a = 0; a < 3; a++) force[3 * k + a] = dot(E[a], s->x + head + 4 * k, 4);
  *gamma = s->x[n - 1];
  return 1;
}

static void add_forces(Self* s, const int* rows, int n, int head, int n3) {
  for (int i = 0; i < n; i++) {
    double* H = s->H + (head + i) * n3 + head;
    const double* GG = s->GG + rows[i] * ROWS;
    for (int j = 0; j < n; j++) H[j] += GG[rows[j]];
    H[i] += s->c.contact_force;
    s->f[head + i] -= s->pull[rows[i]];
  }
}

// control/condensed.py `_full`: torques stay variables, their limits are bounds.
static int full(Self* s, const int* rows, int m, double weight, const Wishes* w, double* force,
                double* gamma, double* residual) {
  const Constants* c = &s->c;
  int nu = s->nu, n = 3 * m, k = nu + n, n3 = k + 1;
  double velocity_weight = c->contact_velocity * c->period * c->period;
  double* velocity = s->reach;  // (n, nu + n)
  for (int i = 0; i < n; i++) {
    memcpy(velocity + i * k, s->solved + rows[i] * s->nv + ROOT, sizeof(double) * nu);
    for (int j = 0; j < n; j++) velocity[i * k + nu + j] = s->A[rows[i] * ROWS + rows[j]];
  }
  memset(s->H, 0, sizeof(double) * n3 * n3);
  memset(s->f, 0, sizeof(double) * n3);
  square(s->H, n3, velocity, n, k, k, velocity_weight);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < k; j++) s->f[j] += velocity_weight * velocity[i * k + j] * s->drift[rows[i]];
  for (int i = 0; i < nu; i++) {
    s->H[i * n3 + i] += c->pose;
    s->H[i * n3 + k] = s->H[k * n3 + i] = -c->pose * s->difference[i];
    s->f[i] -= c->pose * s->tau_b[i];
  }
  s->H[k * n3 + k] = c->pose * dot(s->difference, s->difference, nu) + weight;
  s->f[k] = c->pose * dot(s->difference, s->tau_b, nu) - weight * w->blend;
  add_forces(s, rows, n, nu, n3);
  for (int i = 4 * m; i >= 0; i--) s->x[nu + i] = s->x[i];  // start from the reduced answer
  for (int i = 0; i < nu; i++)
    s->x[i] = fmin(fmax(s->torque[i], -c->torque_limit[i]), c->torque_limit[i]);
  return solve_cone(s, nu, m, 1, s->torque, force, gamma, residual);
}

// control/condensed.py `solve`: one pass over the candidate rows `rows` (3m); where `warm`,
// s->x holds a guess of edges and gamma. Leaves s->x as [torques if they were needed, edges,
// gamma] and says in *head how many torques there are.
static int pass(Self* s, const int* rows, int m, const Wishes* w, int warm, double* force,
                double* gamma, double* residual, int* head) {
  const Constants* c = &s->c;
  int nu = s->nu, n = 3 * m, n3 = n + 1, ld = n + 2;
  double velocity_weight = c->contact_velocity * c->period * c->period;
  double weight = c->blend * fmax(1, c->pose * dot(s->difference, s->difference, nu));
  int met = m && velocity_weight > 0;
  memset(s->H, 0, sizeof(double) * n3 * n3);
  memset(s->f, 0, sizeof(double) * n3);
  if (met) {
    for (int i = 0; i < n; i++) {
      const double* B = s->solved + rows[i] * s->nv + ROOT;
      double* reach = s->reach + i * ld;
      for (int j = 0; j < n; j++) {
        reach[j] = s->A[rows[i] * ROWS + rows[j]];
        s->Q[i * n + j] = s->BB[rows[i] * ROWS + rows[j]] / c->pose;
      }
      reach[n] = dot(B, s->difference, nu);
      reach[n + 1] = dot(B, s->tau_b, nu) + s->drift[rows[i]];
      s->Q[i * n + i] += 1 / velocity_weight;
    }
    if (!cholesky(s->Q, n)) return FAILED;
    for (int i = 0; i < n; i++) {  // reach becomes L^-1 reach
      double* row = s->reach + i * ld;
      for (int k = 0; k < i; k++) {
        double l = s->Q[i * n + k];
        const double* above = s->reach + k * ld;
        for (int j = 0; j < ld; j++) row[j] -= l * above[j];
      }
      for (int j = 0; j < ld; j++) row[j] /= s->Q[i * n + i];
    }
    square(s->H, n3, s->reach, n, n3, ld, 1);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n3; j++) s->f[j] += s->reach[i * ld + j] * s->reach[i * ld + n + 1];
  }
  add_forces(s, rows, n, 0, n3);
  s->H[n * n3 + n] += weight;
  s->f[n] -= weight * w->blend;
  double none[1];
  *head = 0;
  if (solve_cone(s, 0, m, warm, none, force, gamma, residual) == FAILED) return FAILED;
  for (int i = 0; i < nu; i++) s->torque[i] = s->tau_b[i] + *gamma * s->difference[i];
  if (met) {
    double* y = s->t1;
    for (int i = 0; i < n; i++) {
      const double* row = s->reach + i * ld;
      y[i] = dot(row, force, n) + row[n] * *gamma + row[n + 1];
    }
    for (int i = n - 1; i >= 0; i--) {
      for (int k = i + 1; k < n; k++) y[i] -= s->Q[k * n + i] * y[k];
      y[i] /= s->Q[i * n + i];
      const double* B = s->solved + rows[i] * s->nv + ROOT;
      for (int j = 0; j < nu; j++) s->torque[j] -= B[j] * (y[i] / c->pose);
    }
  }
  for (int i = 0; i < nu; i++)
    if (!(fabs(s->torque[i]) <= c->torque_limit[i] + c->slack)) {
      *head = nu;
      return full(s, rows, m, weight, w, force, gamma, residual);
    }
  return 1;
}

// control/terms.py `collect`: everything over the candidates, k contacts.
static void collect(Self* s, mjData* d, const Reading* r, const int* contact, int k,
                    const double* rates) {
  const Constants* c = &s->c;
  int nv = s->nv, n = 3 * k;
  for (int i = 0; i < k; i++)
    memcpy(s->jacobian + 3 * i * nv, d->efc_J + r->row[contact[i]] * nv, sizeof(double) * 3 * nv);
  for (int v = ROOT + s->nu; v < nv; v++)  // of loose things
    for (int i = 0; i < n; i++) s->jacobian[i * nv + v] = 0;
  memcpy(s->jacobian + n * nv, s->bias, sizeof(double) * nv);
  s->mj.solveM(s->m, d, s->solved, s->jacobian, n + 1);
  const double* fall = s->solved + n * nv;
  double across = c->angular_momentum * c->out_of_plane;
  double W[6] = {c->linear_momentum, c->linear_momentum, c->linear_momentum,
                 across, c->angular_momentum, across};
  for (int i = 0; i < n; i++) {
    const double* J = s->jacobian + i * nv;
    double about[3], lever[3];
    rotate(about, r->rotation, J + 3);
    cross(lever, r->offset, J);
    s->drift[i] = 0;
    for (int v = 0; v < nv; v++) s->drift[i] += J[v] * (d->qvel[v] / c->period - fall[v]);
    if (i % 3 == 0) s->drift[i] += fmax(r->gap[contact[i / 3]], 0) / (c->period * c->period);
    s->pull[i] = 0;
    for (int a = 0; a < 6; a++) {
      s->maps[a][i] = a < 3 ? J[a] : about[a - 3] - lever[a - 3];
      double gravity = a < 3 ? c->mass * c->gravity[a] : 0;
      s->pull[i] += s->maps[a][i] * W[a] * (rates[a] - gravity);
    }
    for (int j = 0; j <= i; j++) {
      double a = dot(s->solved + i * nv, s->jacobian + j * nv, nv);
      double b = dot(s->solved + i * nv + ROOT, s->solved + j * nv + ROOT, s->nu);
      double g = 0;
      for (int q = 0; q < 6; q++) g += s->maps[q][i] * W[q] * s->maps[q][j];
      s->A[i * ROWS + j] = s->A[j * ROWS + i] = a;
      s->BB[i * ROWS + j] = s->BB[j * ROWS + i] = b;
      s->GG[i * ROWS + j] = s->GG[j * ROWS + i] = g;
    }
  }
}

// control/supervisor.py: whether contact `k` of the first pass is used in the second.
static int keeps(const Self* s, const mjData* d, int k, const double* force) {
  const Constants* c = &s->c;
  double torque[3] = {0, 0, 0}, separation = 0;
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 3; i++) torque[a] += s->maps[3 + a][3 * k + i] * force[3 * k + i];
  if (sqrt(dot(force + 3 * k, force + 3 * k, 3)) > c->threshold_force) return 1;
  if (sqrt(dot(torque, torque, 3)) > c->threshold_torque) return 1;
  if (c->supervisor == AS_WRITTEN) return 0;
  separation = dot(s->jacobian + 3 * k * s->nv, d->qvel, s->nv);
  return separation < c->threshold_separation;
}

// control/controller.py `decide`. FAILED where the reference has to take over.
int rotctl_decide(Self* s, mjData* d, const Reading* r, const Wishes* w, Answer* out) {
  const Constants* c = &s->c;
  double acceleration[3], *rates = out->rates_wanted;
  for (int a = 0; a < 3; a++) {
    rates[a] = c->mass * (c->linear_stiffness[a] * (w->com[a] - r->com[a]) +
                          c->linear_damping[a] * (w->com_velocity[a] - r->com_velocity[a]));
    acceleration[a] = c->angular_stiffness[a] * w->excursion_error[a] +
                      c->angular_damping[a] * (w->angular_velocity[a] - r->angular_velocity[a]);
  }
  rotate(rates + 3, r->inertia, acceleration);
  pose_torques(s, d, w);
  int contact[CONTACTS], rows[ROWS], kept[CONTACTS], k = 0, m = 0;
  memset(out->used, 0, sizeof out->used);
  memset(out->force, 0, sizeof(double) * 3 * r->count);
  for (int i = 0; i < r->count; i++)
    if (!c->excluded[r->body[i]]) contact[k++] = i;
  collect(s, d, r, contact, k, rates);
  for (int i = 0; i < 3 * k; i++) rows[i] = i;
  double force[ROWS], gamma;
  int head;
  if (pass(s, rows, k, w, 0, force, &gamma, &out->residual, &head) == FAILED) return FAILED;
  for (int i = 0; i < k; i++)
    if (c->supervisor == NO_SUPERVISOR || keeps(s, d, i, force)) kept[m++] = i;
  if (m < k) {
    for (int i = 0; i < m; i++) {  // edges only move down: kept[i] >= i
      for (int a = 0; a < 3; a++) rows[3 * i + a] = 3 * kept[i] + a;
      for (int e = 0; e < 4; e++) s->x[4 * i + e] = s->x[head + 4 * kept[i] + e];
    }
    s->x[4 * m] = gamma;
    if (pass(s, rows, m, w, 1, force, &gamma, &out->residual, &head) == FAILED) return FAILED;
  }
  for (int i = 0; i < s->nu; i++) {
    if (!isfinite(s->torque[i])) return FAILED;
    out->torque[i] = fmin(fmax(s->torque[i], -c->torque_limit[i]), c->torque_limit[i]);
  }
  out->blend = fmin(fmax(gamma, 0), 1);
  for (int a = 0; a < 6; a++) {
    out->rates_predicted[a] = a < 3 ? c->mass * c->gravity[a] : 0;
    for (int i = 0; i < 3 * m; i++) out->rates_predicted[a] += s->maps[a][rows[i]] * force[i];
  }
  for (int i = 0; i < m; i++) {
    int at = contact[kept[i]];
    const double* F = r->frame[at];
    out->used[at] = 1;
    for (int j = 0; j < 3; j++)
      out->force[at][j] = F[j] * force[3 * i] + F[3 + j] * force[3 * i + 1] + F[6 + j] * force[3 * i + 2];
  }
  return r->count;
}
