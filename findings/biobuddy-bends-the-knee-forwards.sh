#!/usr/bin/env bash
# A knee whose angle counts the other way in OpenSim bends forwards after BioBuddy, and one that is set 5 cm forward goes back.
#
# Expected: a converter from .osim to .bioMod keeps what a joint does with its coordinate. In OpenSim each of a CustomJoint's six axes has a function:
#   turn and shift are its values. -1 times the coordinate is how flexion is made positive, a constant is an offset. Where a
#   function can't be kept the converter says so, as its source means to.
# Happens: the axis and the range of the coordinate are kept, and each function is taken for the coordinate itself or for nothing. With
#   coefficients "-1 0" a knee bent by 0.7 rad is bent by -0.7: the ankle is 0.52 m from where it belongs. A constant shift of 0.05 m is gone, with all
#   joints at zero already, and so is a shift by a spline. No warning comes. With coefficients "1 0" and zeros the two agree to a hundredth of a
#   millimetre.
# Seen with: biobuddy 0.3.2 (from_osim, to_biomod), biorbd 1.12.4 to read the result, opensim 4.6 for the truth.
# Means: a model that looks right standing walks with its knees the wrong way round, and angles found by OpenSim can't be used with it. A knee that
#   glides as it bends becomes a hinge, which changes what muscles across it do. Compare markers in two poses, one of them bent, after each conversion.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check biobuddy==0.3.2 biorbd==1.12.4 opensim==4.6 matplotlib==3.11.2 numpy==2.4.6
cd "$work"
cat > osim.py <<'PY'
"""A leg as an .osim file: a hip with one axis and a knee with one, whose functions are given."""

LINEAR = '<LinearFunction name="function"><coefficients>{} 0</coefficients></LinearFunction>'
CONSTANT = '<Constant name="function"><value>{}</value></Constant>'
SPLINE = '<SimmSpline name="function"><x>-2 -1 0 1</x><y>-0.03 0.02 -0.005 0</y></SimmSpline>'


def frame(name, body, place):
    return (
        f'<PhysicalOffsetFrame name="{name}"><socket_parent>{body}</socket_parent><translation>{place}</translation>'
        "<orientation>0 0 0</orientation></PhysicalOffsetFrame>"
    )


def axis(name, direction, function, coordinate=""):
    return f'<TransformAxis name="{name}"><coordinates>{coordinate}</coordinates><axis>{direction}</axis>{function}</TransformAxis>'


def joint(name, parent, place, child, turn, shift, shifted_by=""):
    zero = CONSTANT.format(0)
    axes = axis("rotation1", "0 0 1", turn, name) + axis("rotation2", "1 0 0", zero) + axis("rotation3", "0 1 0", zero)
    axes += axis("translation1", "1 0 0", shift, shifted_by) + axis("translation2", "0 1 0", zero) + axis("translation3", "0 0 1", zero)
    return (
        f'<CustomJoint name="{name}_joint"><socket_parent_frame>{name}_in</socket_parent_frame><socket_child_frame>{name}_out</socket_child_frame>'
        f'<coordinates><Coordinate name="{name}"><range>-2 2</range></Coordinate></coordinates>'
        f"<frames>{frame(name + '_in', parent, place)}{frame(name + '_out', child, '0 0 0')}</frames>"
        f"<SpatialTransform>{axes}</SpatialTransform></CustomJoint>"
    )


def leg(turn=LINEAR.format(1), shift=CONSTANT.format(0), shifted_by=""):
    bodies = "".join(
        f'<Body name="{name}"><mass>5</mass><mass_center>0 -0.2 0</mass_center><inertia>.1 .02 .1 0 0 0</inertia></Body>' for name in ("thigh", "shank")
    )
    joints = joint("hip", "/ground", "0 1 0", "/bodyset/thigh", LINEAR.format(1), CONSTANT.format(0))
    joints += joint("knee", "/bodyset/thigh", "0 -0.4 0", "/bodyset/shank", turn, shift, shifted_by)
    marker = '<Marker name="ankle"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0 -0.4 0.05</location></Marker>'
    return (
        '<?xml version="1.0" encoding="UTF-8"?><OpenSimDocument Version="40500"><Model name="leg"><Ground name="ground"/>'
        f'<BodySet name="bodyset"><objects>{bodies}</objects></BodySet><JointSet name="jointset"><objects>{joints}</objects></JointSet>'
        f'<MarkerSet name="markerset"><objects>{marker}</objects></MarkerSet></Model></OpenSimDocument>'
    )
PY
cat > truth.py <<'PY'
"""Ankle by OpenSim, of the file and the angles of hip and knee that are named; the file is written anew as OpenSim writes it."""

import sys

import opensim

opensim.Logger.setLevelString("Off")
model = opensim.Model(sys.argv[1])
state = model.initSystem()
model.printToXML(sys.argv[1])
for name, angle in zip(("hip", "knee"), sys.argv[2:]):
    model.getCoordinateSet().get(name).setValue(state, float(angle), False)
model.realizePosition(state)
place = model.getMarkerSet().get("ankle").getLocationInGround(state)
print(*(place.get(i) for i in range(3)))
PY
cat > converted.py <<'PY'
"""Ankle by biorbd, of the file as BioBuddy converts it, at the angles of hip and knee."""

import sys

import biorbd
import numpy as np
from biobuddy import BiomechanicalModelReal

BiomechanicalModelReal().from_osim(sys.argv[1]).to_biomod("leg.bioMod")
print(*biorbd.Model("leg.bioMod").markers(np.array([float(angle) for angle in sys.argv[2:]]))[0].to_array())
PY
"$work/venv/bin/python" -W ignore - <<'PY'
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import osim


def ankle(script, angles):
    told = subprocess.run([sys.executable, script, "leg.osim", *map(str, angles)], capture_output=True, text=True, check=True)
    *said, last = told.stdout.strip().splitlines()
    return np.array([float(number) for number in last.split()]), " ".join(said + told.stderr.split("\n")).strip()


def both(leg, angles):
    """Ankle by OpenSim and after BioBuddy, and what BioBuddy said."""
    Path("leg.osim").write_text(leg)
    return ankle("truth.py", angles)[0], *ankle("converted.py", angles)


def chain(hip, knee, shift=0.0):
    """Ankle of the leg, counted by hand: all turns are about z."""
    thigh = np.array([0.4 * np.sin(hip) + shift * np.cos(hip), 1.0 - 0.4 * np.cos(hip) + shift * np.sin(hip)])
    return np.array([*(thigh + 0.4 * np.array([np.sin(hip + knee), -np.cos(hip + knee)])), 0.05])


print("biobuddy", version("biobuddy"), "biorbd", version("biorbd"), "opensim", version("opensim"))
cases = {
    "as it is": (osim.leg(), (0.5, -0.7), chain(0.5, -0.7)),
    "knee times -1": (osim.leg(turn=osim.LINEAR.format(-1)), (0.5, -0.7), chain(0.5, 0.7)),
    "knee 5 cm forward, zero pose": (osim.leg(shift=osim.CONSTANT.format(0.05)), (0.0, 0.0), chain(0.0, 0.0, 0.05)),
    "knee shifts by a spline": (osim.leg(shift=osim.SPLINE, shifted_by="knee"), (0.5, -1.0), chain(0.5, -1.0, 0.02)),
}
off = {}
for name, (leg, angles, by_hand) in cases.items():
    truth, after, said = both(leg, angles)
    off[name] = float(np.linalg.norm(after - truth))
    print(f"{name}: ankle {truth.round(3)} in OpenSim, {after.round(3)} after BioBuddy, {off[name]:.3f} m apart; said: {said or 'nothing'}")
    if np.abs(truth - by_hand).max() > 1e-5:
        raise SystemExit("CHANGED: OpenSim puts the ankle elsewhere")
    if said:
        raise SystemExit("CHANGED: BioBuddy says something")
if off["as it is"] > 1e-5:
    raise SystemExit("CHANGED: a plain leg is converted otherwise")
if off["knee times -1"] < 0.4 or abs(off["knee 5 cm forward, zero pose"] - 0.05) > 1e-5 or abs(off["knee shifts by a spline"] - 0.02) > 1e-5:
    raise SystemExit("CHANGED: functions of the axes are kept")
PY
