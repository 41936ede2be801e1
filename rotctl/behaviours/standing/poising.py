"""Balance on hands, which are balls: no pressure under them can move forward or back.

About the line through the hands a body has the angular momentum L = H + m z v, with z and v the
centre of mass's height and speed. Gravity alone changes it, by m g d a second, where d is how far
the centre of mass is ahead of the line. With Y the way that L has still to undo, the integral of
L from the pose that is wanted, upright over the hands, to the body as it is,

    Y' = L,    L' = m g d,    d' = v,    v' = a,

and an acceleration a of the centre of mass brings all four to rest at a rate p:

    m g a = -4 p m g v - 6 p^2 m g d - 4 p^3 (L - L_pose) - p^4 Y.

L_pose is what the pose itself has where it moves. Without Y a body whose centre of mass is a
centimetre from where it is taken to be would go on folding.
"""

from math import fsum, sqrt
from typing import Literal, NamedTuple

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.aerial.pendulum import pendulum_rate
from rotctl.behaviours.named_bodies import NamesBodies
from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, Triple, cross, dot
from rotctl.mechanics.bodies import body_ids
from rotctl.settings.fields import STRICT, Finite, NonNegative, Positive, SomeNames

NARROW = 0.05  # [m] hands that are closer make no line


@validated(frozen=True, config=STRICT)
class Poise(NamesBodies):
    """Keep the balance on hands while the body takes the stage's pose: linear.

    Attributes:
        bodies: that bear it.
        rate: p, at which it comes to rest along the way [1/s].
        gain: across the way, of the pressure beyond the capture point [-].
        margin: inside the hands that the pressure keeps there [m].
    """

    law: Literal["poise"]
    bodies: SomeNames
    rate: Positive
    gain: NonNegative
    margin: NonNegative

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration."""
        model, momentum, p = scene.model, scene.state.momentum, self.rate
        hands = _hands(scene, self.bodies)
        off = dot(momentum.com - hands.middle, hands.ahead)
        speed = dot(momentum.com_velocity, hands.ahead)
        lever = model.mass * (float(momentum.com[2]) - scene.floor)
        about = dot(momentum.angular, hands.left) + lever * speed
        missing = scene.pose - scene.state.position[model.angles]
        undone = lever * off - _over(scene, hands, missing, off)
        own = _over(scene, hands, scene.speed, 0.0)
        weight = model.mass * -float(model.gravity[2])
        along = -4.0 * p * speed - 6.0 * p * p * off
        along -= (4.0 * p**3 * (about - own) + p**4 * undone) / weight
        task["acceleration"] = along * hands.ahead + self._across(scene, hands) * hands.left

    def _across(self, scene: Scene, hands: "_Hands") -> float:
        """Acceleration to the left that keeps the capture point between the hands [m/s2]."""
        momentum, rate = scene.state.momentum, pendulum_rate(scene)
        off = dot(momentum.com - hands.middle, hands.left)
        out = (1.0 + self.gain) * (off + dot(momentum.com_velocity, hands.left) / rate)
        room = max(hands.half - self.margin, 0.0)
        return rate * rate * (off - min(max(out, -room), room))


@validated(frozen=True, config=STRICT)
class Shift(NamesBodies):
    """Bring the centre of mass over some of the bodies that bear it: linear.

    Attributes:
        bodies: over the middle of which it comes to rest.
        rate: at which it does so [1/s].
        most: of the way, that it is given at once [m].
        ahead: of their middle [m].
    """

    law: Literal["shift"]
    bodies: SomeNames
    rate: Positive
    most: Positive
    ahead: Finite = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration."""
        momentum, (hx, hy) = scene.state.momentum, borne_at(scene, self.bodies)
        place, wanted = np.array((hx, hy, 0.0)), np.zeros(3)
        for way, beyond in zip(scene.axes[:2], (self.ahead, 0.0), strict=True):
            off = dot(momentum.com - place, way) - beyond
            off = min(max(off, -self.most), self.most)
            speed = dot(momentum.com_velocity, way)
            wanted -= self.rate * (2.0 * speed + self.rate * off) * way
        task["acceleration"] = wanted


def borne_at(scene: Scene, bodies: tuple[str, ...]) -> support.Point:
    """Middle of these bodies, each where it touches the ground, or would, seen from above [m]."""
    found = body_ids(scene.model.mj, bodies)
    return support.middle([_end(scene, body)[:2] for body in found])


class _Hands(NamedTuple):
    """What bears the body: a line.

    Attributes:
        ends: of each hand's body where it touches the ground [m].
        middle: (3,) of the hands, on z = 0 [m].
        left, ahead: (3,) along the line and across it, level, unit.
        half: half their distance [m].
    """

    ends: list[tuple[int, Array]]
    middle: Array
    left: Array
    ahead: Array
    half: float


def _hands(scene: Scene, bodies: tuple[str, ...]) -> _Hands:
    """Where two hands are so close that they are no line, it lies along the behaviour's left."""
    found = body_ids(scene.model.mj, bodies)
    ends = [(body, np.array(_end(scene, body))) for body in found]
    (lx, ly, _), (rx, ry, _) = ends[0][1].tolist(), ends[-1][1].tolist()
    dx, dy = lx - rx, ly - ry
    wide = sqrt(dx * dx + dy * dy)
    middle = np.array((0.5 * (lx + rx), 0.5 * (ly + ry), 0.0))
    if wide < NARROW:
        return _Hands(ends, middle, scene.axes[1], scene.axes[0], 0.5 * wide)
    left = np.array((dx / wide, dy / wide, 0.0))
    return _Hands(ends, middle, left, np.array((dy / wide, -dx / wide, 0.0)), 0.5 * wide)


def _end(scene: Scene, body: int) -> Triple:
    """Where a body touches the ground; its lowest end where it does not [m]."""
    contacts = scene.state.contacts
    touching = zip(contacts.body.tolist(), contacts.position.tolist(), strict=True)
    found = [place for of, place in touching if of == body]
    if found:
        x, y, z = (fsum(along) / len(found) for along in zip(*found, strict=True))
        return x, y, z
    return support.lowest_end(scene.model, scene.state.data, body)


def _over(scene: Scene, hands: _Hands, joints: Array, off: float) -> float:
    """Angular momentum about the hands' line of joints' speeds (nu,), balanced [kg m2/s].

    The body turns about the hands so that its centre of mass goes back by `off` meanwhile. What is
    linear in speeds is so in ways, too: with angles [rad] and an `off` [m] it is an integral.
    """
    speeds = np.zeros(scene.model.mj.nv)
    speeds[scene.model.joints] = joints
    bent = _motion(scene, hands, speeds)
    turn = np.zeros(scene.model.mj.nv)
    turn[3:6] = product(scene.state.momentum.root_rotation.T, hands.left)
    turned = _motion(scene, hands, turn)
    return bent.spin - (off + bent.way) / turned.way * turned.spin


class _Motion(NamedTuple):
    """Of a motion: angular momentum about the line, and the centre of mass's way off it."""

    spin: float
    way: float


def _motion(scene: Scene, hands: _Hands, velocity: Array) -> _Motion:
    """Of generalised speeds (nv,)."""
    model, data, momentum = scene.model, scene.state.data, scene.state.momentum
    generalised = np.empty(model.mj.nv)
    mujoco.mj_mulM(model.mj, data, generalised, velocity)
    linear = generalised[:3]
    about = product(momentum.root_rotation, generalised[3:6]) - cross(momentum.root_offset, linear)
    moved, jacobian = np.zeros(3), np.zeros((3, model.mj.nv))
    for body, place in hands.ends:
        mujoco.mj_jac(model.mj, data, jacobian, None, place, body)
        moved += product(jacobian, velocity) / len(hands.ends)
    return _Motion(dot(about, hands.left), dot(linear / model.mass - moved, hands.ahead))
