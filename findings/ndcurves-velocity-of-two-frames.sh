#!/usr/bin/env bash
# ndcurves gives the velocity of a pose as one pinocchio.Motion: its linear half is in the world's axes, its angular half in those of the body.
#
# Expected: derivateAsMotion of an SE3Curve is the velocity of the moving frame in one of the frames that Pinocchio has names for: LOCAL, WORLD or LOCAL_WORLD_ALIGNED, so
#   that it can be subtracted from getFrameVelocity and given to a task.
# Happens: the linear half is the derivative of the place, in the world's axes, as in LOCAL_WORLD_ALIGNED; the angular half is in the body's axes, as in LOCAL. It fits none of
#   the three. A foot that goes forward at 0.5 m/s while it turns has the first right in LOCAL_WORLD_ALIGNED, and an angular velocity of the right size, 71 degrees askew.
#   A curve that starts from no turn and turns about one axis, as examples do, has the same angular velocity in all of them.
# Seen with: ndcurves 2.3.0, pin 4.1.0. Its headers name linear and angular x, y and z, and its binding "a pinocchio.Motion"; no frame is told.
# Means: the library is there for end effectors of legged robots. A whole-body controller that adds this feedforward to its feedback turns a foot or a hand about another
#   axis as soon as it starts from a turned pose, and feedback hides it. The same holds of rotation_curve().derivate. Turn the angular half by the rotation of c(t).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check ndcurves==2.3.0 pin==4.1.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import ndcurves
import numpy as np
import pinocchio as pin

STEP = 1e-6


def velocities(curve, time):
    """Velocity of a pose in the three frames that Pinocchio has names for, by differences."""
    before, now, after = (pin.SE3(curve(time + shift)) for shift in (-STEP, 0, STEP))
    place = (after.translation - before.translation) / (2 * STEP)
    turn = pin.log3(after.rotation @ before.rotation.T) / (2 * STEP)
    aligned = pin.Motion(place, turn)
    local = pin.Motion(now.rotation.T @ place, now.rotation.T @ turn)
    return {"LOCAL": local, "WORLD": now.act(local), "LOCAL_WORLD_ALIGNED": aligned}


def off(told, true):
    return float(np.abs(told - true).max())


print("ndcurves", version("ndcurves"), "pin", pin.__version__)
start = pin.SE3(pin.exp3(np.array([0.5, 0.0, 1.2])), np.array([0.0, 0.0, 1.0]))
end = pin.SE3(pin.exp3(np.array([0.0, 2.0, 0.3])), np.array([1.0, 0.0, 1.0]))
curve = ndcurves.SE3Curve(start.homogeneous, end.homogeneous, 0.0, 2.0)
fits = {}
for time in (0.3, 1.0, 1.7):
    told = curve.derivateAsMotion(time, 1)
    print(f"{time} s: told", told.linear.round(3), told.angular.round(3))
    for frame, true in velocities(curve, time).items():
        fits[frame] = (off(told.linear, true.linear), off(told.angular, true.angular))
        print(f"    {frame:20s}", true.linear.round(3), true.angular.round(3), "off by", *(round(part, 3) for part in fits[frame]))
    aligned = velocities(curve, time)["LOCAL_WORLD_ALIGNED"].angular
    print(f"    angular velocities {np.degrees(np.arccos(told.angular @ aligned / np.linalg.norm(aligned) / np.linalg.norm(told.angular))):.0f} degrees apart")
    if min(max(both) for both in fits.values()) < 0.1:
        raise SystemExit("CHANGED: the velocity is that of one frame")
    if fits["LOCAL_WORLD_ALIGNED"][0] > 1e-6 or fits["LOCAL"][1] > 1e-6:
        raise SystemExit("CHANGED: the two halves are of other frames")
level = ndcurves.SE3Curve(np.eye(4), pin.SE3(pin.exp3(np.array([0.0, 0.0, 1.0])), np.array([1.0, 0.0, 0.0])).homogeneous, 0.0, 2.0)
told = level.derivateAsMotion(0.7, 1)
if off(told.vector, velocities(level, 0.7)["LOCAL_WORLD_ALIGNED"].vector) > 1e-6:
    raise SystemExit("CHANGED: a level curve has another velocity")
PY
