"""Forces on the character from outside: pushes and wind, drawn from the run's seed.

They act on bodies through MuJoCo's `xfrc_applied` and are told in the log. Control knows of them
only where `controller.sees_disturbance` says so.
"""

from dataclasses import dataclass
from math import cos, nan, pi, radians, sin, sqrt, tau
from typing import Annotated, Literal, Protocol

import mujoco
import numpy as np
from pydantic import AfterValidator, Field
from pydantic.dataclasses import dataclass as validated

from rotctl.linear import product
from rotctl.mechanics.model import ROOT_BODY, Model, body_id, is_character
from rotctl.rotations import Array, cross, dot
from rotctl.settings import STRICT, Drawn, NonNegative, Positive, ends

DISTURBANCE_STREAM = 2  # beside the start's, which is drawn from the seed alone, and the terrain's


SHORTEST = 1e-3  # [s] of a push: time counts to 1e-15 of itself


def _from_the_start(time: float | tuple[float, float]) -> float | tuple[float, float]:
    if ends(time)[0] < 0.0:
        raise ValueError("must not begin before the run does, at 0 s")
    return time


class Disturbance(Protocol):
    """What disturbs one run."""

    def apply(self, data: mujoco.MjData, period: float, phase: float) -> Array:
        """Set the forces of the control step that begins, which stay for its `period` [s].

        Args:
            phase: of the behaviour, a control step ago [rad]; NaN at the first.

        Returns:
            Their sum and their moment about the centre of mass (6,) [N, N m].
        """
        ...


@validated(frozen=True, config=STRICT)
class Calm:
    """Nothing disturbs."""

    name: str
    kind: Literal["none"]
    description: str = ""

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Nothing":
        """For one run."""
        return Nothing()


@validated(frozen=True, config=STRICT)
class Push:
    """One push, level.

    Attributes:
        body: that is pushed, at its centre of mass.
        impulse: [N s]; duration: it is spread over [s].
        direction: from forward towards left [deg]; as time and phase a range to draw from, or
            a number.
        time: when it begins [s].
        phase: of the behaviour [deg] that it waits for from then on; null does not wait.
    """

    name: str
    kind: Literal["push"]
    body: str
    impulse: NonNegative
    duration: Annotated[Positive, Field(ge=SHORTEST)]
    direction: Drawn
    time: Annotated[Drawn, AfterValidator(_from_the_start)]
    phase: Drawn | None = None
    description: str = ""

    def make(
        self, model: Model, axes: Array, generator: np.random.Generator
    ) -> "OnePush | PushAtPhase":
        """For one run whose forward, left and up are the rows of `axes`.

        Raises:
            InputError: there is no such body.
        """
        angle = radians(generator.uniform(*ends(self.direction)))
        way = product(np.array([cos(angle), sin(angle), 0.0]), axes)
        begin = float(generator.uniform(*ends(self.time)))
        body = body_id(model.mj, self.body, "disturbance.body")
        push = OnePush(body, self.impulse / self.duration * way, begin, begin + self.duration)
        if self.phase is None:
            return push
        return PushAtPhase(push, radians(generator.uniform(*ends(self.phase))))


@validated(frozen=True, config=STRICT)
class Wind:
    """Steady wind, and the air's drag on all that moves in it.

    Attributes:
        speed: [m/s]; 0 is still air.
        direction: where it blows to, from forward towards left [deg]; a range to draw from, or
            a number.
        density: of the air [kg/m3].
        drag: coefficient of a capsule [-].
    """

    name: str
    kind: Literal["wind"]
    speed: NonNegative
    direction: Drawn
    density: Positive
    drag: Positive
    description: str = ""

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Air":
        """For one run whose forward, left and up are the rows of `axes`."""
        angle = radians(generator.uniform(*ends(self.direction)))
        velocity = self.speed * product(np.array([cos(angle), sin(angle), 0.0]), axes)
        return Air(model.mj, velocity, 0.5 * self.density * self.drag)


DisturbanceSettings = Annotated[Calm | Push | Wind, Field(discriminator="kind")]


class Nothing:
    """Leaves everything as it is."""

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        return np.zeros(6)


@dataclass(frozen=True)
class OnePush:
    """A force (3,) [N] on a body from `begin` to `end` [s]."""

    body: int
    force: Array
    begin: float
    end: float

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`; a step that holds a part of the push gets that part of it."""
        overlap = min(data.time + period, self.end) - max(data.time, self.begin)
        force = self.force * (max(overlap, 0.0) / period)
        data.xfrc_applied[self.body, :3] = force
        lever = data.xipos[self.body] - data.subtree_com[ROOT_BODY]
        return np.concatenate((force, cross(lever, force)))


class PushAtPhase:
    """A push that waits until the behaviour comes through a phase."""

    def __init__(self, push: OnePush, phase: float) -> None:
        """Begin `push` where it would have begun, or later, at that phase [rad]."""
        self._push, self._phase = push, phase
        self._last, self._begun = nan, False

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        push = self._push
        if not self._begun and data.time >= push.begin and self._passed(phase):
            lasting = push.end - push.begin
            self._push = OnePush(push.body, push.force, data.time, data.time + lasting)
            self._begun = True
        self._last = phase
        return self._push.apply(data, period) if self._begun else np.zeros(6)

    def _passed(self, phase: float) -> bool:
        """Whether the last control step went over the phase that is waited for, either way."""
        step, ahead = phase - self._last, self._phase - self._last
        return ahead % tau <= step if step > 0.0 else -ahead % tau <= -step


class Air:
    """Drag of moving air on every solid capsule and sphere, by the area it shows."""

    def __init__(self, mj: mujoco.MjModel, velocity: Array, factor: float) -> None:
        """Air of that velocity (3,) [m/s].

        Args:
            factor: half the density times the drag coefficient [kg/m3].
        """
        self._mj, self._wind, self._factor = mj, velocity, factor
        solid = is_character(mj)[mj.geom_bodyid] & (mj.geom_contype > 0)
        self._geoms = np.flatnonzero(solid).tolist()
        self._capsule = mj.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        mj = self._mj
        data.xfrc_applied[:] = 0.0
        motion, total = np.empty(6), np.zeros(6)
        for geom in self._geoms:
            mujoco.mj_objectVelocity(mj, data, mujoco.mjtObj.mjOBJ_GEOM, geom, motion, 0)
            flow = self._wind - motion[3:]
            speed = sqrt(dot(flow, flow))
            if speed == 0.0:
                continue
            axis = data.geom_xmat[geom].reshape(3, 3)[:, 2].copy()
            across = cross(axis, flow / speed)
            radius, half = mj.geom_size[geom, :2] * (1.0, self._capsule[geom])
            area = pi * radius**2 + 4.0 * radius * half * sqrt(dot(across, across))
            body = mj.geom_bodyid[geom]
            force = self._factor * area * speed * flow
            data.xfrc_applied[body, :3] += force
            data.xfrc_applied[body, 3:] += cross(data.geom_xpos[geom] - data.xipos[body], force)
            total[:3] += force
            total[3:] += cross(data.geom_xpos[geom] - data.subtree_com[ROOT_BODY], force)
        return total
