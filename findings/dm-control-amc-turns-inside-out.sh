#!/usr/bin/env bash
# dm_control's AMC converter spins the body 119 times a second where the file's angle wraps from 180 to -180 degrees.
#
# Expected: resampling a capture interpolates rotations as rotations (its own comment says slerp); a steady somersault
#   comes out steady, however its angle is written.
# Happens: the four numbers of the root's quaternion are put through four separate splines, without making neighbours'
#   signs agree and without normalising. Where the angle wraps the quaternion changes sign, so it passes near zero: its
#   length falls to 0.01 and rises to 1.2 around it, and qvel for one frame is 119 rev/s instead of 1. Resampling at
#   the file's own 120 Hz, or a file with unwrapped angles, is right.
# Seen with: dm_control 1.0.50, mujoco 3.17.0, suite.utils.parse_amc.convert and the humanoid_CMU model.
# Means: upright clips do not show it, rolls, cartwheels and flips do: initial states taken from them start with an
#   absurd spin. Unwrap the root's angles before converting, or check the norm of qpos[3:7].
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    dm_control==1.0.50 mujoco==3.17.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
MUJOCO_GL=disable "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from dm_control import suite
from dm_control.suite.utils import parse_amc

BONES = {}  # the channels of each bone, in the order of the file format
for channel in parse_amc._CMU_MOCAP_JOINT_ORDER[6:]:
    BONES.setdefault(channel[:-2], []).append(channel)


def write_somersault(name, wrapped):
    """One second at 120 Hz: one revolution about the x axis, every joint at zero."""
    lines = []
    for frame in range(121):
        angle = 3.0 * frame
        if wrapped and angle >= 180:
            angle -= 360
        lines += [str(frame + 1), f"root 0 17 0 {angle} 0 0"]
        lines += [f"{bone} " + " ".join("0" for _ in channels) for bone, channels in BONES.items()]
    with open(name, "w") as file:
        file.write("\n".join(lines) + "\n")


print("dm_control", version("dm_control"), "mujoco", version("mujoco"), "- one revolution in one second")
physics = suite.load("humanoid_CMU", "stand").physics
fastest, shortest = {}, {}
for wrapped in (False, True):
    write_somersault("somersault.amc", wrapped)
    for rate in (120, 240):
        clip = parse_amc.convert("somersault.amc", physics, 1 / rate)
        shortest[wrapped, rate] = float(np.linalg.norm(clip.qpos[3:7], axis=0).min())
        fastest[wrapped, rate] = float(np.linalg.norm(clip.qvel[3:6], axis=0).max() / 2 / np.pi)
        print(
            f"angle {'wrapped' if wrapped else 'running on':10s} resampled at {rate} Hz: "
            f"shortest quaternion {shortest[wrapped, rate]:.3f}, fastest turn {fastest[wrapped, rate]:6.2f} rev/s"
        )
fine = [case for case in fastest if case != (True, 240)]
if any(abs(fastest[case] - 1) > 0.01 or abs(shortest[case] - 1) > 0.01 for case in fine):
    raise SystemExit("CHANGED: the cases that were right are no longer")
if not (fastest[True, 240] > 20 and shortest[True, 240] < 0.5):
    raise SystemExit("CHANGED: a wrapped angle is resampled as a rotation")
PY
