"""The support polygon of the parts that stand, and the capture point over it."""

from math import fsum, sqrt

import mujoco
import numpy as np

from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.rotations import Array

Point = tuple[float, float]
LEAST_HEIGHT = 0.1  # [m] of a centre of mass over its feet, for the pendulum that it is


def ends(model: Model, state: State, bodies: list[int]) -> list[Point]:
    """The ends of the solid capsules of these bodies, seen from above [m]."""
    mj, data, found = model.mj, state.data, []
    solid = np.isin(mj.geom_bodyid, bodies) & (mj.geom_contype > 0)
    for geom in np.flatnonzero(solid).tolist():
        half = mj.geom_size[geom, 1] * (mj.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE)
        x, y = data.geom_xpos[geom, :2].tolist()
        dx, dy = (half * data.geom_xmat[geom].reshape(3, 3)[:2, 2]).tolist()
        found += [(x + dx, y + dy), (x - dx, y - dy)]
    return found


def hull(points: list[Point]) -> list[Point]:
    """Corners of the convex hull, counter-clockwise."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered

    def half(given: list[Point]) -> list[Point]:
        chain: list[Point] = []
        for p in given:
            while len(chain) > 1 and _left_of(chain[-2], chain[-1], p) <= 0.0:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


def shrunk(corners: list[Point], margin: float) -> list[Point]:
    """The corners moved towards their mean by `margin` [m], at most all the way."""
    x, y = middle(corners)
    moved = []
    for a, b in corners:
        length = sqrt((a - x) ** 2 + (b - y) ** 2)
        left = max(length - margin, 0.0) / length if length > 0.0 else 0.0
        moved.append((x + left * (a - x), y + left * (b - y)))
    return moved


def middle(corners: list[Point]) -> Point:
    """Mean of the corners."""
    n = len(corners)
    return fsum(p[0] for p in corners) / n, fsum(p[1] for p in corners) / n


def nearest(point: Point, corners: list[Point]) -> Point:
    """The point of a convex polygon, corners counter-clockwise, that is nearest to `point`."""
    n = len(corners)
    sides = [(corners[i], corners[(i + 1) % n]) for i in range(n)]
    if n > 2 and all(_left_of(a, b, point) >= 0.0 for a, b in sides):
        return point
    candidates = [_on_segment(point, a, b) for a, b in sides]
    return min(candidates, key=lambda p: (p[0] - point[0]) ** 2 + (p[1] - point[1]) ** 2)


def pendulum_rate(model: Model, state: State) -> float:
    """Omega of the inverted pendulum [1/s]: the capture point is c + v / omega."""
    x, y, z = state.momentum.com.tolist()
    height = max(z - model.ground.height(x, y), LEAST_HEIGHT)
    return sqrt(-float(model.gravity[2]) / height)


def capture_point(state: State, rate: float) -> Point:
    """Where the body would come to stand, seen from above [m]; `rate` is `pendulum_rate`."""
    c, v = state.momentum.com, state.momentum.com_velocity
    return float(c[0] + v[0] / rate), float(c[1] + v[1] / rate)


def centre_of_pressure(state: State, rate: float, pressed: Point) -> Array:
    """Level acceleration (3,) of the centre of mass over a pressed point [m/s2]."""
    c = state.momentum.com
    return rate**2 * np.array([c[0] - pressed[0], c[1] - pressed[1], 0.0])


def _left_of(a: Point, b: Point, p: Point) -> float:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def _on_segment(p: Point, a: Point, b: Point) -> Point:
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared if squared > 0.0 else 0.0
    share = min(max(along, 0.0), 1.0)
    return a[0] + share * dx, a[1] + share * dy
