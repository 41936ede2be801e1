#!/usr/bin/env bash
# Markers in mm, moments of the force plate in Nm, both said in the C3D file: to ezc3d whoever stands on a corner of the plate stands in its middle.
#
# Expected: ANALOG:UNITS gives the unit of each channel, also of the six that FORCE_PLATFORM:CHANNEL names. A filter that hands out force, moment and centre of
#   pressure with unit_moment and unit_position beside them goes by that, or refuses units that don't go together.
# Happens: unit_moment is N and the unit of the points in one word, whatever ANALOG:UNITS or FORCE_PLATFORM:UNITS say. Moments of -70 and 35 Nm about the plate's
#   surface come back as -70 and 35 with unit_moment "Nmm", and a push at 250, 400 mm on a plate with its middle at 200, 300 has its centre of
#   pressure at 200.05, 300.10. A horizontal force times the depth of the sensors is added in Nmm to moments in Nm: 100 N at 20 mm shift the
#   centre by 2.9 mm. With markers and moments in mm and Nmm, or in m and Nm, all is right. Units come back from the file as they were.
# Seen with: ezc3d 1.7.2, c3d(..., extract_forceplat_data=True), a plate of type 2. Several of its issues (193, 194, 341, 354) are of centres of pressure; of units in
#   the file none was found.
# Means: the foot seems to push at a place that hardly moves and lies on the plate, which looks like good balance; its moments about the ankle are wrong by decimetres
#   times the weight. Who turns "Nmm" into Nm divides by a thousand what is right. Scale the moment channels to the unit of the points before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check ezc3d==1.7.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import ezc3d
import numpy as np

# the plate's axes are forward, to the right and down, the laboratory's forward, to the left and up
PUSH = np.array([0.05, -0.10, 0.0])  # m from the middle of the plate
ORIGIN = np.array([0.0, 0.0, -0.02])  # m from the sensors up to the middle of the surface
DOWN = 700.0  # N, on the plate
PLACE = np.array([0.25, 0.40])  # m in the laboratory
CORNERS = np.array([[0.4, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.6, 0.0], [0.4, 0.6, 0.0]])  # m


def integers(group, name, numbers):
    group[name]["type"], group[name]["value"] = 2, numbers


def plate(length, moment, sideways=0.0):
    """What ezc3d tells of a plate in a file whose points and moments have these units, and the units that it read."""
    per_metre, per_newton_metre = {"m": 1.0, "mm": 1000.0}[length], {"Nm": 1.0, "Nmm": 1000.0}[moment]
    file = ezc3d.c3d()
    parameters = file["parameters"]
    parameters["POINT"]["RATE"]["value"], parameters["POINT"]["UNITS"]["value"] = [100.0], [length]
    parameters["POINT"]["LABELS"]["value"] = ["toe"]
    file["data"]["points"] = np.ones((4, 1, 4))
    parameters["ANALOG"]["RATE"]["value"], parameters["ANALOG"]["LABELS"]["value"] = [100.0], ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    parameters["ANALOG"]["UNITS"]["value"] = ["N"] * 3 + [moment] * 3
    force = np.array([sideways, 0.0, DOWN])
    channels = np.concatenate([force, per_newton_metre * np.cross(ORIGIN + PUSH, force)])
    file["data"]["analogs"] = np.repeat(channels.reshape(1, 6, 1), 4, axis=2)
    for name, numbers in (("USED", [1]), ("TYPE", [2]), ("ZERO", [1, 0]), ("CHANNEL", np.arange(1, 7).reshape(6, 1))):
        file.add_parameter("FORCE_PLATFORM", name, np.array(numbers, float))
        integers(parameters["FORCE_PLATFORM"], name, np.array(numbers, np.int32))
    file.add_parameter("FORCE_PLATFORM", "CORNERS", per_metre * CORNERS.T.reshape(3, 4, 1))
    file.add_parameter("FORCE_PLATFORM", "ORIGIN", per_metre * ORIGIN.reshape(3, 1))
    file.add_parameter("FORCE_PLATFORM", "UNITS", ["N"] * 3 + [moment] * 3)
    file.write("step.c3d")
    read = ezc3d.c3d("step.c3d", extract_forceplat_data=True)
    return read["data"]["platform"][0], read["parameters"]["ANALOG"]["UNITS"]["value"], PLACE * per_metre


print("ezc3d", version("ezc3d"))
cases = {
    ("mm", "Nmm", 0.0): ("Nmm", [250.0, 400.0]),
    ("m", "Nm", 100.0): ("Nm", [0.25, 0.4]),
    ("mm", "Nm", 0.0): ("Nmm", [200.05, 300.1]),
    ("mm", "Nm", 100.0): ("Nmm", [197.196, 300.1]),
}
for (length, moment, sideways), (unit, seen) in cases.items():
    told, units, right = plate(length, moment, sideways)
    pressure = told["center_of_pressure"][:2, 0]
    print(f"{length} and {moment}, {sideways:.0f} N sideways: moment {told['moment'][:2, 0].round(1)} {told['unit_moment']}, "
          f"centre of pressure {pressure.round(3)} of {right} {told['unit_position']}")
    if units != ["N"] * 3 + [moment] * 3 or np.abs(told["force"][:, 0] - [sideways, 0.0, -DOWN]).max() > 1e-3:
        raise SystemExit("CHANGED: units or forces are read otherwise")
    if told["unit_moment"] != unit or np.abs(pressure - seen).max() > 1e-3:
        raise SystemExit("CHANGED: units of moments are minded")
PY
