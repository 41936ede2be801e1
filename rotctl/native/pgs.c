// simulation/pgs.py `solve`: projected Gauss-Seidel.
#include <math.h>
#include <string.h>

// Comparisons are written so that what is not a number passes through them.
static double projected(double x, int normal, double most) {
  if (normal < 0) return x < 0 ? 0 : x;
  return x > most ? most : x < -most ? -most : x;
}

// p and bound (n) are zero at the start; w (n) is for its use.
int rotctl_pgs(int n, const double* A, const double* b, const int* normal,
               const double* friction, int sweeps, double tolerance, double follow, double* p,
               double* bound, double* w, double* residual) {
  int sweep = 0;
  double change = INFINITY;
  memcpy(w, b, sizeof(double) * n);
  while (sweep < sweeps && !(change <= tolerance)) {
    change = 0;
    for (int i = 0; i < n; i++) {
      if (normal[i] >= 0) bound[i] += follow * (friction[i] * p[normal[i]] - bound[i]);
      const double* row = A + i * n;
      double step = projected(p[i] - w[i] / row[i], normal[i], bound[i]) - p[i];
      if (step == 0) continue;
      for (int j = 0; j < n; j++) w[j] += step * row[j];
      change = fmax(change, fabs(step) * row[i]);
      p[i] += step;
    }
    sweep++;
  }
  *residual = 0;
  for (int i = 0; i < n; i++) {
    double most = normal[i] < 0 ? 0 : friction[i] * p[normal[i]];
    double step = projected(p[i] - w[i] / A[i * n + i], normal[i], most) - p[i];
    *residual = fmax(*residual, fabs(step) * A[i * n + i]);
  }
  return sweep;
}
