// control/stack.py `collect`: everything over the candidate contacts and the tasks.
#include "layout.h"
#include "small.h"

// The contact's rows with its tangents turned about the normal until the first is along `forward`.
static void align(double* F, double* J, int nv, const double* forward) {
  double c = dot(forward, F + 3, 3), e = dot(forward, F + 6, 3);
  double length = sqrt(c * c + e * e);
  if (length < 1e-9) return;
  c /= length, e /= length;
  for (int i = 0; i < 3; i++) {
    double first = F[3 + i], second = F[6 + i];
    F[3 + i] = c * first + e * second, F[6 + i] = c * second - e * first;
  }
  for (int v = 0; v < nv; v++) {
    double first = J[nv + v], second = J[2 * nv + v];
    J[nv + v] = c * first + e * second, J[2 * nv + v] = c * second - e * first;
  }
}

// Rates of [L, H] that a generalised force on the root (6) brings about.
static void to_rates(const Reading* r, const double* root, double* rates) {
  double about[3], lever[3];
  rotate(about, r->rotation, root + 3);
  cross(lever, r->offset, root);
  for (int a = 0; a < 3; a++) rates[a] = root[a], rates[3 + a] = about[a] - lever[a];
}

// What [L, H] do without contacts: gravity, and the forces from outside that control knows of.
static void fall_free(Self* s, const mjData* d, const Reading* r) {
  for (int a = 0; a < 3; a++)
    s->free_rates[a] = s->c.mass * s->c.gravity[a], s->free_rates[3 + a] = 0;
  if (!s->c.sees_disturbance) return;
  double outside[ROOT], rates[6];
  for (int i = 0; i < ROOT; i++) outside[i] = d->qfrc_bias[i] - s->bias[i];
  to_rates(r, outside, rates);
  for (int a = 0; a < 6; a++) s->free_rates[a] += rates[a];
}

// The tasks' rows: those over qddot after the `from` rows of contacts, the others by themselves.
static int collect_tasks(Self* s, const mjData* d, const Reading* r, const Command* w, int from,
                         Answer* out) {
  int most = s->nu > 3 ? s->nu : 3;  // rows of a kind of motion; one of momentum has 3
  s->momenta = s->motion_rows = 0;
  for (int t = 0; t < w->tasks; t++) {
    const Task* task = w->task + t;
    Kind kind = s->kind[task->kind];
    if (!kind) return FAILED;
    int over_motion = s->motion[task->kind], nv = s->nv;
    int* count = over_motion ? &s->motion_rows : &s->momenta;
    int first = over_motion ? from + *count : *count;
    if (over_motion ? *count + most > MOTION_ROWS : *count + 3 > MOMENTA) return FAILED;
    double* rows = over_motion ? s->jacobian + first * nv : s->rate_rows[first];
    double* wanted = over_motion ? s->wanted + first : s->rate_wanted + first;
    double* weight = over_motion ? s->weight + first : s->rate_weight + first;
    for (int a = 0; a < 3; a++) out->error[t][a] = out->wanted[t][a] = 0;
    int k = kind(s, d, r, task, rows, wanted, weight, out->error[t]);
    for (int i = 0; i < k && i < 3; i++) out->wanted[t][i] = wanted[i];
    s->first_row[t] = first, s->row_count[t] = k;
    *count += k;
  }
  return 1;
}

// Takes Jdot qdot of a contact, along its frame F, from what is wanted of it.
static void turn_with(const Self* s, const mjData* d, const Reading* r, int contact,
                      const double* F, double* wanted) {
  int nv = s->nv;
  double moving[3 * DOFS], a[3];
  s->mj.jacDot(s->m, d, moving, 0, r->position[contact], r->body[contact]);
  for (int i = 0; i < 3; i++) a[i] = dot(moving + i * nv, d->qvel, nv);
  for (int i = 0; i < 3; i++) wanted[i] -= dot(F + 3 * i, a, 3);
}

// Rows of k candidate contacts, then of the tasks; returns how many there are, or FAILED.
static int collect(Self* s, mjData* d, const Reading* r, const int* contact, int k,
                   const Command* w, Answer* out) {
  const Constants* c = &s->c;
  int nv = s->nv, m3 = 3 * k;
  double damping = fmin(w->contact_damping, 1 / c->period);
  for (int i = 0; i < k; i++) {
    double* J = s->jacobian + 3 * i * nv;
    memcpy(J, d->efc_J + r->row[contact[i]] * nv, sizeof(double) * 3 * nv);
    memcpy(s->frame[i], r->frame[contact[i]], sizeof s->frame[i]);
    align(s->frame[i], J, nv, w->forward);
    for (int a = 0; a < 3; a++) {
      double* row = J + a * nv;
      for (int v = ROOT + s->nu; v < nv; v++) row[v] = 0;  // of loose things
      s->wanted[3 * i + a] = -damping * dot(row, d->qvel, nv);
      s->weight[3 * i + a] = w->contact_weight;
    }
    s->wanted[3 * i] -= damping * damping * fmax(r->gap[contact[i]], 0);
    if (w->contact_centripetal) turn_with(s, d, r, contact[i], s->frame[i], s->wanted + 3 * i);
  }
  if (collect_tasks(s, d, r, w, m3, out) == FAILED) return FAILED;
  int n = m3 + s->motion_rows;
  memcpy(s->jacobian + n * nv, s->bias, sizeof(double) * nv);
  s->mj.solveM(s->m, d, s->solved, s->jacobian, n + 1);
  const double* fall = s->solved + n * nv;
  fall_free(s, d, r);
  for (int i = 0; i < n; i++) {
    const double* J = s->jacobian + i * nv;
    s->drift[i] = -dot(J, fall, nv) - s->wanted[i];
    for (int j = 0; j < m3 && j <= i; j++) {
      double a = dot(s->solved + i * nv, s->jacobian + j * nv, nv);
      s->A[i * FORCES + j] = a;
      if (i < m3) s->A[j * FORCES + i] = a;
    }
    for (int j = 0; j <= i; j++)
      s->BB[i * ROWS + j] = s->BB[j * ROWS + i] =
          dot(s->solved + i * nv + ROOT, s->solved + j * nv + ROOT, s->nu);
  }
  double push[MOMENTA][FORCES];  // the momentum rows over contact forces
  for (int i = 0; i < m3; i++) {
    double rates[6];
    to_rates(r, s->jacobian + i * nv, rates);
    s->pull[i] = 0;
    for (int a = 0; a < 6; a++) s->maps[a][i] = rates[a];
    for (int q = 0; q < s->momenta; q++) {
      push[q][i] = 0;
      for (int a = 0; a < 6; a++) push[q][i] += s->rate_rows[q][a] * s->maps[a][i];
    }
  }
  for (int q = 0; q < s->momenta; q++) {
    double miss = s->rate_wanted[q];
    for (int a = 0; a < 6; a++) miss -= s->rate_rows[q][a] * s->free_rates[a];
    for (int i = 0; i < m3; i++) s->pull[i] += push[q][i] * s->rate_weight[q] * miss;
  }
  for (int i = 0; i < m3; i++)
    for (int j = 0; j <= i; j++) {
      double g = 0;
      for (int q = 0; q < s->momenta; q++) g += push[q][i] * s->rate_weight[q] * push[q][j];
      s->GG[i * FORCES + j] = s->GG[j * FORCES + i] = g;
    }
  return n;
}
