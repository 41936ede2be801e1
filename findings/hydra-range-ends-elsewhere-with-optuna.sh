#!/usr/bin/env bash
# n=range(1,4) is 1, 2 and 3 to Hydra and 1 to 4 to its Optuna sweeper; with a grid range(1,4,2) is 1 alone.
#
# Expected: hydra/sweeper=optuna changes which values are tried and in what order, not which there are: range is a word of Hydra's own grammar, there for
#   all sweepers, and ends before its stop like Python's.
# Happens: the sweeper hands start and stop to one of Optuna's distributions, which include their end: 4 runs are made with a value that was excluded, and
#   range(0,1,0.25) reaches 1.0. Its grid sampler ends before the stop again; of whole numbers whose step does not divide the range it loses the last, too:
#   range(1,4,2) is 1 and 3 to Hydra and 1 alone to the grid. shuffle(range(1,4)) is 1, 2 and 3 with either.
# Seen with: hydra-core 1.3.8, hydra-optuna-sweeper 1.2.0, optuna 2.10.1 (it asks for one below 3). The sweeper's 1.3.0 has a default that Hydra 1.3.8 refuses.
# Means: the best run may stand at a value that nobody meant to allow, one contact point or one thread more than there are, say, and a grid that was looked
#   through "all" is short by one. Numbers of such runs don't show it. List the values: choice(1,2,3).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check hydra-core==1.3.8 omegaconf==2.3.1 hydra-optuna-sweeper==1.2.0 optuna==2.10.1 \
  sqlalchemy==2.1.9 numpy==2.4.6 scipy==1.17.1
cd "$work"
cat >app.py <<'PY'
import hydra
from hydra.core.config_store import ConfigStore

ConfigStore.instance().store("config", {"n": 0})


@hydra.main(version_base=None, config_path=None, config_name="config")
def main(config):
    with open("../../../../tried", "a") as file:  # runs are in multirun/DAY/TIME/NUMBER
        file.write(f"{config.n}\n")
    return float(config.n)


if __name__ == "__main__":
    main()
PY
"$work/venv/bin/python" - <<'PY'
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

OPTUNA = ["hydra/sweeper=optuna", "hydra.sweeper.n_trials=40"]
SWEEPERS = {
    "Hydra's own": [],
    "Optuna, random": [*OPTUNA, "hydra/sweeper/sampler=random", "hydra.sweeper.sampler.seed=1"],
    "Optuna, grid": [*OPTUNA, "hydra/sweeper/sampler=grid"],
}


def tried(values, sweeper):
    """All the values that a sweep was run with."""
    Path("tried").write_text("")
    subprocess.run([sys.executable, "app.py", "-m", f"n={values}", "hydra.job.chdir=true", *SWEEPERS[sweeper]], check=True, capture_output=True)
    return sorted({float(line) for line in Path("tried").read_text().split()})


print("hydra-core", version("hydra-core"), "hydra-optuna-sweeper", version("hydra-optuna-sweeper"), "optuna", version("optuna"))
found = {}
for values in ("range(1,4)", "range(1,4,2)", "range(0,1,0.25)", "shuffle(range(1,4))"):
    for sweeper in SWEEPERS:
        found[values, sweeper] = tried(values, sweeper)
        print(f"{values:20s} {sweeper:15s}", *found[values, sweeper])
own = {values: numbers for (values, sweeper), numbers in found.items() if sweeper == "Hydra's own"}
if own != {"range(1,4)": [1, 2, 3], "range(1,4,2)": [1, 3], "range(0,1,0.25)": [0, 0.25, 0.5, 0.75], "shuffle(range(1,4))": [1, 2, 3]}:
    raise SystemExit("CHANGED: Hydra's own ranges are others")
if found["range(1,4)", "Optuna, random"] != [1, 2, 3, 4] or found["range(0,1,0.25)", "Optuna, random"] != [0, 0.25, 0.5, 0.75, 1]:
    raise SystemExit("CHANGED: the Optuna sweeper's ranges exclude their end")
if found["range(1,4)", "Optuna, grid"] != [1, 2, 3] or found["range(1,4,2)", "Optuna, grid"] != [1] or found["shuffle(range(1,4))", "Optuna, random"] != [1, 2, 3]:
    raise SystemExit("CHANGED: a grid or a shuffled range has other values")
PY
