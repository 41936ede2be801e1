#!/usr/bin/env bash
# Export a recording of Xsens without velocities, and mvnx tells accelerations when asked for velocity, and angular velocities when asked for acceleration.
#
# Expected: in an MVNX file each frame names what it holds: <position>, <velocity>, <acceleration> and so on; who exports ticks which of them. A reader
#   goes by the names; what the file doesn't hold is empty or refused.
# Happens: mvnx goes by place: velocity is the third element of a frame, whatever its name, and acceleration the fourth. With one of them not exported all
#   from there on move up: where 0.3 m/s belong come 1.7 m/s2, and the angular velocity of 6 rad/s is called an acceleration. Only the last one is empty.
#   Nothing is said. The first three frames are left out as poses of calibration in any file: a file without them loses its
#   first three frames of motion, and its times begin late.
# Seen with: mvnx 0.2. A file with all of the fourteen elements in their usual order, and with the three poses, is read rightly.
# Means: shapes agree, three numbers for each segment, and values look possible. Angular momentum by such "velocities" is one of accelerations. Export
#   everything, or read the elements by name.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mvnx==0.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import mvnx
import numpy as np

# value of each element, the same for all three numbers of the one segment
HELD = {
    "orientation": 1.0,
    "position": 0.9,
    "velocity": 0.3,
    "acceleration": 1.7,
    "angularVelocity": 6.0,
    "angularAcceleration": 11.0,
    "footContacts": 1.0,
    "sensorFreeAcceleration": 2.1,
    "sensorMagneticField": 0.5,
    "sensorOrientation": 1.0,
    "jointAngle": 20.0,
    "jointAngleXZY": 21.0,
    "jointAngleErgo": 22.0,
    "centerOfMass": 1.1,
}
POSES = ("identity", "tpose", "tpose-isb")


def read(held, poses=POSES):
    """Clip of five frames at 60 a second, read by mvnx."""
    def frame(kind, index):
        inside = "".join(f"<{name}>{HELD[name]} {HELD[name]} {HELD[name]}</{name}>" for name in held)
        return f'<frame time="{index * 1000 // 60}" index="{index}" tc="00:00:00:00" ms="0" type="{kind}">{inside}</frame>'

    frames = "".join(frame(pose, 0) for pose in poses) + "".join(frame("normal", index) for index in range(5))
    Path("clip.mvnx").write_text(
        '<?xml version="1.0" encoding="UTF-8"?><mvnx version="4"><mvn version="2024.0" build="1"/><comment>roll</comment>'
        '<subject label="one" frameRate="60" segmentCount="1" recDate="today" configuration="FullBody" userScenario="none">'
        '<comment/><segments><segment label="Pelvis" id="1"/></segments><sensors><sensor label="Pelvis"/></sensors><joints/><ergonomicJointAngles/>'
        f'<footContactDefinition/><frames segmentCount="1" sensorCount="1" jointCount="0">{frames}</frames></subject><securityCode code="0"/></mvnx>'
    )
    return mvnx.load("clip.mvnx")


def first(read_as):
    return float(read_as[0, 0]) if np.size(read_as) else None


print("mvnx", version("mvnx"))
whole = read(HELD)
if {name: first(getattr(whole, name)) for name in HELD} != HELD or whole.velocity.shape != (5, 3):
    raise SystemExit("CHANGED: a whole file is read otherwise")
cut = read([name for name in HELD if name != "velocity"])
told = {name: first(getattr(cut, name)) for name in ("position", "velocity", "acceleration", "angularVelocity", "centerOfMass")}
print(f"exported without velocity: position {HELD['position']}, acceleration {HELD['acceleration']}, angularVelocity {HELD['angularVelocity']}; told {told}")
if told != {"position": 0.9, "velocity": 1.7, "acceleration": 6.0, "angularVelocity": 11.0, "centerOfMass": None}:
    raise SystemExit("CHANGED: elements are read by name")
short = read(HELD, poses=())
print(f"exported without poses of calibration: {len(short.velocity)} of 5 frames, times {short.time} ms")
if len(short.velocity) != 2 or short.time != ["50", "66"]:
    raise SystemExit("CHANGED: frames are told apart by their type")
PY
