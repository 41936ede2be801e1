#!/usr/bin/env bash
# Measure an arm that is 30 % thicker: in package yeadon both arms are thicker if it is the left one, and none if it is the right one.
#
# Expected: Human(measurements, symmetric=False) does not average left and right; each limb is made of its own eighteen or nineteen measurements, so that
#   a tennis player's arm, a prosthesis or an injured limb is told apart.
# Happens: the right arm has its own lengths and the widths and perimeters of the left one. A left arm 30 % thicker above the wrist makes both upper arms 69 %
#   heavier; the same on the right changes nothing, to the last digit. Legs are right, either side. With symmetric=True, which is what it does untold, there
#   is nothing to see.
# Seen with: yeadon 2.0.1. A search of its issues found nothing of it.
# Means: an inertia tensor without symmetry is what the option is for: the products of inertia that tilt a somersault, and make a twist of it, come out 0. Twelve of
#   an athlete's eighteen measurements of that arm are taken for nothing, and errors in them are never seen. Compute the arm as the left one of a second
#   Human with sides exchanged, and take the mirror image of its A1 and A2.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check yeadon==2.0.1 numpy==2.4.6 PyYAML==6.0.3
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from yeadon import Human

TRUNK = "1L .17, 2L .24, 3L .36, 4L .49, 5L .54, 6L .15, 7L .21, 8L .30, 0p .92, 1p .82, 2p .84, 3p .95, 5p .38, 6p .50, 7p .57, 0w .35, 1w .30, 2w .30, 3w .33, 4w .36, 4d .16"
ARM = "2L .28, 3L .34, 4L .53, 5L .06, 6L .10, 7L .18, 0p .34, 1p .30, 2p .27, 3p .27, 4p .17, 5p .24, 6p .20, 7p .10, 4w .058, 5w .10, 6w .082, 7w .04"
LEG = "1L .08, 3L .41, 4L .55, 5L .81, 6L .04, 8L .15, 9L .20, 1p .57, 2p .52, 3p .38, 4p .37, 5p .24, 6p .33, 7p .25, 8p .24, 9p .16, 8w .10, 9w .07, 6d .11"
PARTS = {"s": TRUNK, "a": ARM, "b": ARM, "j": LEG, "k": LEG}
BODY = {f"L{part}{name}": float(metres) for part, text in PARTS.items() for name, metres in (entry.split() for entry in text.split(","))}


def limbs(*names, by=1.3):
    """Masses of upper arms (left, right) and thighs (left, right) where these measurements are greater, and the products of inertia of the whole."""
    human = Human({name: metres * (by if name in names else 1.0) for name, metres in BODY.items()}, symmetric=False)
    return np.array([human.A1.mass, human.B1.mass, human.J1.mass, human.K1.mass]), human.inertia[0, 2]


print("yeadon", version("yeadon"), "- masses relative to the even body: upper arms left and right, thighs left and right")
even, _ = limbs()
changed = {
    "left arm thicker": limbs("La0p", "La1p", "La2p", "La3p"),
    "right arm thicker": limbs("Lb0p", "Lb1p", "Lb2p", "Lb3p"),
    "right arm longer": limbs("Lb2L", "Lb3L", "Lb4L"),
    "left leg thicker": limbs("Lj1p", "Lj2p", "Lj3p"),
    "right leg thicker": limbs("Lk1p", "Lk2p", "Lk3p"),
}
for name, (masses, product) in changed.items():
    print(f"{name:18s} {(masses / even).round(3)}, product of inertia {product:.3f} kg m2")
ratios = {name: masses / even for name, (masses, _) in changed.items()}
if not (ratios["left leg thicker"][2] > 1.3 and np.allclose(ratios["left leg thicker"][[0, 1, 3]], 1) and np.allclose(ratios["right leg thicker"], ratios["left leg thicker"][[0, 1, 3, 2]])):
    raise SystemExit("CHANGED: the legs are no longer right")
if not (ratios["right arm longer"][1] > 1.2 and np.allclose(ratios["right arm longer"][[0, 2, 3]], 1)):
    raise SystemExit("CHANGED: the right arm no longer has its own length")
if not np.allclose(ratios["left arm thicker"], [1.69, 1.69, 1, 1]) or not np.array_equal(ratios["right arm thicker"], np.ones(4)) or abs(changed["left arm thicker"][1]) > 1e-9:
    raise SystemExit("CHANGED: the right arm no longer has the perimeters of the left one")
PY
