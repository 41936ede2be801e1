// Projected Gauss-Seidel; `solve` in pgs.py is the reference and says what is solved.

#include <math.h>

// Changes with the arguments below, so that a library built from other source is refused.
int rotctl_pgs_interface(void) { return 2; }

// Comparisons are written so that what is not a number passes through them.
static double projected(int i, int n, const double* A, const double* b, const int* normal,
                        double most, const double* p) {
  double w = b[i];
  for (int j = 0; j < n; j++) w += A[i * n + j] * p[j];
  double x = p[i] - w / A[i * n + i];
  if (normal[i] < 0) return x < 0 ? 0 : x;
  return x > most ? most : x < -most ? -most : x;
}

static double coulomb(int i, const int* normal, const double* friction, const double* p) {
  return normal[i] < 0 ? 0 : friction[i] * p[normal[i]];
}

// p and bound (n) are zero at the start.
int rotctl_pgs(int n, const double* A, const double* b, const int* normal,
               const double* friction, int sweeps, double tolerance, double follow, double* p,
               double* bound, double* residual) {
  int sweep = 0;
  double change = INFINITY;
  while (sweep < sweeps && !(change <= tolerance)) {
    change = 0;
    for (int i = 0; i < n; i++) {
      bound[i] += follow * (coulomb(i, normal, friction, p) - bound[i]);
      double x = projected(i, n, A, b, normal, bound[i], p);
      change = fmax(change, fabs(x - p[i]) * A[i * n + i]);
      p[i] = x;
    }
    sweep++;
  }
  *residual = 0;
  for (int i = 0; i < n; i++) {
    double x = projected(i, n, A, b, normal, coulomb(i, normal, friction, p), p);
    *residual = fmax(*residual, fabs(x - p[i]) * A[i * n + i]);
  }
  return sweep;
}
