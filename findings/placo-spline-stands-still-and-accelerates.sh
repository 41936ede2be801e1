#!/usr/bin/env bash
# After its last point a spline of placo stays where it is, and still has the velocity and the acceleration of its last moment.
#
# Expected: beyond its ends a motion is held, with velocity and acceleration 0, or it goes on along its last piece, or asking is an error; in each
#   case vel() and acc() belong to pos().
# Happens: pos() holds the last value, vel() and acc() hold theirs, too. From 0 to 1 m in a second, at rest at both ends: from then on the place
#   is 1 m, the velocity 0 and the acceleration -6 m/s2, for ever; before the start it is +6. With 3 m/s at the end it stays at
#   1 m with 3 m/s. So do CubicSpline3D and an angle.
# Seen with: placo 0.10.2; SciPy's CubicHermiteSpline goes on along its last piece in all three.
# Means: a whole-body controller adds the acceleration of its reference to its feedback. After a hand has arrived it is asked to leave again with -6 m/s2
#   until the next motion begins, and settles beside its aim, by 6 mm for a stiffness of 1000 1/s2; a solver of the task sees no fault.
#   Ask with the time clamped, and take 0 for both after the end.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check placo==0.10.2 pin==3.8.0 scipy==1.17.1 numpy==2.3.5
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import placo
import scipy.interpolate

STIFFNESS, DAMPING, STEP = 1000.0, 60.0, 1e-3  # of the feedback, 1/s2 and 1/s; s


def splines(end_velocity):
    """From 0 to 1 in a second, at rest at the start, of placo and of SciPy: functions of time that return place, velocity and acceleration."""
    spline = placo.CubicSpline()
    spline.add_point(0.0, 0.0, 0.0)
    spline.add_point(1.0, 1.0, end_velocity)
    other = scipy.interpolate.CubicHermiteSpline([0.0, 1.0], [0.0, 1.0], [0.0, end_velocity])
    return (
        lambda time: np.array([spline.pos(time), spline.vel(time), spline.acc(time)]),
        lambda time: np.array([float(other(time, order)) for order in range(3)]),
    )


def settles(reference, until=3.0):
    """Where a mass comes to rest that is accelerated as the reference says, with feedback."""
    place = velocity = 0.0
    for step in range(round(until / STEP)):
        aim, speed, acceleration = reference(step * STEP)
        velocity += STEP * (acceleration + STIFFNESS * (aim - place) + DAMPING * (speed - velocity))
        place += STEP * velocity
    return place


print("placo", version("placo"), "scipy", version("scipy"))
for end_velocity in (0.0, 3.0):
    ours, others = splines(end_velocity)
    for time in (-1.0, 0.5, 1.0, 2.0):
        print(f"{end_velocity:.0f} m/s at the end, at {time:4.1f} s: placo {ours(time).round(6) + 0.0}, SciPy {others(time).round(6) + 0.0}")
    if np.abs(np.array([ours(time) - others(time) for time in (0.25, 0.5, 0.75)])).max() > 1e-9:
        raise SystemExit("CHANGED: the two splines differ between their ends")
    if np.abs(ours(5.0) - [1.0, end_velocity, others(1.0)[2]]).max() > 1e-9:
        raise SystemExit("CHANGED: beyond the end place, velocity and acceleration are no longer those of the end")
ours, _ = splines(0.0)
held = lambda time: ours(time) if time < 1.0 else np.array([1.0, 0.0, 0.0])
beside, at = settles(ours), settles(held)
print(f"a mass that follows settles at {beside:.4f} m, with velocity and acceleration 0 after the end at {at:.4f} m")
if abs(at - 1.0) > 1e-4 or abs(beside - (1.0 - 6.0 / STIFFNESS)) > 1e-4:
    raise SystemExit("CHANGED: what follows no longer settles beside its aim")
PY
