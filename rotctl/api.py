"""rotctl in Python: five calls.

```python
from rotctl import api

config = api.load(["behaviour=forward_roll_2", "seed=2000", "duration=5"])
log = api.simulate(config)  # rotctl.log.RunLog, a mapping of names to arrays
rows = api.sweep(["behaviour=forward_roll_2", "seed=range(2000,2010)"], "sweeps/mine")
again = api.read("runs/<run id>/run.h5")
page = api.report("sweeps/mine", "site")
```

A run depends on its config alone, so that the same config gives the same log as the command line
does. Whatever is wrong with what is given is an `rotctl.errors.InputError` of one line.
"""

from collections.abc import Callable, Iterable
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl import listing
from rotctl import run as runs
from rotctl.config import load as composed
from rotctl.log import LOG_NAME, RunLog
from rotctl.override_files import expanded
from rotctl.schema import Config

if TYPE_CHECKING:
    import pandas as pd

RETRIES = 2  # for a run whose worker died

__all__ = ["load", "read", "report", "simulate", "sweep"]


def load(overrides: Iterable[str] = (), config_dir: str | Path | None = None) -> Config:
    """Compose and check a config.

    Args:
        overrides: in Hydra's syntax, such as `seed=3` or `terrain=stairs_up`, and `@FILE.yaml`
            of such; none: Forward Roll 1.
        config_dir: folder of your own behaviours, characters and the like; without, a `./conf`
            that has a `rotctl.yaml`.

    Raises:
        InputError: one line that names the bad value and the valid ones.
    """
    with listing.own(Path(config_dir) if config_dir else None):
        return composed(expanded(overrides))


def simulate(
    config: Config,
    out: str | Path = "runs",
    force: bool = False,
    progress: Callable[[], object] = lambda: None,
    config_dir: str | Path | None = None,
) -> RunLog:
    """Simulate a config into `out/<run id>/`, unless that run is there already; its log.

    Args:
        force: simulate again even so.
        progress: called after every control step.
        config_dir: as for `load`, where the config follows a clip of yours by its name.

    Raises:
        InputError: the config does not make a run, or the folder cannot be written.
    """
    with listing.own(Path(config_dir) if config_dir else None):
        return RunLog.open(runs.run(config, Path(out), force, progress).folder / LOG_NAME)


def sweep(
    overrides: Iterable[str],
    out: str | Path,
    jobs: int | None = None,
    config_dir: str | Path | None = None,
) -> "pd.DataFrame":
    """Simulate a grid of runs, or what is left of it; a row for each run.

    Args:
        overrides: in Hydra's sweep syntax, such as `seed=range(0,50)`, or `+experiment=NAME`.
        out: folder of the runs.
        jobs: local processes; None: one for each CPU.
        config_dir: as for `load`.

    Raises:
        InputError: a point makes no run, or the folder cannot be written.
    """
    from rotctl.results import experiments
    from rotctl.results.table import table
    from rotctl.sweep import keep
    from rotctl.sweep.claimed import require_claims
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.plan import plan, planned
    from rotctl.sweep.points import points
    from rotctl.sweep.workers import make_engine

    given, folder = expanded(overrides), Path(out)
    with listing.own(Path(config_dir) if config_dir else None):
        wanted = planned(points(experiments.matrix(given)))
        require_claims(given, wanted)
        with closing(make_engine(jobs, None)) as engine, locked(folder):
            if experiment := experiments.named(given):
                experiments.copy_into(folder, experiment)
            there = plan(wanted, folder, False, keep=keep.read("all"))
            launch(there, wanted, folder, engine, RETRIES, lambda tally: None)
    return table(folder).rows


def read(path: str | Path) -> RunLog:
    """Open a log, checked.

    Raises:
        LogError: it is missing, damaged, foreign or not whole.
    """
    return RunLog.open(path)


def report(folder: str | Path, out: str | Path = "site") -> Path:
    """Make pages of the runs below a folder; the first of them.

    Raises:
        InputError: there is no run, or the folder cannot be written.
    """
    from rotctl.report.site.build import report as pages

    pages(Path(folder), Path(out))
    return Path(out) / "index.html"
