// control/condensed.py over the numbers that stack.c collects.
#include "layout.h"
#include "small.h"

// One pass: `row` (n) are the rows that count, `force` (3m) the columns of its m contacts.
typedef struct {
  int n, m;
  int row[ROWS], force[FORCES];
} Pass;

static void add_forces(Self* s, const Pass* p, int head, int n3) {
  for (int i = 0; i < 3 * p->m; i++) {
    double* H = s->H + (head + i) * n3 + head;
    const double* GG = s->GG + p->force[i] * FORCES;
    for (int j = 0; j < 3 * p->m; j++) H[j] += GG[p->force[j]];
    s->f[head + i] -= s->pull[p->force[i]];
  }
}

static void add_to_diagonal(Self* s, int from, int count, int n3, double value) {
  for (int i = from; i < from + count; i++) s->H[i * n3 + i] += value;
}

// `_full`: torques stay variables, their limits are bounds.
static int full(Self* s, const Pass* p, double weight, const Command* w, double* force,
                double* gamma, double* residual) {
  const Constants* c = &s->c;
  int nu = s->nu, m3 = 3 * p->m, k = nu + m3, n3 = k + 1;
  double *rows = s->reach, *row_weight = s->spare2;  // (n, nu + 3m)
  for (int i = 0; i < p->n; i++) {
    int at = p->row[i];
    memcpy(rows + i * k, s->solved + at * s->nv + ROOT, sizeof(double) * nu);
    for (int j = 0; j < m3; j++) rows[i * k + nu + j] = s->A[at * FORCES + p->force[j]];
    row_weight[i] = s->weight[at];
  }
  memset(s->H, 0, sizeof(double) * n3 * n3);
  memset(s->f, 0, sizeof(double) * n3);
  square(s->H, n3, rows, p->n, k, k, row_weight);
  for (int i = 0; i < p->n; i++)
    for (int j = 0; j < k; j++) s->f[j] += row_weight[i] * rows[i * k + j] * s->drift[p->row[i]];
  // H is (k, k) with leading dimension n3 here: gamma's row and column follow.
  for (int i = 0; i < nu; i++) {
    s->H[i * n3 + i] += w->pose_weight;
    s->H[i * n3 + k] = s->H[k * n3 + i] = -w->pose_weight * s->difference[i];
    s->f[i] -= w->pose_weight * s->tau_b[i];
  }
  s->H[k * n3 + k] = w->pose_weight * dot(s->difference, s->difference, nu) + weight;
  s->f[k] = w->pose_weight * dot(s->difference, s->tau_b, nu) - weight * w->blend;
  add_forces(s, p, nu, n3);
  add_to_diagonal(s, nu, m3, n3, w->contact_force);
  for (int i = 4 * p->m; i >= 0; i--) s->x[nu + i] = s->x[i];  // start from the reduced answer
  for (int i = 0; i < nu; i++)
    s->x[i] = fmin(fmax(s->torque[i], -c->torque_limit[i]), c->torque_limit[i]);
  return solve_cone(s, nu, p->m, 1, s->torque, force, gamma, residual);
}

// `solve`: one pass; where `warm`, s->x holds a guess of edges and gamma. Leaves s->x as
// [torques if they were needed, edges, gamma] and says in *head how many torques there are.
static int solve_pass(Self* s, const Pass* p, const Command* w, int warm, double* force,
                      double* gamma, double* residual, int* head) {
  const Constants* c = &s->c;
  int nu = s->nu, n = p->n, m3 = 3 * p->m, n3 = m3 + 1, ld = m3 + 2;
  double moved = w->pose_weight * dot(s->difference, s->difference, nu);
  double weight = w->blend_weight / (c->period * c->period) * fmax(1, moved);
  memset(s->H, 0, sizeof(double) * n3 * n3);
  memset(s->f, 0, sizeof(double) * n3);
  if (n) {
    for (int i = 0; i < n; i++) {
      int at = p->row[i];
      const double* B = s->solved + at * s->nv + ROOT;
      double* reach = s->reach + i * ld;
      for (int j = 0; j < m3; j++) reach[j] = s->A[at * FORCES + p->force[j]];
      for (int j = 0; j < n; j++) s->Q[i * n + j] = s->BB[at * ROWS + p->row[j]] / w->pose_weight;
      reach[m3] = dot(B, s->difference, nu);
      reach[m3 + 1] = dot(B, s->tau_b, nu) + s->drift[at];
      s->Q[i * n + i] += 1 / s->weight[at];
    }
    if (!cholesky(s->Q, n)) return FAILED;
    double back[ROWS];
    for (int i = 0; i < n; i++) {  // reach becomes L^-1 reach
      double* row = s->reach + i * ld;
      for (int k = 0; k < i; k++) back[k] = -s->Q[i * n + k];
      add_rows(row, back, s->reach, i, ld, ld);
      for (int j = 0; j < ld; j++) row[j] /= s->Q[i * n + i];
    }
    square(s->H, n3, s->reach, n, n3, ld, 0);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n3; j++) s->f[j] += s->reach[i * ld + j] * s->reach[i * ld + m3 + 1];
  }
  add_forces(s, p, 0, n3);
  add_to_diagonal(s, 0, m3, n3, w->contact_force);
  s->H[m3 * n3 + m3] += weight;
  s->f[m3] -= weight * w->blend;
  double none[1];
  *head = 0;
  if (solve_cone(s, 0, p->m, warm, none, force, gamma, residual) == FAILED) return FAILED;
  for (int i = 0; i < nu; i++) s->torque[i] = s->tau_b[i] + *gamma * s->difference[i];
  double* y = s->spare;
  for (int i = 0; i < n; i++) {
    const double* row = s->reach + i * ld;
    y[i] = dot(row, force, m3) + row[m3] * *gamma + row[m3 + 1];
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) y[i] -= s->Q[k * n + i] * y[k];
    y[i] /= s->Q[i * n + i];
    const double* B = s->solved + p->row[i] * s->nv + ROOT;
    for (int j = 0; j < nu; j++) s->torque[j] -= B[j] * (y[i] / w->pose_weight);
  }
  for (int i = 0; i < nu; i++)
    if (!(fabs(s->torque[i]) <= c->torque_limit[i] + c->slack)) {
      *head = nu;
      return full(s, p, weight, w, force, gamma, residual);
    }
  return 1;
}
