// Arithmetic on small arrays. Every sum has one order, whatever compiler and processor.
#ifndef ROTCTL_SMALL_H
#define ROTCTL_SMALL_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"

// Four running sums: an order that a compiler may carry out four at a time.
static inline double dot(const double* a, const double* b, int n) {
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    s0 += a[i] * b[i], s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2], s3 += a[i + 3] * b[i + 3];
  }
  for (; i < n; i++) s0 += a[i] * b[i];
  return (s0 + s1) + (s2 + s3);
}

static inline void cross(double* out, const double* a, const double* b) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// out = R v
static inline void rotate(double* out, const double* R, const double* v) {
  for (int i = 0; i < 3; i++) out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

// out = R' v
static inline void rotate_back(double* out, const double* R, const double* v) {
  for (int i = 0; i < 3; i++) out[i] = R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2];
}

// The shortest rotation vector that turns one unit quaternion into another, world axes.
static inline void rotation_to(double* out, const double* start, const double* end) {
  double w = start[0], x = -start[1], y = -start[2], z = -start[3];
  double turn[4] = {end[0] * w - end[1] * x - end[2] * y - end[3] * z,
                    end[0] * x + end[1] * w + end[2] * z - end[3] * y,
                    end[0] * y - end[1] * z + end[2] * w + end[3] * x,
                    end[0] * z + end[1] * y - end[2] * x + end[3] * w};
  double sine = sqrt(turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
  double angle = 2 * atan2(sine, fabs(turn[0])), scale = 0;
  if (sine >= 1e-12) scale = turn[0] >= 0 ? angle / sine : -angle / sine;
  for (int i = 0; i < 3; i++) out[i] = scale * turn[1 + i];
}

// out (n) += a (k) times rows (k, n) with leading dimension ld; four rows at a time, as the sums
// are mostly waited for.
static inline void add_rows(double* out, const double* a, const double* rows, int k, int n,
                            int ld) {
  int r = 0;
  for (; r + 4 <= k; r += 4) {
    const double *r0 = rows + r * ld, *r1 = r0 + ld, *r2 = r1 + ld, *r3 = r2 + ld;
    double a0 = a[r], a1 = a[r + 1], a2 = a[r + 2], a3 = a[r + 3];
    for (int j = 0; j < n; j++) out[j] += (a0 * r0[j] + a1 * r1[j]) + (a2 * r2[j] + a3 * r3[j]);
  }
  for (; r < k; r++)
    for (int j = 0; j < n; j++) out[j] += a[r] * rows[r * ld + j];
}

// out (n, n), zero so far, becomes rows' W rows; rows (k, n) with leading dimension ld; no
// weights are ones.
static inline void square(double* out, int ld_out, const double* rows, int k, int n, int ld,
                          const double* weight) {
  double column[ROWS];
  for (int i = 0; i < n; i++) {
    for (int r = 0; r < k; r++) column[r] = (weight ? weight[r] : 1) * rows[r * ld + i];
    add_rows(out + i * ld_out + i, column, rows + i, k, n - i, ld);
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) out[i * ld_out + j] = out[j * ld_out + i];
}

// Cholesky factor of a (n, n) in place, lower triangle; 0 if not positive definite.
static inline int cholesky(double* a, int n) {
  for (int j = 0; j < n; j++) {
    double d = a[j * n + j] - dot(a + j * n, a + j * n, j);
    if (!(d > 0)) return 0;
    d = sqrt(d);
    a[j * n + j] = d;
    for (int i = j + 1; i < n; i++) a[i * n + j] = (a[i * n + j] - dot(a + i * n, a + j * n, j)) / d;
  }
  return 1;
}

#endif
