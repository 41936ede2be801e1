// metrics/skeleton.py and metrics/capsules.py: where bodies are in every row of a log and how deep capsules
// overlap, in the order of their sums.
#include "layout.h"
#include "small.h"

typedef struct {
  double w, x, y, z;
} Turn;

static Turn hinged(Turn t, const double* axis, double angle) {
  double half = 0.5 * angle, d = cos(half), sine = sin(half);
  double a = sine * axis[0], b = sine * axis[1], c = sine * axis[2];
  return (Turn){
      t.w * d - t.x * a - t.y * b - t.z * c, t.w * a + t.x * d + t.y * c - t.z * b,
      t.w * b + t.y * d + t.z * a - t.x * c, t.w * c + t.z * d + t.x * b - t.y * a};
}

static void turned(double* out, Turn t, const double* point) {
  double a = 2 * point[0], b = 2 * point[1], c = 2 * point[2];
  double p = t.y * c - t.z * b, q = t.z * a - t.x * c, r = t.x * b - t.y * a;
  out[0] = (t.w * p + t.y * r - t.z * q) + point[0];
  out[1] = (t.w * q + t.z * p - t.x * r) + point[1];
  out[2] = (t.w * r + t.x * q - t.y * p) + point[2];
}

// qpos is (n, nq); place (3, nbody, n) and turn (4, nbody, n) are filled.
void rotctl_skeleton(const mjModel* m, int n, const double* qpos, double* place, double* turn) {
  int size = m->nbody * n;
  for (int body = 0; body < m->nbody; body++) {
    int joint = m->body_jntadr[body], parent = m->body_parentid[body];
    int loose = joint >= 0 && m->jnt_type[joint] == mjJNT_FREE;
    for (int row = 0; row < n; row++) {
      const double* q = qpos + row * m->nq;
      int at = body * n + row, above = parent * n + row;
      double moved[3] = {0};
      Turn t = {1, 0, 0, 0};
      if (loose) {
        const double* own = q + m->jnt_qposadr[joint];
        memcpy(moved, own, sizeof moved);
        t = (Turn){own[3], own[4], own[5], own[6]};
      } else if (body) {
        t = (Turn){turn[above], turn[size + above], turn[2 * size + above], turn[3 * size + above]};
        turned(moved, t, m->body_pos + 3 * body);
        for (int i = 0; i < 3; i++) moved[i] = place[i * size + above] + moved[i];
        for (int k = joint; k < joint + m->body_jntnum[body]; k++)
          t = hinged(t, m->jnt_axis + 3 * k, q[m->jnt_qposadr[k]]);
      }
      for (int i = 0; i < 3; i++) place[i * size + at] = moved[i];
      turn[at] = t.w, turn[size + at] = t.x, turn[2 * size + at] = t.y, turn[3 * size + at] = t.z;
    }
  }
}

// ends (k, 2, rows, 3) of the middle lines of k geoms, in every so-many-th of n rows; those in their
// bodies' frames are own (3, ngeom, 2).
void rotctl_capsules(const mjModel* m, int n, int every, const double* place, const double* turn,
                     const double* own, int k, const int* geoms, double* ends) {
  int size = m->nbody * n;
  for (int i = 0; i < k; i++)
    for (int end = 0; end < 2; end++) {
      double here[3];
      for (int j = 0; j < 3; j++) here[j] = own[2 * (j * m->ngeom + geoms[i]) + end];
      for (int row = 0; row < n; row += every, ends += 3) {
        int at = m->geom_bodyid[geoms[i]] * n + row;
        turned(ends, (Turn){turn[at], turn[size + at], turn[2 * size + at], turn[3 * size + at]}, here);
        for (int j = 0; j < 3; j++) ends[j] = place[j * size + at] + ends[j];
      }
    }
}

static double share(double part, double whole) {
  double found = part / (whole > 1e-12 ? whole : INFINITY);
  return found < 0 ? 0 : found > 1 ? 1 : found;
}

// How deep segments p and q with a reach between them overlap; 0 where they are seen to be far apart.
static double depth(const double* const p[2], const double* const q[2], double reach) {
  double d[3], e[3], r[3], middle[3], apart[3];
  for (int j = 0; j < 3; j++) {
    d[j] = p[1][j] - p[0][j], e[j] = q[1][j] - q[0][j], r[j] = p[0][j] - q[0][j];
    middle[j] = r[j] + 0.5 * (d[j] - e[j]);
  }
  double a = along(d, d), c = along(e, e);
  double far = reach + 0.5 * (sqrt(a) + sqrt(c)) + 1e-6;
  if (along(middle, middle) > far * far) return 0;
  double b = along(d, e), f = along(d, r), g = along(e, r);
  double s = share(b * g - c * f, a * c - b * b), t = share(b * s + g, c);
  s = share(b * t - f, a);
  for (int j = 0; j < 3; j++) apart[j] = r[j] + s * d[j] - t * e[j];
  return reach - sqrt(along(apart, apart));
}

// The deepest overlap of pairs of capsules, the first's index and the second's, in any row.
double rotctl_overlap(int rows, const double* first, const double* second, int pairs,
                      const int* pair, const double* reach) {
  double deepest = 0;
  for (int i = 0; i < pairs; i++) {
    const double *one = first + 6 * pair[2 * i] * rows, *other = second + 6 * pair[2 * i + 1] * rows;
    for (int row = 0; row < rows; row++, one += 3, other += 3) {
      const double* const p[2] = {one, one + 3 * rows};
      const double* const q[2] = {other, other + 3 * rows};
      double found = depth(p, q, reach[i]);
      if (!(found <= deepest)) deepest = found;
      if (isnan(found)) return found;
    }
  }
  return deepest;
}
