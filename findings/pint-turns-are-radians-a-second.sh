#!/usr/bin/env bash
# One turn a second is 6.28 Hz to Pint.
#
# Expected: 60 revolutions a minute are 1 Hz; or the conversion is refused, as an angle stands on one side only.
# Happens: a revolution is 2 pi radians, and a radian is 1, so 60 rpm are 6.283 Hz and 1 Hz is 9.55 rpm. Nothing is said. To revolutions a second,
#   degrees a second and radians a second 60 rpm are converted as one expects, and 60 rpm + 1 Hz is 69.5 rpm. astropy and unyt
#   refuse.
# Seen with: Pint 0.25.3, astropy 8.0.1, unyt 3.2.0. Its issues 531 and 1540, both closed, tell of it.
# Means: the spin of a somersault is told in revolutions a second or minute, and steps, filters and samples in Hz. Whoever lets the library compare
#   them is off by 2 pi either way, and a filter for the spin cuts off six times too high. Convert to revolutions a second and take the number.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pint==0.25.3 astropy==8.0.1 unyt==3.2.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import astropy.units
import numpy as np
import pint
import unyt

print("pint", version("pint"), "astropy", version("astropy"), "unyt", version("unyt"))
units = pint.UnitRegistry()
spin, truth = 60 * units.rpm, {"revolution / second": 1.0, "degree / second": 360.0, "radian / second": 2 * np.pi, "hertz": 1.0}
converted = {unit: float(spin.to(unit).magnitude) for unit in truth}
for unit, right in truth.items():
    print(f"60 rpm to {unit}: {converted[unit]:.4f}, expected {right:.4f}")
both = float((spin + 1 * units.Hz).to("rpm").magnitude)
print(f"60 rpm + 1 Hz: {both:.2f} rpm, expected 120")
refused = []
for name, convert, error in (
    ("astropy", lambda: (60 * astropy.units.cycle / astropy.units.min).to("Hz"), astropy.units.UnitConversionError),
    ("unyt", lambda: unyt.unyt_quantity(60, "rpm").to("Hz"), unyt.exceptions.UnitConversionError),
):
    try:
        print(name, convert())
    except error:
        refused.append(name)
        print(name, "refuses")
if any(abs(converted[unit] - truth[unit]) > 1e-9 for unit in truth if unit != "hertz") or refused != ["astropy", "unyt"]:
    raise SystemExit("CHANGED: what is converted rightly or refused")
if abs(converted["hertz"] - 2 * np.pi) > 1e-9 or abs(both - 60 * (1 + 1 / (2 * np.pi))) > 1e-9:
    raise SystemExit("CHANGED: a turn a second is no longer 6.28 Hz")
PY
