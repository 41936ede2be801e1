"""Does a log repeat? Its config is simulated once more and compared with it, bit by bit.

Where the two part, the log's own torques are held on its model without the controller as well: so
it is seen whether control or physics went another way.
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.config.loading import recorded
from rotctl.engine import quiet
from rotctl.errors import InputError, LogError
from rotctl.log import SCHEMA, RunLog
from rotctl.log.schema import MODEL_PATH
from rotctl.runs.encoding import origin
from rotctl.runs.run import built, in_memory
from rotctl.runs.scenario import Scenario
from rotctl.runs.summary import summarise

CHANGED = " with changes"
TIMES = ("real_time_factor",)  # of the summary row: no two runs take the same
MACHINE = ("cpu", "features", "libc", "libm")  # what of a machine the bits of a run could hang on
REST = (*MACHINE, "run id")  # what tells neither code nor versions
Arrays = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class Repetition:
    """A log beside its repetition.

    Attributes:
        steps: rows of the log.
        parted: the first row that is not the same, or missing on one side; None if there is none.
        time: of that row [s].
        first: the datasets that differ there, in the order of the schema.
        whole: what else differs: datasets without rows, the seed beside the config, and keys of the
            summary row.
        physics: the first row that the log's torques no longer lead to, `steps` if they lead to
            all; None where it was not asked, as nothing parted or the models differ.
        differs: what of code, versions and machine is not the same, or not known to be, as
            either code had changes: (there, here).
    """

    steps: int
    parted: int | None
    time: float
    first: tuple[str, ...]
    whole: tuple[str, ...]
    physics: int | None
    differs: Mapping[str, tuple[str, str]]

    @property
    def same(self) -> bool:
        """Whether not one bit is another."""
        return self.parted is None and not self.whole

    @property
    def other_code(self) -> bool:
        """Whether code or versions are known to be other ones."""
        return any(a != b for name, (a, b) in self.differs.items() if name not in REST)


def repeat(log: RunLog, progress: Callable[[], object] = lambda: None) -> Repetition:
    """Simulate what a log's config says, for as long as the log lasts, and compare.

    Args:
        progress: called after every control step.

    Raises:
        LogError: the log is damaged, or its config makes no run here.
    """
    log.verify()
    config = recorded(log)
    try:
        scenario = built(config, again=True)
    except InputError as error:
        raise LogError(f"{log.path}: its config makes no run here: {error}") from None
    rate = scenario.config.controller.rate
    # One step more than the log has, to see whether it should have: not what a stranger asks for.
    duration = min(scenario.config.duration, (log.steps + 1) / rate)
    buffer, breakdown = in_memory(_lasting(scenario, duration), progress)
    here = {**buffer.arrays(), MODEL_PATH: np.array(scenario.model.mjcf.encode())}
    parted, first = _parted(log, here)
    whole = [name for name in SCHEMA if not _has_rows(name) and not _same(log[name], here[name])]
    if log.attributes["seed"] != config.seed:  # which stands beside the config, for people
        whole.append("seed")
    asked = parted is not None and MODEL_PATH not in whole
    if parted is None:
        summary = summarise(scenario, here, breakdown, wall=1.0)
        whole += [f"outcome {key}" for key in _unlike(log.outcome, summary)]
    return Repetition(
        steps=log.steps,
        parted=parted,
        time=(parted or 0) / rate,
        first=first,
        whole=tuple(whole),
        physics=_led_to(built(config, again=True), log) if asked else None,
        differs=_differs(log, scenario),
    )


def _lasting(scenario: Scenario, duration: float) -> Scenario:
    return replace(scenario, config=replace(scenario.config, duration=duration))


def _has_rows(name: str) -> bool:
    return SCHEMA[name].shape[:1] == ("steps",)


def _parted(log: RunLog, here: Arrays) -> tuple[int | None, tuple[str, ...]]:
    """The first row in which any dataset differs, and the datasets that do."""
    same = {name: _same_rows(log[name], here[name]) for name in SCHEMA if _has_rows(name)}
    row, rows_here = min(same.values()), len(here["trajectory/time"])
    if row == log.steps == rows_here:
        return None, ()
    both = row < min(log.steps, rows_here)  # else one ends where the other goes on
    return row, tuple(name for name, rows in same.items() if both and rows == row)


def _same_rows(a: NDArray[Any], b: NDArray[Any]) -> int:
    """How many rows are the same from the first on."""
    if a.shape[1:] != b.shape[1:]:
        return 0
    n = min(len(a), len(b))
    if n == 0:
        return 0
    unlike = (_bytes(a[:n]) != _bytes(b[:n])).any(axis=1)
    return int(unlike.argmax()) if unlike.any() else n


def _bytes(array: NDArray[Any]) -> NDArray[np.uint8]:
    """Row by row: a number that is not one equals itself here, and 0 is not -0."""
    flat = np.ascontiguousarray(array).view(np.uint8)
    return flat.reshape(len(array), -1)


def _same(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return a.shape == b.shape and a.tobytes() == b.tobytes()


def _unlike(there: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """Keys of two summary rows that differ."""
    keys = [key for key in {**here, **there} if key not in TIMES]
    return [key for key in keys if there.get(key, ()) != here.get(key, ())]


def _led_to(scenario: Scenario, log: RunLog) -> int:
    """How many of the log's states its first one, its torques and what disturbs lead to here."""
    mj, stepper, torques = scenario.model.mj, scenario.stepper, log["trajectory/ctrl"]
    states = zip(log["trajectory/qpos"], log["trajectory/qvel"], strict=True)
    period, data = 1.0 / scenario.config.controller.rate, mujoco.MjData(mj)
    before = [math.nan, *log["trajectory/phase"].tolist()]
    with quiet():
        for row, (qpos, qvel) in enumerate(states):
            if row == 0:
                data.qpos[:], data.qvel[:] = qpos, qvel
            stepper.evaluate(data)
            if not (_same(data.qpos, qpos) and _same(data.qvel, qvel)):
                return row
            scenario.disturbance.apply(data, period, before[row])
            stepper.advance(data, torques[row], scenario.observer.read(data).contacts)
    return log.steps


def _differs(log: RunLog, scenario: Scenario) -> dict[str, tuple[str, str]]:
    """What the log says of its origin that is not so here."""
    there, here = dict(log.attributes), origin(scenario)
    pairs = {"code": (_code(there), _code(here))}
    for group, names in (("versions", here["versions"]), ("machine", MACHINE)):
        told = _plain(there[group])
        pairs |= {name: (str(told.get(name, "unknown")), str(here[group][name])) for name in names}
    pairs["run id"] = (str(there["run_id"]), scenario.run_id)
    return {name: (a, b) for name, (a, b) in pairs.items() if a != b or a.endswith(CHANGED)}


def _code(found: Mapping[str, Any]) -> str:
    return f"{found['git_commit']:.12}{CHANGED if found['git_dirty'] else ''}"


def _plain(text: Any) -> dict[str, Any]:
    """A JSON object of a log; empty if it is none."""
    try:
        data = json.loads(str(text))
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}
