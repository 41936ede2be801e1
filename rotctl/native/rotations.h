// maths/rotations.py on plain numbers: quaternions are (w, x, y, z), every sum in Python's order.
#ifndef ROTCTL_ROTATIONS_H
#define ROTCTL_ROTATIONS_H

#include <math.h>

// Python's x % y for a positive y.
static inline double modulo(double x, double y) {
  double rest = fmod(x, y);
  return rest < 0 ? rest + y : rest;
}

static inline double along(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// `rotated`
static inline void turn_vector(double* out, const double* q, const double* v) {
  double w = q[0], x = q[1], y = q[2], z = q[3], a = v[0], b = v[1], c = v[2];
  double ta = 2 * (y * c - z * b), tb = 2 * (z * a - x * c), tc = 2 * (x * b - y * a);
  out[0] = a + w * ta + y * tc - z * tb;
  out[1] = b + w * tb + z * ta - x * tc;
  out[2] = c + w * tc + x * tb - y * ta;
}

// `advanced`: q is turned by a rotation vector.
static inline void turn_on(double* out, const double* q, const double* vector) {
  double x = vector[0], y = vector[1], z = vector[2], w = 1;
  double angle = sqrt(x * x + y * y + z * z);
  if (angle < 1e-12) {
    x = y = z = 0;
  } else {
    double scale = sin(0.5 * angle) / angle;
    w = cos(0.5 * angle), x = scale * x, y = scale * y, z = scale * z;
  }
  double a = q[0], b = q[1], c = q[2], d = q[3];
  double turned[4] = {w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                      w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a};
  double length = sqrt(turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] +
                       turned[3] * turned[3]);
  for (int i = 0; i < 4; i++) out[i] = turned[i] / length;
}

// `rotation_between`
static inline void turn_between(double* out, const double* start, const double* end) {
  double across[3] = {start[1] * end[2] - start[2] * end[1], start[2] * end[0] - start[0] * end[2],
                      start[0] * end[1] - start[1] * end[0]};
  double sine = sqrt(along(across, across)), scale = 0;
  if (sine >= 1e-12) scale = atan2(sine, along(start, end)) / sine;
  for (int i = 0; i < 3; i++) out[i] = sine < 1e-12 ? 0 : across[i] * scale;
}

#endif
