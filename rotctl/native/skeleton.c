// metrics/skeleton.py: where bodies are in every row of a log, in the order of its sums.
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
