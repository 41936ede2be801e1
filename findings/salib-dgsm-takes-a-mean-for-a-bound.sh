#!/usr/bin/env bash
# To SALib's DGSM a factor with mean 1 and deviation 1 has no influence, and with mean 10 it has 81 times that of one with mean 0.
#
# Expected: for a factor with dists "norm" the two "bounds" are mean and standard deviation, for DGSM as for Sobol's indices. DGSM is an upper
#   limit of the total index: for a normal factor the deviation squared times the mean square of the derivative, over the variance.
# Happens: the index is (second bound - first bound)^2 times that mean square, over pi^2 and the variance, as for a uniform factor, so it has
#   (deviation - mean)^2. Of y = a + 2 b with deviations of 1 the indices of Sobol are 0.2 and 0.8 whatever the means. DGSM of a is 0.02, a
#   tenth of what it is to limit, with a mean of 0, none with a mean of 1, and 1.6 with a mean of 10. Where the law is not linear the
#   derivative is none either: finite_diff moves each point by 1 %, and then to between mean and deviation. Uniform factors are right.
# Seen with: SALib 1.6.0 (numpy 2.4.6, scipy 1.17.1); its manual says that "bounds" of other distributions are their parameters.
# Means: masses of 70 +- 10 kg and times of 0.10 +- 0.05 s are ranked by how far mean and deviation are apart, and an angle counts otherwise if it
#   is measured from the floor or from the vertical. Use uniform factors for DGSM, and Sobol's indices for normal ones.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check SALib==1.6.0 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from SALib.analyze import dgsm, sobol
from SALib.sample import finite_diff
from SALib.sample import sobol as sobol_sample

SLOPES = np.array([1.0, 2.0])
TOTAL = SLOPES**2 / (SLOPES @ SLOPES)  # indices of Sobol of a linear law of independent factors with equal deviations

print("SALib", version("SALib"), "- y = a + 2 b, equal deviations: total indices", TOTAL)
limits = {}
for name, kind, bounds in (
    ("uniform, 0 to 1", "unif", (0.0, 1.0)),
    ("mean 0, deviation 1", "norm", (0.0, 1.0)),
    ("mean 1, deviation 1", "norm", (1.0, 1.0)),
    ("mean 10, deviation 1", "norm", (10.0, 1.0)),
):
    problem = {"num_vars": 2, "names": ["a", "b"], "bounds": [list(bounds)] * 2, "dists": [kind] * 2}
    sample = finite_diff.sample(problem, 1024, seed=1)
    limits[name] = np.array(dgsm.analyze(problem, sample, sample @ SLOPES, seed=1)["dgsm"], dtype=float)
    far = float(np.mean(np.abs(sample[1::3, 0] - sample[::3, 0]) > 0.011 * np.abs(sample[::3, 0])))
    total = sobol.analyze(problem, sobol_sample.sample(problem, 1024, seed=1) @ SLOPES, seed=1)["ST"]
    print(f"{name:20s}: Sobol {np.round(total, 2)}, DGSM {np.round(limits[name], 3)}, neighbours moved by more than 1 %: {far:.0%}")
    if (far > 0.0) != (kind == "norm"):
        raise SystemExit("CHANGED: neighbours of other points are moved")
    if np.abs(total - TOTAL).max() > 0.02:
        raise SystemExit("CHANGED: Sobol's indices are no longer right")
if (limits["uniform, 0 to 1"] < TOTAL).any() or (limits["mean 0, deviation 1"] > TOTAL / 5).any():
    raise SystemExit("CHANGED: the limit of a normal factor is no longer below what it is to limit")
ratio = limits["mean 10, deviation 1"] / limits["mean 0, deviation 1"]
print("mean 10 over mean 0:", ratio.round(2))
if np.abs(ratio - 81.0).max() > 0.5 or limits["mean 1, deviation 1"].any():
    raise SystemExit("CHANGED: DGSM no longer goes by deviation minus mean")
PY
