// control/cone.py: one quadratic program with forces in their cone.
#include "layout.h"
#include "small.h"

// The scaled program in s->Hs, s->fs between its bounds, from and to s->x.
static int minimise(Self* s, Free* free, double* residual) {
  int n = free->n;
  if (descend(s, free) == FAILED) return FAILED;
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
  double* half = s->spare;  // H times the edges (n3, n)
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
  double *Hs = s->Hs, *scale = s->spare2;
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
  int at[UNKNOWNS];
  Free free = {n, 0, at, s->work, s->work + n * n, s->work + n * n + n};
  if (!begin_free(s, &free) || minimise(s, &free, residual) == FAILED) return FAILED;
  // One proximal step: the addition to the diagonal now holds x near the solution.
  double before = *residual;
  memcpy(s->spare, s->x, sizeof(double) * n);
  for (int i = 0; i < n; i++) s->fs[i] -= c->diagonal * s->x[i];
  if (minimise(s, &free, residual) == FAILED) {
    memcpy(s->x, s->spare, sizeof(double) * n);
    *residual = before;
  }
  for (int i = 0; i < n; i++) s->x[i] *= scale[i];
  memcpy(tau, s->x, sizeof(double) * head);
  for (int k = 0; k < m; k++)
    for (int a = 0; a < 3; a++) force[3 * k + a] = dot(E[a], s->x + head + 4 * k, 4);
  *gamma = s->x[n - 1];
  return 1;
}
