"""Experiments: named sweeps with the claims they are to judge, in `experiments/NAME.yaml`."""

from dataclasses import field
from typing import Any

import yaml
from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.listing import shipped
from rotctl.settings import STRICT

PREFIX = "+experiment="


@validated(frozen=True, config=STRICT)
class Claim:
    """One sentence of a paper, or of ours, as numbers.

    Attributes:
        metric: `success_rate`, or a column of the summary, of which the median counts.
        where: column -> value of the runs that it is about; all runs if empty.
        expected: the value, in the unit of the metric.
        tolerance: how far from it still counts, either way.
    """

    id: str
    metric: str
    expected: float
    tolerance: float
    source: str
    note: str = ""
    where: dict[str, str | int | float] = field(default_factory=dict)


@validated(frozen=True, config=STRICT)
class Experiment:
    """A sweep that can be named.

    Attributes:
        source: paper and table.
        matrix: grids, each a list of overrides in sweep syntax.
        seeds: values of `seed` in sweep syntax, for each grid.
    """

    title: str
    source: str
    matrix: list[list[str]]
    seeds: str
    claims: list[Claim]

    def grids(self, further: list[str]) -> list[list[str]]:
        """The matrix with its seeds, and with further overrides, which replace theirs."""
        replaced = {_key(override) for override in further}
        grids = [[*grid, f"seed={self.seeds}"] for grid in self.matrix]
        return [[*(o for o in grid if _key(o) not in replaced), *further] for grid in grids]


def _key(override: str) -> str:
    return override.partition("=")[0]


_ADAPTER = TypeAdapter(Experiment)


def names() -> list[str]:
    """The experiments there are, sorted."""
    return sorted(path.stem for path in shipped("experiments").glob("*.yaml"))


def experiment(name: str) -> Experiment:
    """Read an experiment.

    Raises:
        InputError: there is no such experiment, or its file is wrong.
    """
    valid = names()
    if name not in valid:
        raise InputError(f"{PREFIX}{name}: no such experiment; valid: {', '.join(valid)}")
    path = shipped("experiments") / f"{name}.yaml"
    try:
        return _ADAPTER.validate_python(yaml.safe_load(path.read_text(encoding="utf-8")))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"{path}: {where}: {first['msg']}") from None
    except yaml.YAMLError as error:
        raise InputError(f"{path}: is not YAML: {' '.join(str(error).split())}") from None


def matrix(overrides: list[str]) -> list[list[str]]:
    """The grids that a command line asks for: its own, or those of its experiment.

    Raises:
        InputError: more than one experiment, or a wrong one.
    """
    named: Any = [o.removeprefix(PREFIX) for o in overrides if o.startswith(PREFIX)]
    if len(named) > 1:
        raise InputError(f"{PREFIX}{named[1]}: one experiment a sweep")
    if not named:
        return [overrides]
    return experiment(named[0]).grids([o for o in overrides if not o.startswith(PREFIX)])
