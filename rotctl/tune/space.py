"""What a search may change, and on which runs: `conf/tune/NAME.yaml`."""

import re
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.choices.listing import instead_of, named_file, named_files
from rotctl.errors import InputError
from rotctl.settings import documents
from rotctl.settings.checking import checked
from rotctl.settings.fields import STRICT, Finite, Positive
from rotctl.suggestion import instead
from rotctl.tune.key_braces import MOST, expanded
from rotctl.tune.objective import Objective

TRAINING_SEEDS = 1_000_000  # the first; every seed below is for judging
# An index of three digits is plenty: a list is made as long as that.
_KEY = re.compile(r"[A-Za-z]\w*(\.[A-Za-z]\w*)+(\.\d{1,3})?")
_DRAWN = re.compile(r"[+~]*seed\b")

SamplerName = Literal["cmaes", "tpe"]
Count = Annotated[int, Strict(), Field(ge=1, le=10_000)]


def _training(seed: int) -> int:
    if seed < TRAINING_SEEDS:
        raise ValueError(f"training seeds start at {TRAINING_SEEDS:,}; those below are for judging")
    return seed


def _word(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII):
        raise ValueError("must be letters, digits and _, a letter first")
    return name


def unseeded(overrides: list[str]) -> list[str]:
    """The overrides, none of which may choose the seeds of runs.

    Raises:
        ValueError: one does.
    """
    for override in overrides:
        if _DRAWN.match(override):
            raise ValueError(
                f"{override}: tune draws the seeds of its runs itself, from {TRAINING_SEEDS:,} "
                "on; those below are for judging"
            )
    return overrides


Overrides = Annotated[list[str], AfterValidator(unseeded)]


@validated(frozen=True, config=STRICT)
class Parameter:
    """One number of the config that the search may change.

    Attributes:
        key: dotted, an element of a list by its number: `controller.tasks.linear.damping.0`; in a
            file, braces stand for several: `behaviour.poses.{a,b}.knee`.
        low, high: its range, in `unit`.
        scale: `log` for what is known only to a factor.
        start: where the search begins if the config does not have this number.
        reason: for the range.
    """

    key: str
    low: Finite
    high: Finite
    unit: str
    scale: Literal["linear", "log"] = "linear"
    start: Finite | None = None
    reason: str = ""

    def __post_init__(self) -> None:
        if not _KEY.fullmatch(self.key):
            raise ValueError("key must be dotted names, as in controller.tasks.linear.damping.0")
        if self.key.startswith("criteria."):
            raise ValueError(f"key={self.key:.60}: criteria judge what a search finds")
        if self.low >= self.high:
            raise ValueError(f"low={self.low:g} must be below high={self.high:g}")
        if self.start is not None and not self.low <= self.start <= self.high:
            raise ValueError(
                f"start={self.start:g} must be within its range, {self.low:g} to {self.high:g}"
            )
        if self.scale == "log" and self.low <= 0:
            raise ValueError(f"low={self.low:g} must be above 0 on a log scale")


@validated(frozen=True, config=STRICT)
class Stopping:
    """When a run is hopeless and is cut.

    Attributes:
        stall_time: without `stall_progress` [s].
        stall_progress: in-plane, in the direction commanded [rev].
        off_axis: of the trunk's axis from the rolling axis [deg].
    """

    stall_time: Positive
    stall_progress: Positive
    off_axis: Annotated[Positive, Field(le=180)]


@validated(frozen=True, config=STRICT)
class Runs:
    """The runs of one candidate; run i takes seed i of its generation and variation i.

    Attributes:
        seeds: number of runs, each from another start; fresh ones every generation.
        duration: simulated time of each [s].
        first_seed: of the training seeds.
        variations: lists of overrides, gone through again and again; [] is no change.
        final: runs on further training seeds that choose between the last candidates.
    """

    seeds: Count
    duration: Positive
    final: Count
    first_seed: Annotated[int, Strict(), AfterValidator(_training)] = TRAINING_SEEDS
    variations: Annotated[tuple[Overrides, ...], Field(min_length=1)] = ([],)

    def __post_init__(self) -> None:
        most, told = min(self.seeds, self.final), len(self.variations)
        if told > most:
            key = "seeds" if self.seeds == most else "final"
            raise ValueError(
                f"variations: {told} of them, and with {key}={most} the last never come"
            )


@validated(frozen=True, config=STRICT)
class Sampler:
    """How candidates are proposed.

    Attributes:
        name: `cmaes` moves a normal distribution, `tpe` models good and bad regions.
        population: candidates in a generation.
        sigma: standard deviation at the start, as a fraction of each range; `cmaes` only.
    """

    name: SamplerName
    population: Annotated[int, Strict(), Field(ge=4, le=1000)]
    sigma: Annotated[Positive, Field(le=1)]


@validated(frozen=True, config=STRICT)
class Space:
    """A search; see `docs/tuning.md`.

    Attributes:
        base: overrides that make the config to start from.
        trials: candidates, where the command line names no other budget.
    """

    name: Annotated[str, AfterValidator(_word)]
    title: str
    base: Overrides
    parameters: Annotated[list[Parameter], Field(min_length=2, max_length=MOST)]
    runs: Runs
    objective: Objective
    stopping: Stopping
    sampler: Sampler
    trials: Annotated[int, Strict(), Field(ge=1)]
    description: str = ""

    def __post_init__(self) -> None:
        keys = [parameter.key for parameter in self.parameters]
        twice = next((key for key in keys if keys.count(key) > 1), None)
        if twice:
            raise ValueError(f"parameters name {twice} twice")
        for number, changes in enumerate(self.runs.variations):
            for override in changes:
                if override.partition("=")[0].lstrip("+~") in keys:
                    raise ValueError(
                        f"runs.variations.{number}: {override:.60}: acts on nothing, as that is "
                        "searched and a candidate has its own value"
                    )


def names() -> list[str]:
    """The spaces that come with rotctl."""
    return sorted(named_files("tune"))


def load_space(name: str) -> Space:
    """Read a space: one of `names()`, or any file that ends in .yaml.

    Raises:
        InputError: one line that names the file, the bad value and what is valid.
    """
    if not name.endswith(".yaml") and name not in names():
        valid = f"{instead(name, names())}, or the path of a .yaml file"
        raise InputError(f"{name}: no such space; {instead_of('tune', name, valid)}")
    path = Path(name) if name.endswith(".yaml") else named_file("tune", name)
    data = documents.read_yaml(path, linked=True)
    if isinstance(data, dict) and "parameters" in data:
        data["parameters"] = expanded(data["parameters"])
    try:
        return checked(Space, data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
