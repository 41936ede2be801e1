// qp/active_set.py: a primal active-set method for bounds, with one factor that grows and shrinks.
//
// Forces start at zero and few edges ever carry, so that the factor of the free variables' Hessian
// stays small, however many contacts there are; one variable more is one row more.
#include "layout.h"
#include "small.h"

enum { STEPS = 30 };                             // allowed, per variable
static const double WRONG = 1e-9, SMALL = 1e-13;  // a multiplier that is rounding; so of a pivot

// The free variables, in the order of the factor's rows, and the slope at x: H x + f.
typedef struct {
  int n, count;
  int* at;
  double *factor, *slope, *way;
} Free;

// Row k of the factor; 0 if that variable's Hessian beside the others' is not positive.
static int add_row(const Self* s, const Free* free, int k) {
  int n = free->n;
  double *row = free->factor + k * n, pivot;
  const double* H = s->Hs + free->at[k] * n;
  for (int j = 0; j < k; j++) {
    const double* above = free->factor + j * n;
    row[j] = (H[free->at[j]] - dot(row, above, j)) / above[j];
  }
  pivot = H[free->at[k]] - dot(row, row, k);
  if (!(pivot > SMALL)) return 0;
  row[k] = sqrt(pivot);
  return 1;
}

// The factor without row r, by rotations of its columns.
static void drop_row(const Free* free, int r) {
  int n = free->n, last = free->count - 1;
  double* L = free->factor;
  for (int k = r; k < last; k++) {
    free->at[k] = free->at[k + 1];
    memcpy(L + k * n, L + (k + 1) * n, sizeof(double) * (k + 2));
  }
  for (int c = r; c < last; c++) {
    double a = L[c * n + c], b = L[c * n + c + 1], length = sqrt(a * a + b * b);
    a /= length, b /= length;
    for (int k = c; k < last; k++) {
      double left = L[k * n + c], right = L[k * n + c + 1];
      L[k * n + c] = a * left + b * right, L[k * n + c + 1] = a * right - b * left;
    }
  }
}

// Towards the minimum of the free variables; along those before `from` there is no slope.
static void head_for(const Free* free, int from) {
  int n = free->n;
  double* way = free->way;
  memset(way, 0, sizeof(double) * from);
  for (int i = from; i < free->count; i++) {
    const double* row = free->factor + i * n;
    way[i] = (-free->slope[free->at[i]] - dot(row + from, way + from, i - from)) / row[i];
  }
  for (int i = free->count - 1; i >= 0; i--) {
    const double* row = free->factor + i * n;
    way[i] /= row[i];
    for (int j = 0; j < i; j++) way[j] -= row[j] * way[i];
  }
}

// As far as the first bound, if one is met: then it is the place of that variable, else -1.
static int go(Self* s, const Free* free) {
  int n = free->n, first = -1;
  double reach = 1;
  for (int i = 0; i < free->count; i++) {
    double way = free->way[i], x = s->x[free->at[i]];
    if (way == 0) continue;
    double ahead = (way < 0 ? s->lower[free->at[i]] : s->upper[free->at[i]]) - x;
    if (ahead / way < reach) reach = ahead / way, first = i;
  }
  for (int i = 0; i < free->count; i++) {
    int at = free->at[i];
    double step = reach * free->way[i];
    s->x[at] = fmin(fmax(s->x[at] + step, s->lower[at]), s->upper[at]);
    for (int j = 0; j < n; j++) free->slope[j] += step * s->Hs[at * n + j];
  }
  if (first >= 0) {
    int at = free->at[first];
    s->x[at] = free->way[first] < 0 ? s->lower[at] : s->upper[at];
  }
  return first;
}

// The bound that holds back most, or -1 where none does.
static int most_wrong(const Self* s, const Free* free, double slack) {
  int worst = -1;
  for (int i = 0; i < free->n; i++) {
    double pull = s->x[i] <= s->lower[i]   ? -free->slope[i]
                  : s->x[i] >= s->upper[i] ? free->slope[i]
                                           : 0;
    int is_free = 0;
    if (pull <= slack) continue;
    for (int k = 0; k < free->count; k++) is_free |= free->at[k] == i;
    if (!is_free) slack = pull, worst = i;
  }
  return worst;
}

// From s->x inside the bounds to the minimum, or as far as the steps go; FAILED where a Hessian is
// not positive definite. The free variables stay for the next call.
static int descend(Self* s, Free* free) {
  int n = free->n;
  double largest = 0;
  for (int i = 0; i < n; i++) {
    free->slope[i] = dot(s->Hs + i * n, s->x, n) + s->fs[i];
    largest = fmax(largest, fabs(s->fs[i]));
  }
  for (int step = 0, from = 0; step < STEPS * n; step++) {
    head_for(free, from);
    int met = go(s, free);
    if (met >= 0) {
      drop_row(free, met);
      free->count--;
      if (from > met) from--;
      continue;
    }
    int next = most_wrong(s, free, WRONG * (1 + largest));
    if (next < 0) break;
    from = free->count;
    free->at[from] = next;
    if (!add_row(s, free, from)) return FAILED;
    free->count++;
  }
  return 1;
}

// The free variables of a start s->x; 0 where their Hessian is not positive definite.
static int begin_free(const Self* s, Free* free) {
  for (int i = 0; i < free->n; i++) {
    if (!(s->x[i] > s->lower[i] && s->x[i] < s->upper[i])) continue;
    free->at[free->count] = i;
    if (!add_row(s, free, free->count)) return 0;
    free->count++;
  }
  return 1;
}
