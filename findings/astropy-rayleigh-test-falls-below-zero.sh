#!/usr/bin/env bash
# The clearer the direction of a few falls, the smaller astropy's p-value, down to below zero.
#
# Expected: rayleightest returns the probability of directions that are this much alike, or more, if all are as likely: between 0 and 1.
# Happens: below 50 directions a series in 1/n is used, also where it no longer holds. Six to ten directions that agree well have a negative
#   p-value. Nothing is said. vtest, against a given direction, does so too for some numbers.
# Seen with: astropy 8.0.2, stats.rayleightest and vtest; pingouin 0.7.0 beside it stays positive. A probability by simulation for comparison.
# Means: "p < 0.05" is true and the rest is not: its logarithm is NaN, sorting by p puts it before stronger evidence, corrections for many tests and
#   combinations of p-values (Fisher) fail or lie. Small sets of runs, by body or by seed, are where it happens. Simulate.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check astropy==8.0.2 pingouin==0.7.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from astropy.stats import rayleightest, vtest
from pingouin import circ_rayleigh

SETS = 200_000  # of uniform directions, to compare with
print("astropy", version("astropy"), "- p-values of n directions spread evenly over an arc")
negative, found = 0, {}
for n in (4, 6, 8, 10, 12):
    random = np.exp(1j * np.random.default_rng(n).uniform(0, 2 * np.pi, (SETS, n)))
    for arc in (60, 10):
        ways = np.radians(np.linspace(-arc / 2, arc / 2, n))
        alike = np.abs(np.exp(1j * ways).mean())
        simulated = (np.abs(random.mean(1)) >= alike).mean()
        found[n, arc] = p = float(rayleightest(ways)), float(vtest(ways, mu=0.0)), float(circ_rayleigh(ways)[1])
        print(f"n {n:2d}, {arc:2d} degrees: rayleightest {p[0]:10.2e}  vtest {p[1]:10.2e}  pingouin {p[2]:8.2e}  simulated {simulated:8.2e}")
if not all(found[n, arc][0] < 0 for n in (6, 8, 10) for arc in (10,)) or found[6, 10][1] >= 0:
    raise SystemExit("CHANGED: the p-values of close directions are no longer negative")
if not all(0 < p[2] < 1 for p in found.values()) or found[12, 10][0] <= 0:
    raise SystemExit("CHANGED: what was positive no longer is")
PY
