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

from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, closing
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl.choices import config_folders
from rotctl.choices.override_files import expanded
from rotctl.config.loading import load as composed
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.log import LOG_NAME, RunLog
from rotctl.runs import run as runs

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
    with _own(config_dir):
        return composed(_words(overrides))


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
        InputError: it is no config, it does not make a run, or the folder cannot be written.
    """
    if not isinstance(config, Config):
        raise InputError(
            f"config: must be one, not of {_kind(config)}; api.load(['seed=3']) makes it"
        )
    folder = _path("out", out)
    with _own(config_dir):
        return RunLog.open(runs.run(config, folder, force, progress).folder / LOG_NAME)


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
    from rotctl.sweep.asked import asked
    from rotctl.sweep.claimed import require_claims
    from rotctl.sweep.engine_choice import make_engine
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.plan import plan

    given, folder = _words(overrides), _path("out", out)
    if not isinstance(jobs, int | None):
        raise InputError(f"jobs: must be a number or None, not of {_kind(jobs)}")
    with _own(config_dir):
        wanted = asked(given)
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
        InputError: it is no path.
        LogError: it is missing, damaged, foreign or not whole.
    """
    return RunLog.open(_path("path", path))


def report(folder: str | Path, out: str | Path = "site") -> Path:
    """Make pages of the runs below a folder; the first of them.

    Raises:
        InputError: there is no run, or the folder cannot be written.
    """
    from rotctl.report.site.build import report as pages

    pages(_path("folder", folder), place := _path("out", out))
    return place / "index.html"


_OVERRIDES = "overrides: must be a list of texts, such as ['seed=3']"


def _words(overrides: Iterable[str]) -> list[str]:
    """Overrides as a list, with those of files in their files' places.

    Raises:
        InputError: they are no texts in a list, but such as a text by itself, which is one of
            letters, or a dict, which is one of keys.
    """
    if isinstance(overrides, str | Mapping) or not isinstance(overrides, Iterable):
        what = "a text" if isinstance(overrides, str) else f"of {_kind(overrides)}"
        raise InputError(f"{_OVERRIDES}, not {what}")
    words = list(overrides)
    other = [word for word in words if not isinstance(word, str)]
    if other:
        raise InputError(f"{_OVERRIDES}, and {other[0]!r:.60} is of {_kind(other[0])}")
    return expanded(words)


def _own(config_dir: str | Path | None) -> AbstractContextManager[object]:
    return config_folders.own(_path("config_dir", config_dir) if config_dir else None)


def _path(name: str, path: str | Path) -> Path:
    """The path that was given as `name`.

    Raises:
        InputError: it is none.
    """
    if not isinstance(path, str | PathLike):
        raise InputError(f"{name}: must be a path, not of {_kind(path)}")
    if not str(path):  # a name that was forgotten, and not this folder
        raise InputError(f"{name}: is empty; '.' is this folder")
    return Path(path)


def _kind(value: object) -> str:
    return f"type {type(value).__name__}"
