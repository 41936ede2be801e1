"""The support polygon of the parts that stand, and the capture point over it."""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from math import fsum, inf, sqrt
from typing import Literal

import mujoco
import numpy as np

from rotctl.errors import InputError
from rotctl.mechanics.hulls import hulls, places
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State

Point = tuple[float, float]
Facing = Literal["front", "left"]
CLEAR = 0.03  # [m] above the ground
LEAST_HEIGHT = 0.1  # [m] of a centre of mass over its feet, for the pendulum that it is


@lru_cache(maxsize=64)
def _solid(mj: mujoco.MjModel, body: int) -> tuple[tuple[int, float, float], ...]:
    """A body's solid capsules and spheres: number, half length and radius [m]."""
    capsule = mj.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE
    solid = (mj.geom_bodyid == body) & (mj.geom_contype > 0)
    found = np.flatnonzero(solid & (mj.geom_type != mujoco.mjtGeom.mjGEOM_MESH)).tolist()
    return tuple(
        (geom, float(mj.geom_size[geom, 1] * capsule[geom]), float(mj.geom_size[geom, 0]))
        for geom in found
    )


def _corners(mj: mujoco.MjModel, data: mujoco.MjData, body: int) -> Iterator[list[float]]:
    """Where the corners of a body's hulls are [m]."""
    for geom in hulls(mj):
        if mj.geom_bodyid[geom] == body:
            yield from places(mj, data, geom).tolist()


def ends(model: Model, data: mujoco.MjData, bodies: Iterable[int]) -> list[Point]:
    """The ends of the solid capsules of these bodies and the corners of hulls, from above [m].

    Raises:
        InputError: there are none.
    """
    found, mj, centres, frames = [], model.mj, data.geom_xpos, data.geom_xmat
    for body in bodies:
        for geom, half, _ in _solid(mj, body):
            x, y, _ = centres[geom].tolist()
            across = frames[geom].tolist()
            dx, dy = half * across[2], half * across[5]
            found += [(x + dx, y + dy), (x - dx, y - dy)]
        found += [(x, y) for x, y, _ in _corners(mj, data, body)]
    if not found:
        raise InputError("behaviour: a task is to balance over bodies that cannot stand")
    return found


def lowest_end(model: Model, data: mujoco.MjData, body: int) -> tuple[float, float, float]:
    """Of the ends of a body's solid capsules and spheres, and the corners of hulls, the lowest [m].

    Raises:
        InputError: there are none.
    """
    low, found = inf, None
    for geom, half, radius in _solid(model.mj, body):
        x, y, z = data.geom_xpos[geom].tolist()
        across = data.geom_xmat[geom].tolist()
        for along in (half, -half):
            height = z + along * across[8] - radius
            if height < low:
                low = height
                found = (x + along * across[2], y + along * across[5], height)
    for x, y, height in _corners(model.mj, data, body):
        if height < low:
            low, found = height, (x, y, height)
    if found is None:
        raise InputError(f"behaviour: {model.mj.body(body).name} cannot bear the body")
    return found


def lifted(model: Model, state: State, body: int) -> bool:
    """Whether nothing of a body touches the ground, and all of it is higher than `CLEAR`."""
    if body in state.contacts.body.tolist():
        return False
    for geom, half, radius in _solid(model.mj, body):
        x, y, z = state.data.geom_xpos[geom].tolist()
        low = z - half * abs(float(state.data.geom_xmat[geom, 8])) - radius
        if low - model.ground.height(x, y) < CLEAR:
            return False
    corners = _corners(model.mj, state.data, body)
    return all(z - model.ground.height(x, y) >= CLEAR for x, y, z in corners)


def hull(points: list[Point]) -> list[Point]:
    """Corners of the convex hull, counter-clockwise."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered

    def half(given: list[Point]) -> list[Point]:
        chain: list[Point] = []
        for p in given:
            x, y = p
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if not (bx - ax) * (y - ay) - (by - ay) * (x - ax) <= 0.0:  # it turns left
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


def middle(corners: list[Point]) -> Point:
    """Mean of the corners."""
    n, (xs, ys) = len(corners), zip(*corners, strict=True)
    return fsum(xs) / n, fsum(ys) / n


def within(corners: list[Point], centre: Point, wish: Point, margin: float) -> Point:
    """`wish`, drawn towards `centre` until it is `margin` [m] inside every edge of the hull."""
    cx, cy = centre
    if len(corners) < 2:  # a ball
        return centre
    dx, dy = wish[0] - cx, wish[1] - cy
    share = 1.0
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        ex, ey = bx - ax, by - ay
        length = sqrt(ex * ex + ey * ey)
        nx, ny = ey / length, -ex / length  # outwards
        room = nx * (ax - cx) + ny * (ay - cy) - margin
        out = nx * dx + ny * dy
        if out > room:
            share = min(share, max(room, 0.0) / out)
    return cx + share * dx, cy + share * dy


def outside(corners: list[Point], point: Point) -> float:
    """How far a point lies beyond the hull's nearest edge's line [m]; negative inside."""
    x, y = point
    far = -inf
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        ex, ey = bx - ax, by - ay
        far = max(far, (ey * (x - ax) - ex * (y - ay)) / sqrt(ex * ex + ey * ey))
    return far


def forward(state: State, body: int) -> Point:
    """Where a body's front points, seen from above, unit."""
    x, y = state.data.xmat[body].reshape(3, 3)[:2, 0].tolist()
    length = sqrt(x * x + y * y) or 1.0
    return x / length, y / length


def forward_of_left(state: State, body: int) -> Point:
    """Across where a body's left points, seen from above, unit: its front, also past a bow."""
    x, y = state.data.xmat[body].reshape(3, 3)[:2, 1].tolist()
    length = sqrt(x * x + y * y) or 1.0
    return y / length, -x / length


FACING = {"front": forward, "left": forward_of_left}


def turned(x: float, y: float, forward: Point, sense: float) -> Point:
    """A level vector turned as +x is to `forward` (sense 1), or back (-1)."""
    cosine, sine = forward[0], sense * forward[1]
    return x * cosine - y * sine, x * sine + y * cosine


def pendulum_rate(model: Model, state: State) -> float:
    """Omega of the inverted pendulum [1/s]: the capture point is c + v / omega."""
    x, y, z = state.momentum.com.tolist()
    return rate_at(model, z - model.ground.height(x, y))


def rate_at(model: Model, height: float) -> float:
    """Omega of an inverted pendulum of some height [m], which is at least `LEAST_HEIGHT` [1/s]."""
    return sqrt(-float(model.gravity[2]) / max(height, LEAST_HEIGHT))


def capture_point(state: State, rate: float) -> Point:
    """Where the body would come to stand, seen from above [m]; `rate` is `pendulum_rate`."""
    c, v = state.momentum.com, state.momentum.com_velocity
    return float(c[0] + v[0] / rate), float(c[1] + v[1] / rate)
