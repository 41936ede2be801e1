"""What was tried, on disk: an Optuna study in SQLite that holds finished trials only.

A kill at any time loses the candidates that were being tried and nothing else. The file can
be opened with Optuna's own tools, such as optuna-dashboard.
"""

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from urllib.parse import quote

from pydantic import Field

from rotctl import files
from rotctl.errors import InputError
from rotctl.settings.checking import checked
from rotctl.settings.fields import Finite, Fraction
from rotctl.tune.sampler import distributions
from rotctl.tune.space import Space
from rotctl.tune.values import Values

if TYPE_CHECKING:
    from optuna import Study

STUDY_NAME = "study.db"
_BESIDE = ("-journal", "-wal", "-shm")  # what SQLite adds to the name of a database
_JOURNAL = bytes.fromhex("d9d505f920a163d7")  # at the end of one that names a super-journal


MOST = 1_000_000  # generations, and candidates in one


@dataclass(frozen=True)
class Trial:
    """A candidate and how it did.

    Attributes:
        generation, index: which it was, counted from 0.
        score: over its runs; see `objective`.
        finished: fraction of its runs that were not cut.
        lost: runs whose worker died every time.
        seconds: since the generation began, when its last run was done [s].
    """

    generation: Annotated[int, Field(ge=0, le=MOST)]
    index: Annotated[int, Field(ge=0, le=MOST)]
    values: Values
    score: Finite
    finished: Fraction
    lost: Annotated[int, Field(ge=0)]
    seconds: Finite


class History:
    """The trials of one search in one folder."""

    def __init__(self, study: "Study", space: Space, path: Path) -> None:
        self._study = study
        self._path = path
        self._distributions = distributions(space)

    def add(self, trial: Trial) -> None:
        """Remember a finished trial.

        Raises:
            InputError: the file cannot be written, or is damaged.
        """
        from optuna.trial import create_trial

        facts = asdict(trial)
        del facts["values"], facts["score"]
        with _refused(self._path):
            self._study.add_trial(
                create_trial(
                    params=trial.values,
                    distributions=self._distributions,
                    value=trial.score,
                    user_attrs=facts,
                )
            )

    def trials(self) -> list[Trial]:
        """All trials, by generation and index.

        Raises:
            InputError: the file holds something else, or is damaged.
        """
        with _refused(self._path):
            kept = self._study.get_trials(deepcopy=False)
            data = [t.user_attrs | {"values": t.params, "score": t.value} for t in kept]
            trials = [checked(Trial, each) for each in data]
            if any(trial.values.keys() != self._distributions.keys() for trial in trials):
                raise InputError("its candidates have other parameters")
        return sorted(trials, key=lambda trial: (trial.generation, trial.index))


def open_history(folder: Path, space: Space, identity: dict[str, Any]) -> History:
    """The history in a folder, new or to be continued.

    Args:
        identity: all that makes the search what it is, as plain data.

    Raises:
        InputError: the folder cannot be written, or holds another search.
    """
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    path = folder / STUDY_NAME
    _require_plain(path)
    with _refused(path):
        study = optuna.create_study(
            storage=f"sqlite:///{quote(str(path.resolve()))}",  # a "?" would end the path
            study_name="rotctl tune",
            direction="maximize",
            load_if_exists=True,
        )
        before = study.user_attrs.get("identity")
        plain = json.loads(json.dumps(identity))
        if before is None:
            study.set_user_attr("identity", plain)
    changed = [] if before is None else list(_differences(before, plain))
    if changed:
        raise InputError(f"{folder} holds another search, with {changed[0]}; choose another --out")
    return History(study, space, path)


@contextmanager
def _refused(path: Path) -> Iterator[None]:
    """Whatever Optuna makes of a file that is no history becomes one line."""
    from optuna.exceptions import OptunaError
    from sqlalchemy.exc import SQLAlchemyError

    trouble = (OptunaError, SQLAlchemyError, OSError, RuntimeError, LookupError, ValueError)
    try:
        yield
    except InputError as error:
        raise InputError(f"cannot use {path}: it holds no trials: {error}") from None
    except (*trouble, TypeError, AttributeError) as error:
        reason = (str(getattr(error, "orig", None) or error).splitlines() or ["damaged"])[0]
        raise InputError(f"cannot use {path}: {reason:.200}") from None


def _require_plain(path: Path) -> None:
    """No file that SQLite would open or remove leads out of the folder.

    Raises:
        InputError: one is a link, or no file; or a transaction over several databases was cut
            off, which no search makes: to finish it SQLite removes a file that the journal names.
    """
    for each in (path, *(path.with_name(path.name + ending) for ending in _BESIDE)):
        if os.path.lexists(each):
            with files.opened(each, linked=False) as file:
                file.seek(max(0, os.fstat(file.fileno()).st_size - len(_JOURNAL)))
                if file.read() == _JOURNAL:
                    raise InputError(f"{each}: is of a transaction over several databases")


def by_generation(trials: list[Trial], population: int) -> tuple[list[list[Trial]], list[Trial]]:
    """The complete generations, and the trials of the one that was interrupted."""
    groups = [
        [trial for trial in trials if trial.generation == generation]
        for generation in range(1 + max((trial.generation for trial in trials), default=-1))
    ]
    if groups and len(groups[-1]) < population:
        return groups[:-1], groups[-1]
    return groups, []


def _differences(before: Any, now: Any, where: str = "") -> Iterator[str]:
    """What was otherwise, `key=value (now value)`."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in [*before, *(key for key in now if key not in before)]:
            inner = f"{where}.{key}" if where else str(key)
            yield from _differences(before.get(key), now.get(key), inner)
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        for i, pair in enumerate(zip(before, now, strict=True)):
            yield from _differences(*pair, f"{where}.{i}")
    elif before != now:
        yield f"{where}={json.dumps(before)} (now {json.dumps(now)})"
