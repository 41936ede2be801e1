#!/usr/bin/env bash
# Ask mink to bring a character's centre of mass over its feet: the crate beside it moves there, or nothing moves at all.
#
# Expected: ComTask regulates "the center-of-mass (CoM) of a robot"; its documentation says of the subtree that it takes that it is the entire robot
#   excluding the world body. In a scene that would be all that is in it, or one would name the body.
# Happens: it is the subtree of body number 1, the first in the file. With a crate before the character the error is that of the crate, inverse
#   kinematics send the crate to the target and leave the character as it was; if the crate has no joint nothing moves and the error never falls.
#   set_target_from_configuration takes the crate, too, so that the error is 0 at the start. Nothing can name another body; with
#   the crate behind the character all is right. Any <include> of a scene before that of a robot makes the difference.
# Seen with: mink 1.3.0, mujoco 4.0.0, daqp 0.11.0. A note in its source says that the number should not be fixed.
# Means: feet and hands, which are tasks of frames by name, go where they should, so that the scene looks right and stays out of balance. Put the character
#   first, or write a task of one's own with mj_jacSubtreeCom and the name of its root.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mink==1.3.0 mujoco==4.0.0 daqp==0.11.0 qpsolvers==4.13.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mink
import mujoco
import numpy as np

CHARACTER = """<body name="pelvis" pos="0 0 1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 .5" size=".1" mass="60"/></body>"""
CRATE = '<body name="crate" pos="2 0 .2">{joint}<geom type="box" size=".2 .2 .2" mass="20"/></body>'
LOOSE, FIXED = CRATE.format(joint="<freejoint/>"), CRATE.format(joint="")
TARGET = np.array([0.3, 0.1, 1.25])


def reached(*bodies):
    """How far the two have moved [m] and the norms of the error at the start and after 100 steps."""
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(bodies)}</worldbody></mujoco>")
    configuration = mink.Configuration(model)
    task = mink.ComTask(cost=1.0)
    task.set_target(TARGET)
    before = {name: configuration.data.body(name).xpos.copy() for name in ("pelvis", "crate")}
    errors = [float(np.linalg.norm(task.compute_error(configuration)))]
    for _ in range(100):
        velocity = mink.solve_ik(configuration, [task], 0.1, "daqp", damping=1e-9, limits=[])
        configuration.integrate_inplace(velocity, 0.1)
    errors.append(float(np.linalg.norm(task.compute_error(configuration))))
    return {name: float(np.linalg.norm(configuration.data.body(name).xpos - place)) for name, place in before.items()}, errors


print("mink", version("mink"), "mujoco", mujoco.__version__, "- says 'entire robot':", "entire robot" in " ".join(mink.ComTask.compute_error.__doc__.split()))
moved = {}
scenes = {"character first": (CHARACTER, LOOSE), "crate first": (LOOSE, CHARACTER), "crate without a joint first": (FIXED, CHARACTER)}
for title, bodies in scenes.items():
    moved[title], errors = reached(*bodies)
    print(f"{title:28s} character moves {moved[title]['pelvis']:.3f} m, crate {moved[title]['crate']:.3f} m; error {errors[0]:.3f} -> {errors[1]:.3f} m")
wanted = float(np.hypot(*TARGET[:2]))
if abs(moved["character first"]["pelvis"] - wanted) > 1e-3 or moved["character first"]["crate"] > 1e-6:
    raise SystemExit("CHANGED: a character that comes first isn't brought to the target alone")
if moved["crate first"]["pelvis"] > 1e-6 or moved["crate first"]["crate"] < 1 or max(moved["crate without a joint first"].values()) > 1e-6:
    raise SystemExit("CHANGED: the centre of mass is no longer that of the first body alone")
PY
