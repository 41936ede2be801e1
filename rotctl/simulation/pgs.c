// Projected Gauss-Seidel; `solve` in pgs.py is the reference and says what is solved.

#include <math.h>

// Changes with the arguments below, so that a library built from other source is refused.
int rotctl_pgs_interface(void) { return 1; }

// Comparisons are written so that what is not a number passes through them.
static double projected(int i, int n, const double* A, const double* b, const int* normal,
                        const double* friction, const double* p) {
  double w = b[i];
  for (int j = 0; j < n; j++) w += A[i * n + j] * p[j];
  double x = p[i] - w / A[i * n + i];
  if (normal[i] < 0) return x < 0 ? 0 : x;
  double most = friction[i] * p[normal[i]];
  return x > most ? most : x < -most ? -most : x;
}

int rotctl_pgs(int n, const double* A, const double* b, const int* normal,
               const double* friction, int sweeps, double tolerance, double* p,
               double* residual) {
  int sweep = 0;
  double change = INFINITY;
  while (sweep < sweeps && !(change <= tolerance)) {
    change = 0;
    for (int i = 0; i < n; i++) {
      double x = projected(i, n, A, b, normal, friction, p);
      change = fmax(change, fabs(x - p[i]) * A[i * n + i]);
      p[i] = x;
    }
    sweep++;
  }
  *residual = 0;
  for (int i = 0; i < n; i++) {
    double x = projected(i, n, A, b, normal, friction, p);
    *residual = fmax(*residual, fabs(x - p[i]) * A[i * n + i]);
  }
  return sweep;
}
