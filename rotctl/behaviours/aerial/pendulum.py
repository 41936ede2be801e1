"""The body as a pendulum on what it stands on: what pressure within its feet does to it."""

from typing import NamedTuple

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene
from rotctl.maths.rotations import Array, dot
from rotctl.mechanics.bodies import body_ids


class Base(NamedTuple):
    """What it stands on at one instant.

    Attributes:
        corners, middle: of the bodies that stand, seen from above [m].
        rate: of the pendulum on them [1/s], see `pendulum_rate`.
    """

    corners: list[support.Point]
    middle: support.Point
    rate: float


def standing(scene: Scene, bodies: tuple[str, ...]) -> Base:
    """What it stands on, where these bodies do."""
    ends = _ends(scene, bodies)
    return Base(support.hull(ends), support.middle(ends), pendulum_rate(scene))


def _ends(scene: Scene, bodies: tuple[str, ...]) -> list[support.Point]:
    found = body_ids(scene.model.mj, bodies)
    return support.ends(scene.model, scene.state.data, found)


def leaning(scene: Scene, bodies: tuple[str, ...]) -> tuple[float, float]:
    """How far the centre of mass is ahead of the middle of the feet, and over the ground [m]."""
    mx, my = support.middle(_ends(scene, bodies))
    x, y, z = scene.state.momentum.com.tolist()
    fx, fy, _ = scene.axes[0].tolist()
    return fx * (x - mx) + fy * (y - my), z - scene.floor


def captured(
    scene: Scene, base: Base, way: Array, gain: float, margin: float, over: float = 0.0
) -> float:
    """Acceleration along a level way (3,) that keeps the capture point over the feet [m/s2].

    Args:
        over: so far along the way from the middle of the feet [m].
    """
    (mx, my), rate = base.middle, base.rate
    com, velocity = scene.state.momentum.com, scene.state.momentum.com_velocity
    wx, wy, _ = way.tolist()
    off = wx * (float(com[0]) - mx) + wy * (float(com[1]) - my)
    out = off + dot(velocity, way) / rate
    wanted = rate * rate * (off - (1.0 + gain) * out + gain * over)
    return pushed(scene, base, way, wanted, margin)


def pushed(scene: Scene, base: Base, way: Array, wanted: float, margin: float) -> float:
    """What of an acceleration along a level way (3,) the feet can give [m/s2].

    The ways are looked at one by one: pressure at the toes still balances from side to side.
    """
    corners, (mx, my), rate = base
    com, (wx, wy, _) = scene.state.momentum.com, way.tolist()
    off = wx * (float(com[0]) - mx) + wy * (float(com[1]) - my)
    out = off - wanted / (rate * rate)
    px, py = support.within(corners, (mx, my), (mx + out * wx, my + out * wy), margin)
    return rate * rate * (off - wx * (px - mx) - wy * (py - my))


def pendulum_rate(scene: Scene) -> float:
    """Omega of the pendulum that stands on the floor [1/s], beside which there may be an abyss."""
    return support.rate_at(scene.model, float(scene.state.momentum.com[2]) - scene.floor)
