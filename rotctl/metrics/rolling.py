"""A rolling run in numbers: progress, stalls, heading, drift, torques, and whether it succeeded."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic.dataclasses import dataclass as validated

from rotctl.settings import STRICT, NonNegative, Positive

Arrays = Mapping[str, NDArray[np.generic]]


@validated(frozen=True, config=STRICT)
class RollingCriteria:
    """Limits of a successful roll; see `conf/criteria/rolling.yaml`.

    Attributes:
        stall_time: [s]; stall_progress: [rev].
        heading: [deg]; lateral_drift: [m].
        settle: [s] at the start left out of mean speeds.
    """

    name: str
    stall_time: Positive
    stall_progress: Positive
    heading: Positive
    lateral_drift: Positive
    settle: NonNegative
    description: str = ""


@dataclass(frozen=True)
class RollingMetrics:
    """What a log says of a roll.

    Attributes:
        duration: simulated time in the log [s].
        revolutions: in-plane excursion in the direction commanded [rev].
        angular_velocity_mean: in-plane, after settling, with its sign [rev/s].
        speed_mean: of the centre of mass along x, after settling [m/s].
        heading_error_end: median heading of the trunk's axis that it rolls about, over
            the last second, against the rolling axis [deg]; positive turns left.
        lateral_drift: largest |y| of the centre of mass from where it started [m].
        longest_stall: longest time without the criterion's progress [s].
        stalled_at: when that began [s].
        airborne: share of the time without a contact with the ground.
        torque_p99_fraction: 99th percentile of |torque| / limit over joints and time.
        solver_failures: control steps on which every solver failed.
    """

    duration: float
    revolutions: float
    angular_velocity_mean: float
    speed_mean: float
    heading_error_end: float
    lateral_drift: float
    longest_stall: float
    stalled_at: float
    airborne: float
    torque_p99_fraction: float
    solver_failures: int


def measure(
    log: Arrays, criteria: RollingCriteria, commanded: float, period: float
) -> RollingMetrics:
    """Measure a roll.

    Args:
        log: arrays by schema path, a `RunLog` or a buffer's; may have no rows.
        commanded: in-plane angular velocity [rev/s]; its sign is the direction of progress.
        period: of the control [s].
    """
    com = np.asarray(log["trajectory/com"], dtype=float)
    steps = len(com)
    if steps == 0:
        nan = math.nan
        return RollingMetrics(0.0, 0.0, nan, nan, nan, 0.0, 0.0, 0.0, nan, nan, 0)
    angle = np.asarray(log["trajectory/angular_excursion"], dtype=float)[:, 1] / (2 * math.pi)
    direction = -1.0 if commanded < 0 else 1.0
    first = min(round(criteria.settle / period), steps - 1)
    # A run that ends before it settled has no mean speeds.
    elapsed = (steps - 1 - first) * period or math.nan
    axis = np.asarray(log["trajectory/trunk_axis"], dtype=float)[-round(1.0 / period) :]
    heading = np.degrees([math.atan2(-x, y) for x, y, _ in axis.tolist()])
    stall, stalled_at = longest_stall(direction * angle, criteria.stall_progress, period)
    fraction = np.abs(log["trajectory/ctrl"]) / log["model/torque_limit"]
    return RollingMetrics(
        duration=steps * period,
        revolutions=float(direction * (angle[-1] - angle[0])),
        angular_velocity_mean=float((angle[-1] - angle[first]) / elapsed),
        speed_mean=float((com[-1, 0] - com[first, 0]) / elapsed),
        heading_error_end=_median_angle(heading),
        lateral_drift=float(np.abs(com[:, 1] - com[0, 1]).max()),
        longest_stall=stall,
        stalled_at=stalled_at,
        airborne=float(np.mean(np.asarray(log["contacts/count"]) == 0)),
        torque_p99_fraction=float(np.percentile(fraction, 99)),
        solver_failures=int(np.count_nonzero(np.asarray(log["solver/status"]) == 2)),
    )


def _median_angle(degrees: NDArray[np.float64]) -> float:
    """Median about the mean direction, in (-180, 180]: +179 and -179 do not make 0."""
    turn = np.radians(degrees)
    centre = math.degrees(math.atan2(np.sin(turn).sum(), np.cos(turn).sum()))
    median = centre + np.median((degrees - centre + 180.0) % 360.0 - 180.0)
    return float(180.0 - (180.0 - median) % 360.0)


def longest_stall(
    progress: NDArray[np.float64], least: float, period: float
) -> tuple[float, float]:
    """Longest time [s] in which `progress` (n,) grew by less than `least`, and its start [s].

    A stall begins when progress last exceeded its previous mark by `least`, and lasts until
    it does so again, or the run ends.
    """
    mark, since = progress[0], 0
    longest, begin = 0, 0
    for i, value in enumerate(progress):
        if value >= mark + least:
            mark, since = value, i
        if i - since > longest:
            longest, begin = i - since, since
    return longest * period, begin * period


def failure_reason(metrics: RollingMetrics, criteria: RollingCriteria, wanted: float) -> str:
    """Why the run is no success; empty if it is one. `wanted` is the duration [s]."""
    if metrics.duration < wanted - 1e-6:
        return f"ended after {metrics.duration:.2f} of {wanted:g} s"
    if metrics.solver_failures:
        return f"every solver failed on {metrics.solver_failures} control steps"
    if metrics.longest_stall >= criteria.stall_time:
        return f"stalled for {metrics.longest_stall:.2f} s from t = {metrics.stalled_at:.2f} s"
    if not abs(metrics.heading_error_end) < criteria.heading:
        return f"heading off by {metrics.heading_error_end:.0f} deg at the end"
    if not metrics.lateral_drift < criteria.lateral_drift:
        return f"drifted {metrics.lateral_drift:.2f} m sideways"
    return ""
