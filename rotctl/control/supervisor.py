"""Ground contact supervisor, [Brown2013] section 5: which contacts may the controller use?

A first pass of the optimisation uses every contact; an inclusion test then looks at what
each contact would do, and the second pass uses the contacts that pass. The simulation
always keeps all of them. The paper settled on `as_written` and names the others that it tried.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, pi, tau
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.qp import make_solver, without_rows
from rotctl.settings.fields import STRICT, Fraction, NonNegative

SupervisorName = Literal[
    "as_written", "modified", "minimal", "convex_hull", "simulated", "simulated_free", "none"
]
Mask = NDArray[np.bool_]
LEAST = 1e-3  # [N, N m] of a threshold by which a lack is measured
UNIQUE = 1e-6  # on forces squared, in units of the thresholds: where several sets of them do


@validated(frozen=True, config=STRICT)
class Thresholds:
    """What a contact must show to be used: force [N], torque [N m], separation speed [m/s].

    `hull` is the share of force and torque that is enough on the convex hull of all contacts.
    """

    force: NonNegative
    torque: NonNegative
    separation: NonNegative
    hull: Fraction


@dataclass(frozen=True)
class Evidence:
    """What the first pass says of the m contacts.

    Attributes:
        push: (m, 6) each one's force and its torque about the centre of mass, world [N, N m].
        separation: (m,) current speed out of the ground [m/s].
        place: (m, 2) seen from above [m].
        edges: (m, 4, 6) force and torque of each edge of their friction pyramids, for one
            newton along the normal.
        realised: what each does in the physics step with the torques of the first pass (m, 6).
    """

    push: Array
    separation: Array
    place: Array
    edges: Array
    realised: Callable[[], Array]


def as_written(evidence: Evidence, limits: Thresholds) -> Mask:
    """Keep a contact whose force or whose torque about the centre of mass is large enough."""
    return _strong(evidence.push, limits)


def modified(evidence: Evidence, limits: Thresholds) -> Mask:
    """As written, and keep every contact that is not already leaving the ground."""
    return as_written(evidence, limits) | (evidence.separation < limits.separation)


def minimal(evidence: Evidence, limits: Thresholds) -> Mask:
    """Keep as few as can still give the whole force and torque, to within the thresholds.

    From the weakest on, a contact goes if the others can do without it.
    """
    keep = np.ones(len(evidence.push), dtype=bool)
    wanted = evidence.push.sum(axis=0)
    for weakest in np.argsort(_norm(evidence.push[:, :3]), kind="stable"):
        keep[weakest] = False
        if _lack(evidence.edges[keep].reshape(-1, 6), wanted, limits) > 1.0:
            keep[weakest] = True
    return keep


def convex_hull(evidence: Evidence, limits: Thresholds) -> Mask:
    """As written, but less is enough on the convex hull of all contacts, seen from above."""
    share = np.where(
        [_is_corner(i, evidence.place) for i in range(len(evidence.place))], limits.hull, 1.0
    )
    return _strong(evidence.push, limits, share)


def simulated(evidence: Evidence, limits: Thresholds) -> Mask:
    """As written, by the forces that the physics answers the first pass with; then it is undone."""
    return _strong(evidence.realised(), limits)


RULES: dict[str, Callable[[Evidence, Thresholds], Mask]] = {
    "as_written": as_written,
    "modified": modified,
    "minimal": minimal,
    "convex_hull": convex_hull,
    "simulated": simulated,
    "simulated_free": simulated,
}
FREE = ("simulated_free",)  # whose first pass has no objectives over momenta


def _strong(push: Array, limits: Thresholds, share: Array | float = 1.0) -> Mask:
    force, torque = _norm(push[:, :3]), _norm(push[:, 3:])
    return (force > share * limits.force) | (torque > share * limits.torque)


def _norm(vectors: Array) -> Array:
    return np.sqrt((vectors**2).sum(axis=1))


def _lack(edges: Array, wanted: Array, limits: Thresholds) -> float:
    """How far forces along `edges` (k, 6) must miss what is wanted (6,), in thresholds."""
    unit = 1.0 / np.maximum(np.repeat((limits.force, limits.torque), 3), LEAST)
    missing = wanted * unit
    if len(edges):
        ways = edges * unit
        H = product(ways, ways.T) + UNIQUE * np.eye(len(ways))
        zero, most = np.zeros(len(ways)), np.full(len(ways), np.inf)
        problem = without_rows(H, -product(ways, missing), zero, most)
        missing = missing - product(make_solver("boxqp").solve(problem, None).x, ways)
    return float(max(_norm(missing.reshape(2, 3))))


def _is_corner(point: int, places: Array) -> bool:
    """Whether all others lie within half a turn as seen from a point: it is not inside them."""
    away = places - places[point]
    away = away[_norm(away) > 0.0]
    if len(away) < 2:
        return True
    angles = np.sort([atan2(y, x) for x, y, *_ in away.tolist()])
    gaps = np.diff(angles, append=angles[0] + tau)
    return bool(gaps.max() >= pi - 1e-9)
