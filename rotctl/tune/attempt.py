"""One training run, cut as soon as it is hopeless: the task that the engines carry out."""

from dataclasses import dataclass
from math import acos, degrees, isnan, nan, pi

from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.log import TrajectoryBuffer
from rotctl.maths.rotations import dot
from rotctl.metrics.columns import Arrays
from rotctl.metrics.criteria.judge import judge
from rotctl.metrics.criteria.rolling import RollingCriteria
from rotctl.metrics.expressions.evaluation import evaluate
from rotctl.metrics.expressions.expression import Expression
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.loop import Look
from rotctl.tune.objective import TrialRun
from rotctl.tune.space import Stopping


@dataclass(frozen=True)
class Attempt:
    """A run to be tried.

    Attributes:
        columns: of its summary row that the objective looks at.
        metrics: further ones that may be among them.
    """

    config: Config
    stopping: Stopping
    columns: tuple[str, ...] = ()
    metrics: tuple[Expression, ...] = ()


def attempt(item: Attempt) -> TrialRun:
    """Simulate one run in memory.

    Raises:
        InputError: the config does not make a run.
    """
    config = item.config
    behaviour, criteria = searchable(config)
    scenario = build(config)
    commanded, period = behaviour.angular_velocity, 1.0 / config.controller.rate
    buffer, _ = in_memory(scenario, look=hopeless(item.stopping, commanded))
    asked, log = behaviour.commanded, buffer.arrays()
    mj, halts = scenario.model.mj, behaviour.halts
    judged = judge(log, criteria, asked, period, config.duration, mj, halts)
    found = judged.columns | {metric.name: _value(metric, log, config) for metric in item.metrics}
    return TrialRun(
        survived=found["duration"],
        wanted=config.duration,
        revolutions=found["revolutions"],
        drift=0.0 if isnan(found["lateral_drift"]) else found["lateral_drift"],
        heading=found["heading_error_end"],
        success=not judged.reason,
        columns={name: float(found.get(name, nan)) for name in item.columns},
    )


def searchable(config: Config) -> tuple[RollingSettings, RollingCriteria]:
    """What of a config a search is about.

    Raises:
        InputError: it is no roll, or one that ends.
    """
    behaviour, criteria = config.behaviour, config.criteria
    if not isinstance(behaviour, RollingSettings):
        raise InputError(
            f"behaviour={behaviour.name} is of kind {behaviour.kind}; a search is for kind rolling"
        )
    if not isinstance(criteria, RollingCriteria):
        raise InputError(
            f"criteria={criteria.name} is of kind {criteria.kind}; a search judges by kind "
            "rolling, and so a roll without a finish"
        )
    return behaviour, criteria


def _value(metric: Expression, log: Arrays, config: Config) -> float:
    """NaN where a run was cut too early for it; what is wrong with a whole run is raised."""
    try:
        return evaluate(metric, log)
    except InputError:
        if len(log["trajectory/time"]) < round(config.duration * config.controller.rate):
            return nan
        raise


def hopeless(stopping: Stopping, commanded: float) -> Look:
    """A test for one run: has it stalled, or left its axis?

    Args:
        stopping: the limits.
        commanded: in-plane angular velocity [rev/s]; its sign is the direction of progress.
    """
    direction = -1.0 if commanded < 0 else 1.0
    mark: tuple[float, float] | None = None  # progress [rev] and time [s] when it last grew

    def stop(buffer: TrajectoryBuffer, done: int) -> bool:
        nonlocal mark
        rows, now = buffer.trajectory, done - 1
        time, left = float(rows.time[now]), buffer.command.axes[now, 1]
        progress = direction * dot(left, rows.angular_excursion[now]) / (2.0 * pi)
        if mark is None or progress >= mark[0] + stopping.stall_progress:
            mark = progress, time
        off_axis = degrees(acos(min(max(dot(left, rows.trunk_axis[now]), -1.0), 1.0)))
        return time - mark[1] >= stopping.stall_time or off_axis >= stopping.off_axis

    return stop
