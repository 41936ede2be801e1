"""Experiments: named sweeps with the claims they are to judge, in `experiments/NAME.yaml`.

A sweep leaves a copy of its experiment in its folder, so that the folder alone says what it is
to show.
"""

from dataclasses import field
from pathlib import Path
from typing import Annotated

from pydantic import BeforeValidator
from pydantic.dataclasses import dataclass as validated

from rotctl import files
from rotctl.choices.listing import EXPERIMENTS, instead_of, named_file, named_files
from rotctl.errors import InputError
from rotctl.metrics.claims import Claim, Where
from rotctl.settings import checking, complaints, documents
from rotctl.settings.fields import STRICT
from rotctl.suggestion import instead

PREFIX = "+experiment="
COPY = "experiment-{}.yaml"


@validated(frozen=True, config=STRICT)
class Deviation:
    """Where an experiment differs from what it reproduces, and why.

    Attributes:
        where: column -> value of the runs that it is about; all runs if empty.
    """

    text: str
    where: Where = field(default_factory=dict)


def _in_words(seeds: object) -> str:
    """Seeds as a sweep takes them; of a single one YAML makes a number."""
    if type(seeds) not in (str, int) or not any(map(str.isdigit, str(seeds))):
        raise ValueError("must be one seed, or several as in range(0,100) or 2000,2001")
    return str(seeds)


@validated(frozen=True, config=STRICT)
class Experiment:
    """A sweep that can be named.

    Attributes:
        source: paper and table.
        matrix: grids, each a list of overrides in sweep syntax.
        seeds: values of `seed` in sweep syntax, for each grid.
        limitations: what its result does not say, one sentence each.
    """

    title: str
    source: str
    matrix: list[list[str]]
    seeds: Annotated[str, BeforeValidator(_in_words)]
    claims: list[Claim]
    deviations: list[Deviation] = field(default_factory=list)
    limitations: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        named = [claim.id for claim in self.claims]
        for name in named:
            if named.count(name) > 1:
                raise ValueError(f"claims: {name:.60} is the id of two; reports go by it")

    def grids(self, further: list[str]) -> list[list[str]]:
        """The matrix with its seeds, and with further overrides, which replace theirs."""
        replaced = {_key(override) for override in further}
        grids = [[*grid, f"seed={self.seeds}"] for grid in self.matrix]
        return [[*(o for o in grid if _key(o) not in replaced), *further] for grid in grids]


def _key(override: str) -> str:
    return override.partition("=")[0]


def names() -> list[str]:
    """The experiments there are, sorted."""
    return sorted(named_files(EXPERIMENTS))


def experiment(name: str) -> Experiment:
    """An experiment that comes with rotctl, or is in the user's folder.

    Raises:
        InputError: there is no such experiment, or its file is wrong.
    """
    return checking.read(Experiment, _path(name), linked=True)


def read(path: Path) -> Experiment:
    """Read the copy of an experiment in the folder of a sweep, which may be a stranger's.

    Raises:
        InputError: it is wrong; one line that says where.
    """
    return checking.read(Experiment, path, linked=False)


def copy_into(folder: Path, name: str) -> None:
    """Leave a copy of an experiment in the folder of its sweep.

    Raises:
        InputError: there is no such experiment, or the folder cannot be written.
    """
    content = files.read(_path(name), documents.LARGEST, linked=True)
    files.replace(folder / COPY.format(name), content)


def copies(folder: Path) -> dict[str, Path]:
    """Name -> file of the experiments in the folder of a sweep, sorted."""
    before, after = COPY.split("{}")
    found = sorted(folder.glob(COPY.format("*")))
    return {path.name.removeprefix(before).removesuffix(after): path for path in found}


def named(overrides: list[str]) -> str:
    """The experiment that a command line names; empty if it names none.

    Raises:
        InputError: it names more than one, or one that there is not.
    """
    for override in overrides:
        if override.startswith(PREFIX.removeprefix("+")):
            shown = complaints.clip(override)
            raise InputError(f"{shown}: write +{shown}")
    found = [o.removeprefix(PREFIX) for o in overrides if o.startswith(PREFIX)]
    if len(found) > 1:
        raise InputError(f"{PREFIX}{found[1]}: one experiment a sweep")
    if found:
        _path(found[0])
    return found[0] if found else ""


def matrix(overrides: list[str]) -> list[list[str]]:
    """The grids that a command line asks for: its own, or those of its experiment.

    Raises:
        InputError: more than one experiment, or a wrong one.
    """
    name = named(overrides)
    further = [o for o in overrides if not o.startswith(PREFIX)]
    return experiment(name).grids(further) if name else [overrides]


def _path(name: str) -> Path:
    valid = names()
    if name not in valid:
        near = instead_of(EXPERIMENTS, name, instead(name, valid))
        raise InputError(f"{PREFIX}{name}: no such experiment; {near}")
    return named_file(EXPERIMENTS, name)
