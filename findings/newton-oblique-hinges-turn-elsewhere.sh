#!/usr/bin/env bash
# An ankle of two oblique hinges in Newton turns about axes that neither hinge has.
#
# Expected: each <joint> of an MJCF body turns about its own axis. Those of an ankle, from shin to talus and from talus to heel, are not
#   square to each other, and a model may have both in one body.
# Happens: Newton makes one joint of the two, whose axes it lists as they are in the file, and turns about others: asked for 20 degrees of
#   one hinge alone, the foot turns by 20 about an axis that is 9 degrees off of the first and 12 of the second; of axes 45 degrees apart, 57 and 78.
#   Where they are square all is right, and so it is with a third hinge in the body, even one that never moves.
# Seen with: newton 1.8.0 (CPU), by ModelBuilder.add_mjcf and eval_fk; mujoco 4.0.0 beside it.
# Means: it shows in no list of joints, axes or limits, and at zero not at all: feet come out turned inwards where they should be flat.
#   Give each oblique hinge a body of its own, or make the axes square.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 warp-lang==1.19.0 mujoco==4.0.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
WARP_CACHE_PATH="$work/warp" "$work/venv/bin/python" -W ignore - <<'PY'
import mujoco
import newton
import numpy as np
import warp
from scipy.spatial.transform import Rotation

warp.config.quiet = True
ANKLE, SUBTALAR = (-0.105, -0.174, 0.979), (0.787, 0.605, -0.121)
ANGLE = np.radians(20.0)


def model(axes):
    hinges = "".join('<joint axis="{} {} {}" range="-90 90"/>'.format(*axis) for axis in axes)
    return f"""<mujoco><worldbody><body name="foot" pos="0 0 1">{hinges}
    <geom type="capsule" fromto="0 0 0 .2 0 -.1" size=".03"/></body></worldbody></mujoco>"""


def by_mujoco(axes, angles):
    loaded = mujoco.MjModel.from_xml_string(model(axes))
    data = mujoco.MjData(loaded)
    data.qpos[:] = angles
    mujoco.mj_kinematics(loaded, data)
    return Rotation.from_matrix(data.xmat[1].reshape(3, 3))


def by_newton(axes, angles):
    builder = newton.ModelBuilder()
    builder.add_mjcf(model(axes))
    loaded = builder.finalize("cpu")
    listed = np.allclose(loaded.joint_axis.numpy(), [np.array(axis) / np.linalg.norm(axis) for axis in axes], atol=1e-3)
    state = loaded.state()
    loaded.joint_q.assign(np.array(angles, np.float32))
    newton.eval_fk(loaded, loaded.joint_q, loaded.joint_qd, state)
    return Rotation.from_quat(state.body_q.numpy()[0, 3:]), listed


def compare(axes, angles):
    """Degrees between the two simulators, between the axes of their turns, and turned in Newton."""
    true, (got, listed) = by_mujoco(axes, angles), by_newton(axes, angles)
    a, b = true.as_rotvec(), got.as_rotvec()
    aside = np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))
    return np.degrees((true.inv() * got).magnitude()), aside, np.degrees(np.linalg.norm(b)), listed


print("newton", newton.__version__, "mujoco", mujoco.__version__)
cases = {
    "the first alone": ((ANKLE, SUBTALAR), (ANGLE, 0.0)),
    "the second alone": ((ANKLE, SUBTALAR), (0.0, ANGLE)),
    "the first, 45 apart": (((0, 1, 0), (1, 1, 0)), (ANGLE, 0.0)),
    "the second, 45 apart": (((0, 1, 0), (1, 1, 0)), (0.0, ANGLE)),
    "square axes": (((0, 0, 1), (1, 0, 0)), (ANGLE, ANGLE)),
    "with a third, at 0": ((ANKLE, SUBTALAR, (0, 1, 0)), (ANGLE, ANGLE, 0.0)),
}
seen = {name: compare(*case) for name, case in cases.items()}
for name, (apart, aside, turned, listed) in seen.items():
    print(f"{name:20s} {apart:4.1f} degrees from MuJoCo: by {turned:4.1f} about an axis {aside:4.1f} off; axes listed as in the file: {listed}")
wrong = min(seen[name][0] for name in seen if name.startswith(("the first", "the second")))
right = max(seen[name][0] for name in ("square axes", "with a third, at 0"))
if wrong < 2 or right > 0.1:
    raise SystemExit("CHANGED: two oblique hinges turn about their own axes")
PY
