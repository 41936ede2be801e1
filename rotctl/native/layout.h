// What Python and C hand each other; rotctl/native/layout.py reads it here. A library that was
// built from other source is refused.
#ifndef ROTCTL_LAYOUT_H
#define ROTCTL_LAYOUT_H

#include <mujoco/mujoco.h>

enum { SEEN = 1024, CONTACTS = 64, TASKS = 24, TRUNK = 16, SLOTS = 1024, WAVES = 9 };
enum { MOTION_ROWS = 96, FORCES = 3 * CONTACTS };
enum { ROWS = FORCES + MOTION_ROWS, MOMENTA = 3 * TASKS, ROOT = 6, DOFS = 256 };
enum { UNKNOWNS = DOFS + 4 * CONTACTS + 1 };
enum { FAILED = -1, AS_WRITTEN = 0, MODIFIED = 1, NO_SUPERVISOR = 2 };

// MuJoCo's functions, found by Python in the library that it has loaded already.
typedef struct {
  void (*mulM)(const mjModel*, const mjData*, mjtNum*, const mjtNum*);
  void (*solveM)(const mjModel*, mjData*, mjtNum*, const mjtNum*, int);
  void (*factorM)(const mjModel*, mjData*);
  void (*jac)(const mjModel*, const mjData*, mjtNum*, mjtNum*, const mjtNum*, int);
  void (*jacDot)(const mjModel*, const mjData*, mjtNum*, mjtNum*, const mjtNum*, int);
  void (*applyFT)(const mjModel*, mjData*, const mjtNum*, const mjtNum*, const mjtNum*, int,
                  mjtNum*);
  void (*step1)(const mjModel*, mjData*);
  void (*step2)(const mjModel*, mjData*);
  void (*step)(const mjModel*, mjData*);
  void (**error)(const char*);  // where MuJoCo looks whom to tell of what ends it
} Functions;

// One objective over the acceleration; see rotctl/control/task.py.
typedef struct {
  int kind, body;
  double axes[9], point[3], target[4], velocity[3], acceleration[3];
  double stiffness[3], damping[3], weight[3];
} Task;

// Constants of a run.
typedef struct {
  double period, friction, diagonal, tolerance, slack, touch, look_ahead, merge_distance;
  double merge_parallel, mass, gravity[3];
  int sees_disturbance, trunk_count;
  int trunk[TRUNK];
  double trunk_weight[TRUNK];
  const double *torque_limit, *armature;  // (nu)
  const double* joint_range;              // (nu, 2)
} Constants;

// The state that `rotctl_read` finds: first a `Momentum`, in its order. The bias is (nv).
typedef struct {
  double com[3], com_velocity[3], linear[3], angular[3], inertia[9], angular_velocity[3];
  double rotation[9], offset[3], trunk_axes[9];
  double position[CONTACTS][3], frame[CONTACTS][9], friction[CONTACTS][2];
  double gap[CONTACTS];
  int body[CONTACTS];
  long long row[CONTACTS];
  int count;
  double* bias;
} Reading;

// What a behaviour wants. Poses are (nu), `held_out` is (nbody), so is `behind`, or null.
typedef struct {
  double forward[3], blend;
  double pose_stiffness, pose_damping, pose_horizon, pose_weight, blend_weight;
  double contact_damping, contact_weight, contact_force;
  double threshold_force, threshold_torque, threshold_separation;
  int supervisor, pose_explicit, contact_centripetal, tasks;
  const Task* task;
  double *pose_a, *pose_b;
  const unsigned char* held_out;
  const double* behind;
} Command;

// What `rotctl_decide` decides. Torque is (nu).
typedef struct {
  double force[CONTACTS][3];
  double rates_wanted[6], rates_predicted[6], blend, residual;
  double error[TASKS][3], wanted[TASKS][3], predicted[TASKS][3];
  double* torque;
  unsigned char used[CONTACTS];
} Answer;

// The ground's forces in one control period.
typedef struct {
  double position[SLOTS][3], normal[SLOTS][3];
  double force[SLOTS][3], now[SLOTS][3], peak[SLOTS];
  double total[3], total_peak, penetration;
  int body[SLOTS];
  int count;
} Sums;

// The phase and what goes with it, as a roll remembers them; behaviours/rolling/remembering.py. The
// clock (`due`, `late`) is the pace's.
typedef struct {
  double angle[3], orientation[4], phase, axis[3], origin[3], first_angle[3], due, late;
} RollMemory;

// A pace's settings; behaviours/rolling/pace_settings.py. Times of changes are (changes), rates
// one more.
typedef struct {
  double travel, own, calm, swing, swing_from, surge, surge_from, wait, width, approach, leave;
  double back, ahead;
  double settling[2], brake, gain, most, patience, easing, usual[6];
  int by_speed, changes, count;
  const double *times, *rates;
  const int* over;  // (count) bodies
} Pace;

// What catches a roll that tips, behaviours/rolling/catching.py: motors (2, count) of the two
// sides, -1 where the body has none.
typedef struct {
  double gain, free, lead;
  int count;
  const int* motor;
  const double *out, *low, *high;
} Catch;

// Limbs that come down, behaviours/rolling/alighting.py: bodies (limbs), and motors and joints one
// limb's after the other's, each up to its `end` (limbs).
typedef struct {
  double lead, sinking, reach, most;
  int limbs;
  const int *body, *end, *motor, *joint;
  const double *low, *high;
} Alighting;

// A roll's constants. Of the poses either `table` and `rise` (rows, 2, nu) are there, or the
// `coefficients` (2, waves, nu), and `waiting` (nu) or none is of behaviours/rolling/waiting.py; its
// two tasks are where the command has them.
typedef struct {
  double axes[9], front[3], way[3], velocity[3], angular_velocity[3];
  double sign, slope, period, correction_time, phase_time;
  double oblique[WAVES], lift[WAVES];
  int column, integral, rows, waves, oblique_waves, lift_waves;
  const double *table, *rise, *coefficients, *low, *high, *waiting;
  const Pace* pace;
  const Catch* catch;
  const Alighting* alighting;
  Task* task;
} Roll;

// Where the rows of a run's log are: the datasets by their names, of one row after the other.
typedef struct {
  double *time, *qpos, *qvel, *ctrl, *com, *com_velocity, *linear_momentum, *angular_momentum;
  double *angular_velocity, *angular_excursion, *blend, *phase, *trunk_axis, *trunk_axes;
  double *linear_momentum_rate_desired, *linear_momentum_rate_predicted;
  double *angular_momentum_rate_desired, *angular_momentum_rate_predicted;
  double *axes, *target, *velocity, *error, *wanted, *predicted;
  int *count, *body;
  float *position, *normal, *force_predicted, *force_realised, *force_peak;
  double *ground_force, *ground_force_peak, *penetration, *residual;
  unsigned char* used;
  int capacity, tasks;
} Rows;

struct Self;
// A kind of objective: fills rows (k, nv) or, of momentum, (k, 6); returns k.
typedef int (*Kind)(const struct Self*, const mjData*, const Reading*, const Task*, double* rows,
                    double* wanted, double* weight, double* error);

typedef struct Self {
  const mjModel* m;
  mjData* scratch;
  Functions mj;
  Constants c;
  const Kind* kind;             // by their numbers; 0 where there is none
  const unsigned char* motion;  // whether a kind's rows are over qddot, or over [Ldot, Hdot]
  int nv, nu;
  double *bias, *diagonal;                         // (nv)
  double *jacobian, *solved;                       // (ROWS + 1, nv)
  double *tau_a, *tau_b, *difference, *torque;     // (nu)
  double *A, *BB, *GG;                             // (ROWS, FORCES), (ROWS, ROWS), (FORCES, FORCES)
  double frame[CONTACTS][9];                       // of the candidates, tangents along `forward`
  double maps[6][FORCES], pull[FORCES];            // of the candidates
  double free_rates[6];                            // of [L, H] without contacts
  double drift[ROWS], wanted[ROWS], weight[ROWS];  // of the candidates' rows, then the tasks'
  double rate_rows[MOMENTA][6], rate_wanted[MOMENTA], rate_weight[MOMENTA];
  int momenta, motion_rows, first_row[TASKS], row_count[TASKS];
  double *reach, *Q;                                   // (ROWS, FORCES + 2 + nu), (ROWS, ROWS)
  double *H, *f, *Hs, *fs, *x, *lower, *upper, *work;  // one quadratic program
  double *spare, *spare2;  // for each function what it calls them
} Self;

// One run of a roll, control period by control period.
typedef struct {
  Self* self;
  mjData* data;
  Reading* reading;
  Command* command;
  Answer* answer;
  const Roll* roll;
  const Rows* rows;
  void* crowd;         // of a full pair of geoms Python tells the name
  double extent[3];    // of the ground: x from, x to, y to either side
  double period;       // of control [s]
  int substeps, most;  // `most` contacts make a pair full
  RollMemory memory;
  Sums sums;
  char error[200];  // what MuJoCo said when it gave up
} Run;

#endif
