"""A rolling run in numbers: progress, ground, axis, line, torques."""

import math
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, along_way, floats, in_frame, solver_failures
from rotctl.metrics.halts import Halts, going, unkept
from rotctl.metrics.quantile import median, percentile
from rotctl.metrics.revolutions import worst_revolutions
from rotctl.metrics.smoothness import jerk, recovery, use_of_contacts
from rotctl.metrics.turning import longest_stall, setback
from rotctl.settings.fields import STRICT, Finite, NonNegative, Positive, Range

COLUMNS = (
    Column("revolutions", "Revolutions", "rev"),
    Column("angular_velocity_mean", "In-plane angular velocity", "rev/s"),
    Column("angular_velocity_commanded", "In-plane angular velocity asked for", "rev/s"),
    Column("speed_mean", "Speed", "m/s"),
    Column("speed_commanded", "Speed asked for", "m/s"),
    Column("heading_error_end", "Heading error at the end", "deg"),
    Column("lateral_drift", "Sideways drift", "m"),
    Column("lateral_rms", "Beside its line or path, rms", "m"),
    Column("longest_stall", "Longest stall", "s"),
    Column("slowest_revolution", "Slowest revolution", "s"),
    Column("setback", "Furthest back", "rev"),
    Column("height_least", "Lowest above the ground", "m"),
    Column("height_most", "Highest above the ground", "m"),
    Column("penetration", "Deepest overlap with the ground", "m"),
    Column("flight_turn", "Turned in the air, of a revolution", "rev"),
    Column("trunk_turn", "Trunk's own turn in a revolution", "rev"),
    Column("axis_error", "Axis off, over a revolution", "deg"),
    Column("travel_least", "Shortest revolution", "m"),
    Column("travel_most", "Longest revolution", "m"),
    Column("ground_force_p99", "Ground force, 99th percentile", "N"),
    Column("ground_force_peak", "Ground force, peak", "N"),
    Column("airborne", "Share of the time without a contact", ""),
    Column("jerk", "Jerk of the joints, rms", "rad/s3"),
    Column("chatter", "Contacts taken or left by control", "1/s"),
    Column("sticking", "Held by control with hardly a force on it", ""),
    Column("recovery", "Rolling on after the push", "s"),
    Column("recovered", "Rolled on in time after the push", ""),
)


@validated(frozen=True, config=STRICT)
class RollingCriteria:
    """Limits of a successful roll; see `conf/criteria/rolling.yaml`.

    Those of a revolution hold for every one, wherever in the roll it is counted from.

    Attributes:
        stall_time: [s]; stall_progress: [rev].
        revolution_time: that a revolution may take [s].
        setback: that progress may fall back by [rev].
        height: lowest and highest of the centre of mass above the ground below it [m].
        penetration: deepest overlap with the ground [m].
        flight_turn: of a revolution that may be turned without touching the ground [rev].
        trunk_turn: that the trunk turns at least about its own axis in a revolution [rev].
        axis: tilt of that axis against the rolling axis, over a revolution [deg].
        travel: least and most that a revolution covers along the way [m].
        heading: [deg]; lateral_drift: [m].
        settle: [s] at the start left out of mean speeds.
        recovery_time: in which a push should be overcome [s]: the axis back to within
            recovery_heading [deg], and recovery_progress [rev] in the stall time from then on.
    """

    name: str
    kind: Literal["rolling"]
    stall_time: Positive
    stall_progress: Positive
    revolution_time: Positive
    setback: Positive
    height: Range
    penetration: Positive
    flight_turn: Positive
    trunk_turn: Finite
    axis: Positive
    travel: Range
    heading: Positive
    lateral_drift: Positive
    settle: NonNegative
    recovery_time: Positive
    recovery_heading: Positive
    recovery_progress: Positive
    description: str = ""


@dataclass(frozen=True)
class RollingMetrics:
    """What a log says of a roll.

    What is said of a revolution is the worst of all; NaN if none was made.

    Attributes:
        duration: simulated time in the log [s].
        revolutions: in-plane excursion in the direction commanded [rev].
        angular_velocity_mean: in-plane, after settling, with its sign [rev/s].
        speed_mean: of the centre of mass forward, after settling [m/s].
        heading_error_end: median heading of the trunk's axis that it rolls about, over
            the last second, against the rolling axis [deg]; positive turns left.
        lateral_drift: furthest of the centre of mass to either side of where it started [m];
            NaN on a way that turns and has no places, as `lateral_rms`.
        lateral_rms: root mean square of how far it is beside that line, or the path it follows [m].
        longest_stall: longest time without the criterion's progress, halts left out [s].
        stalled_at: when that began [s].
        went_on: when the first halt began that it did not keep [s]; NaN if it kept all.
        slowest_revolution: longest time that a revolution took [s].
        setback: furthest that progress fell back [rev].
        height_least: lowest of the centre of mass above the ground below it [m].
        height_most: highest of it [m].
        penetration: deepest overlap with the ground [m].
        flight_turn: largest part of a revolution turned while the ground gave no force [rev].
        trunk_turn: least that the root body turned about the trunk's axis in a revolution [rev].
        axis_error: largest tilt of the trunk's axis against the rolling axis, by the mean of its
            cosine over a revolution [deg].
        travel_least: shortest way forward, in the direction of progress, of a revolution [m].
        travel_most: longest of it [m].
        ground_force_p99: 99th percentile of the ground's force, mean over a control step [N].
        ground_force_peak: its largest magnitude in a physics step [N].
        airborne: share of the control steps that begin without a contact with the ground; in those
            of `flight_turn` none comes within the step, either.
        jerk: root mean square over joints and time [rad/s3].
        chatter: bodies whose contacts control begins or ceases to use, a second [1/s].
        sticking: share of what control keeps still on the ground that has hardly a force on it.
        recovery: from the end of what acted from outside until it rolls on along the way [s];
            NaN if it never did, or nothing acted and ended.
        recovered: 1 if that was in time, 0 if not; NaN where nothing acted and ended, or the run
            ended before that could be told.
        torque_p99_fraction: 99th percentile of |torque| / limit over joints and time.
        solver_failures: control steps on which every solver failed.
    """

    duration: float
    revolutions: float
    angular_velocity_mean: float
    speed_mean: float
    heading_error_end: float
    lateral_drift: float
    lateral_rms: float
    longest_stall: float
    stalled_at: float
    went_on: float
    slowest_revolution: float
    setback: float
    height_least: float
    height_most: float
    penetration: float
    flight_turn: float
    trunk_turn: float
    axis_error: float
    travel_least: float
    travel_most: float
    ground_force_p99: float
    ground_force_peak: float
    airborne: float
    jerk: float
    chatter: float
    sticking: float
    recovery: float
    recovered: float
    torque_p99_fraction: float
    solver_failures: int


_ZERO_AT_FIRST = (
    "duration",
    "revolutions",
    "lateral_drift",
    "lateral_rms",
    "longest_stall",
    "stalled_at",
)
_NO_ROWS: dict[str, Any] = {each.name: math.nan for each in fields(RollingMetrics)}
NO_ROWS = RollingMetrics(**_NO_ROWS | dict.fromkeys(_ZERO_AT_FIRST, 0.0) | {"solver_failures": 0})


def measure(
    log: Arrays,
    criteria: RollingCriteria,
    commanded: float,
    period: float,
    whole: bool,
    halts: Halts = (),
) -> RollingMetrics:
    """Measure a roll.

    Args:
        log: arrays by schema path, a `RunLog` or a buffer's; may have no rows.
        commanded: in-plane angular velocity [rev/s]; its sign is the direction of progress.
        period: of the control [s].
        whole: whether the run went on for as long as it was to.
        halts: when it is told to halt, and until when [s].
    """
    com = along_way(log)
    steps = len(com)
    if steps == 0:
        return NO_ROWS
    angle = in_frame(log, "trajectory/angular_excursion")[:, 1] / (2 * math.pi)
    direction = -1.0 if commanded < 0 else 1.0
    progress = direction * angle
    first = min(round(criteria.settle / period), steps - 1)
    # A run that ends before it settled has no mean speeds.
    elapsed = (steps - 1 - first) * period or math.nan
    axis = in_frame(log, "trajectory/trunk_axis")
    last_second = axis[-round(1.0 / period) :]
    heading = np.degrees([math.atan2(-x, y) for x, y, _ in last_second.tolist()])
    time, least = period * np.arange(steps, dtype=np.float64), criteria.stall_progress
    rolls = going(time, halts)
    stall, begin = longest_stall(progress[rolls], least, period) if rolls.any() else (0.0, 0.0)
    stalled_at = float(np.flatnonzero(rolls)[round(begin / period)] * period) if stall else 0.0
    went_on = unkept(time, progress, halts, least, period)
    beside = com[:, 1] - com[0, 1]
    height = com[:, 2] - floats(log, "trajectory/ground_height")
    force = floats(log, "contacts/ground_force")
    fraction = np.abs(log["trajectory/ctrl"]) / log["model/torque_limit"]
    return RollingMetrics(
        duration=steps * period,
        revolutions=float(progress[-1] - progress[0]),
        angular_velocity_mean=float((angle[-1] - angle[first]) / elapsed),
        speed_mean=float((com[-1, 0] - com[first, 0]) / elapsed),
        heading_error_end=_median_angle(heading),
        lateral_drift=float(np.abs(beside).max()),
        lateral_rms=float(np.sqrt((beside**2).mean())),
        longest_stall=stall,
        stalled_at=stalled_at,
        went_on=math.nan if went_on is None else went_on,
        setback=setback(progress),
        height_least=float(height.min()),
        height_most=float(height.max()),
        penetration=float(floats(log, "contacts/penetration").max()),
        ground_force_p99=percentile(np.sqrt((force**2).sum(axis=1)), 99),
        ground_force_peak=float(floats(log, "contacts/ground_force_peak").max()),
        airborne=float(np.mean(np.asarray(log["contacts/count"]) == 0)),
        jerk=jerk(log, period),
        **use_of_contacts(log, period),
        **recovery(log, criteria, progress, axis, period, whole),
        torque_p99_fraction=percentile(fraction, 99),
        solver_failures=solver_failures(log),
        **worst_revolutions(log, direction, progress, axis, period, rolls),
    )


def _median_angle(degrees: NDArray[np.float64]) -> float:
    """Median about the mean direction, in (-180, 180]: +179 and -179 do not make 0."""
    turn = np.radians(degrees)
    centre = math.degrees(math.atan2(np.sin(turn).sum(), np.cos(turn).sum()))
    middle = centre + median((degrees - centre + 180.0) % 360.0 - 180.0)
    return float(180.0 - (180.0 - middle) % 360.0)
