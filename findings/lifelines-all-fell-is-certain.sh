#!/usr/bin/env bash
# Three runs of one controller all fall before 8 s, and two of three of the other: lifelines is certain that they differ, p = 0. If no run of one falls, p is NaN.
#
# Expected: a comparison of two survival curves at one time weighs what so few runs can tell: Fisher's test says p = 1 for 3 of 3 against 2 of 3, and
#   0.00044 for none of twenty against ten of twenty.
# Happens: survival_difference_at_fixed_point_in_time_test compares log(-log S), as its source in the literature does. Where all have fallen S is 0 and its
#   transform infinite: p is 0 beside any number of falls of the other, with 2 runs as with 20, also for 20 of 20 against 19 of 20. Where none has, p
#   is NaN, also against 20 falls of 20. Between, 19 of 20 against 10 of 20 say, p is 0.0014 where Fisher has 0.0033. Nothing is said.
# Seen with: lifelines 0.30.3, pandas 2.3.3, scipy 1.17.1 for comparison. logrank_test has numbers for all of these.
# Means: the best and the worst controllers are those at the ends. In a table of pairs the failures are "significant" against whatever they are put
#   beside, and what never falls is not better than anything, as NaN < 0.05 is false. Take logrank_test, or Fisher's test on the counts at that time.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check lifelines==0.30.3 pandas==2.3.3 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from lifelines import KaplanMeierFitter
from lifelines.statistics import logrank_test, survival_difference_at_fixed_point_in_time_test
from scipy.stats import fisher_exact

END, ASKED = 10.0, 8.0  # s


def times(runs, falls):
    """When the runs end, and which of them by a fall: those between 1 and 5 s."""
    return np.r_[np.linspace(1.0, 5.0, falls), np.full(runs - falls, END)], np.r_[np.ones(falls), np.zeros(runs - falls)]


def p_values(runs, one, other):
    """At the time asked for by lifelines, by Fisher, and of the whole curves by the log-rank test."""
    (first, fell), (second, also_fell) = times(runs, one), times(runs, other)
    curves = [KaplanMeierFitter().fit(*times(runs, falls)) for falls in (one, other)]
    return (
        survival_difference_at_fixed_point_in_time_test(ASKED, *curves).p_value,
        float(fisher_exact([[one, runs - one], [other, runs - other]])[1]),
        logrank_test(first, second, fell, also_fell).p_value,
    )


print("lifelines", version("lifelines"), "scipy", version("scipy"))
seen = {}
for runs, one, other in ((2, 2, 1), (3, 3, 2), (20, 20, 19), (20, 19, 10), (20, 1, 10), (20, 0, 10), (20, 0, 20)):
    seen[runs, one, other] = at_time, fisher, logrank = p_values(runs, one, other)
    print(f"{one} and {other} of {runs} fall: p {at_time:.4g} at {ASKED:.0f} s, Fisher {fisher:.4g}, log-rank {logrank:.4g}")
    if not 0 < fisher <= 1 or not 0 < logrank <= 1:
        raise SystemExit("CHANGED: the tests for comparison have other values")
    if one == runs and not at_time == 0:
        raise SystemExit("CHANGED: where all have fallen p is no longer 0")
    if one == 0 and not np.isnan(at_time):
        raise SystemExit("CHANGED: where none has fallen p is a number")
    if 0 < one < runs and not 0 < at_time < 0.05:
        raise SystemExit("CHANGED: between, p is another")
if min(seen[key][1] for key in ((2, 2, 1), (3, 3, 2), (20, 20, 19))) < 0.99:
    raise SystemExit("CHANGED: Fisher's test finds a difference")
PY
