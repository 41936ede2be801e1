"""What plots show: signals out of a log, with their commands where the log knows them."""

import math
from dataclasses import dataclass

import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import along_frame, in_frame
from rotctl.metrics.criteria.finish import begins
from rotctl.report.moments import STEADY
from rotctl.report.title import plain

TURN = 2.0 * math.pi  # [rad]


@dataclass(frozen=True)
class Signals:
    """Signals of one run, one row a control step, along the behaviour's forward, left and up.

    Attributes:
        time: (n,) [s].
        spin: (n, 3) whole-body angular velocity [rev/s]; in-plane is about left.
        turns: (n, 3) angular excursion; in-plane since the start of the run [rev].
        velocity: (n, 3) of the centre of mass [m/s].
        blend: (n,).
        blends: whether it ever changes in the run; of who has no two poses it stands still.
        height: (n,) of the centre of mass above the ground [m]; NaN where the log does not tell.
        force: (n,) magnitude of the ground's force, mean over a control step [N].
        force_peak: (n,) its largest in a physics step [N]; NaN where the log does not tell.
        count: (n,) contacts with the ground.
        used: (n,) of these, kept by the supervisor.
        commanded_spin: in-plane [rev/s]; NaN where the outcome does not tell.
        commanded_speed: forward [m/s]; likewise.
        commanded_until: when that ended, as a roll did that was told to end [s]; else infinite.
    """

    time: Array
    spin: Array
    turns: Array
    velocity: Array
    blend: Array
    blends: bool
    height: Array
    force: Array
    force_peak: Array
    count: Array
    used: Array
    commanded_spin: float
    commanded_speed: float
    commanded_until: float

    @property
    def commanded_time(self) -> Array:
        """First and last time of what is commanded [s]; empty where nothing is."""
        ends: Array = np.minimum(self.time[[0, -1]], self.commanded_until)
        return ends if ends[0] < self.commanded_until else ends[:0]


@dataclass(frozen=True)
class Rates:
    """Rates of the momenta, each (n, 3), rows as in `Signals`."""

    desired: Array
    predicted: Array
    realised: Array


def signals(log: RunLog, rows: slice) -> Signals:
    """The signals of some rows."""
    turns = in_frame(log, "trajectory/angular_excursion") / TURN
    turns[:, 1] -= turns[:1, 1]
    filled = log["contacts/body"][rows] >= 0
    outcome = log.outcome
    time = log["trajectory/time"][rows]
    unknown = np.full(len(time), math.nan)
    newer = "contacts/ground_force" in log
    height = log["trajectory/com"][:, 2] - log["trajectory/ground_height"] if newer else None
    return Signals(
        time=time,
        spin=in_frame(log, "trajectory/angular_velocity")[rows] / TURN,
        turns=turns[rows],
        velocity=in_frame(log, "trajectory/com_velocity")[rows],
        blend=log["trajectory/blend"][rows],
        blends=bool(np.ptp(log["trajectory/blend"]) >= STEADY),
        height=unknown if height is None else height[rows],
        force=np.linalg.norm(_ground_force(log, rows), axis=1),
        force_peak=log["contacts/ground_force_peak"][rows] if newer else unknown,
        count=log["contacts/count"][rows].astype(float),
        used=(log["contacts/used"][rows] & filled).sum(axis=1).astype(float),
        commanded_spin=_number(outcome.get("angular_velocity_commanded")),
        commanded_speed=_number(outcome.get("speed_commanded")),
        commanded_until=_rolls_until(log),
    )


def _rolls_until(log: RunLog) -> float:
    """When a roll was told to end, or one that counts its turns began to stand up [s]."""
    if "command/stage" not in log:
        return math.inf
    row, time = begins(log), log["trajectory/time"]
    stands = float(time[row]) if row < len(time) else math.inf
    told = _number(log.outcome.get("finish_commanded"))
    return stands if math.isnan(told) or "revolutions_told" in log.outcome else min(told, stands)


def linear_rates(log: RunLog, rows: slice, weight: Array) -> Rates:
    """Rates of the linear momentum [N].

    Args:
        rows: which.
        weight: (3,) of the character, m g [N].
    """
    return Rates(
        desired=in_frame(log, "trajectory/linear_momentum_rate_desired")[rows],
        predicted=in_frame(log, "trajectory/linear_momentum_rate_predicted")[rows],
        realised=along_frame(log, _ground_force(log, rows) + weight, rows),
    )


def angular_rates(log: RunLog, rows: slice) -> Rates:
    """Rates of the angular momentum about the centre of mass [N m]."""
    arms = log["contacts/position"][rows].astype(float) - log["trajectory/com"][rows, None]
    return Rates(
        desired=in_frame(log, "trajectory/angular_momentum_rate_desired")[rows],
        predicted=in_frame(log, "trajectory/angular_momentum_rate_predicted")[rows],
        realised=along_frame(log, np.cross(arms, _forces(log, rows)).sum(axis=1), rows),
    )


def torque_fractions(log: RunLog, rows: slice) -> dict[str, Array]:
    """Largest |torque| / limit (n,) in each group of joints; left and right together."""
    names = [plain(name.decode("utf-8", "replace")) for name in log["model/joint"].tolist()]
    with np.errstate(divide="ignore", invalid="ignore"):
        fraction = np.abs(log["trajectory/ctrl"][rows]) / log["model/torque_limit"]
    groups: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        groups.setdefault(joint_group(name), []).append(i)
    return {group: fraction[:, members].max(axis=1) for group, members in groups.items()}


def joint_group(name: str) -> str:
    """``hip_y_l`` and ``hip_x_r`` are both ``hip``."""
    for side in ("_l", "_r"):
        name = name.removesuffix(side)
    for axis in ("_x", "_y", "_z"):
        name = name.removesuffix(axis)
    return name


def _ground_force(log: RunLog, rows: slice) -> Array:
    """Sum of the ground's forces (n, 3) [N]; logs of schema 2 know those with a slot alone."""
    if "contacts/ground_force" in log:
        return np.asarray(log["contacts/ground_force"][rows])
    return np.asarray(_forces(log, rows).sum(axis=1))


def _forces(log: RunLog, rows: slice) -> Array:
    """Realised contact forces (n, capacity, 3) [N]; zero in empty slots."""
    filled = log["contacts/body"][rows] >= 0
    forces: Array = np.where(filled[..., None], log["contacts/force_realised"][rows], 0.0)
    return forces.astype(float)


def _number(value: object) -> float:
    fits = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e9
    return float(value) if fits and isinstance(value, int | float) else math.nan
