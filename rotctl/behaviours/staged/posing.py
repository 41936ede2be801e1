"""How a stage chooses the pose that is tracked: over phase, rise, turn or time, or by flight."""

from dataclasses import dataclass, field
from functools import cached_property
from math import copysign, radians
from typing import Protocol, TypeVar

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.easing import smooth
from rotctl.behaviours.scene import Scene
from rotctl.maths.rotations import Array, dot
from rotctl.mechanics.model import Model
from rotctl.motion import PosePair, Turn, make_pose
from rotctl.settings.fields import STRICT, Finite, Positive, Range

Remembered = TypeVar("Remembered")


class PoseLaw(Protocol[Remembered]):
    """A stage's pose as a feedback law of the state, and of what it remembers of its stage."""

    def advance(self, before: Remembered | None, scene: Scene, period: float) -> Remembered | None:
        """What it remembers, one control period [s] on; before that it is None."""
        ...

    def poses(self, scene: Scene, memory: Remembered | None) -> tuple[Array, Array]:
        """Both poses (2, nu) to track [rad], and how fast they move (2, nu) [rad/s]."""
        ...


class Memoryless:
    """A law that remembers nothing."""

    def advance(self, before: None, scene: Scene, period: float) -> None:
        """Nothing."""


@validated(frozen=True, config=STRICT)
class Beyond:
    """A pose goes on beyond its target: a body that lies short of it shifts its limbs on.

    Attributes:
        gain: by what is missing, times this [-].
        time: in which it goes on by as much again, for as long as it is missing [s].
    """

    gain: Positive
    time: Positive


@dataclass(frozen=True)
class OverPhase:
    """Key poses over the phase, ahead of it.

    It remembers how far they have gone on beyond the target while something was missing [rad].

    Attributes:
        lead: at most, and without `beyond` at most at the target [rad].
        beyond: how they go on.
    """

    pair: PosePair
    lead: float
    beyond: Beyond | None = None

    def advance(self, before: float | None, scene: Scene, period: float) -> float | None:
        """See `PoseLaw`."""
        if self.beyond is None:
            return None
        more = self.beyond.gain * (scene.target - scene.turned) * period / self.beyond.time
        return self._at_most((before or 0.0) + more)

    def poses(self, scene: Scene, memory: float | None) -> tuple[Array, Array]:
        """See `PoseLaw`."""
        missing = scene.target - scene.turned
        if self.beyond is not None:
            missing += self.beyond.gain * missing + (memory or 0.0)
        poses = self.pair.at(scene.excursion.phase + self._at_most(missing))
        return poses, np.zeros_like(poses)

    def _at_most(self, ahead: float) -> float:
        return min(max(ahead, -self.lead), self.lead)


@validated(frozen=True, config=STRICT)
class RiseSettings:
    """From one pose to another while the centre of mass rises.

    Attributes:
        start, end: poses by joint name [rad].
        height: of the centre of mass over the ground in the end [m].
        parts: of the way to that height in which a joint moves [-], by name; the others take all.
    """

    start: dict[str, Turn]
    end: dict[str, Turn]
    height: Positive
    parts: dict[str, Range] = field(default_factory=dict)

    def make(self, model: Model, key: str) -> "Rise":
        """For one run.

        Raises:
            InputError: a name is no joint of the model.
        """
        parts = np.tile([0.0, 1.0], (len(model.joint_names), 1))
        for name, part in self.parts.items():
            parts[model.motors(name, f"{key}.parts")] = part
        start = make_pose(model, self.start, f"{key}.start")
        end = make_pose(model, self.end, f"{key}.end")
        return Rise(start, end, self.height, parts)


@dataclass(frozen=True)
class Rise(Memoryless):
    """Joints follow the height, and are given their speeds at it: a jump must not be braked.

    Attributes:
        start, end: (nu,) poses [rad].
        height: of the centre of mass in the end [m].
        parts: (nu, 2) of the way in which each joint moves [-].
    """

    start: Array
    end: Array
    height: float
    parts: Array

    def poses(self, scene: Scene, memory: None) -> tuple[Array, Array]:
        """See `PoseLaw`."""
        z, first = float(scene.state.momentum.com[2]), float(scene.begin.com[2])
        way = scene.floor + self.height - first
        way = copysign(max(abs(way), 1e-3), way)
        begin, span, fastest, change = self._ways
        gone = ((z - first) / way - begin) / span
        share = np.minimum(np.maximum(gone, 0.0), 1.0)
        speed = np.where(gone == share, fastest, 0.0)
        speed *= max(float(scene.state.momentum.com_velocity[2]) / way, 0.0)
        pose, speed = self.start + share * change, speed * change
        return np.array((pose, pose)), np.array((speed, speed))

    @cached_property
    def _ways(self) -> tuple[Array, Array, Array, Array]:
        """Of each joint: where it begins, over which part, its share's speed, and its change."""
        begin, finish = self.parts.T
        span = finish - begin
        return begin, span, 1.0 / span, self.end - self.start


@validated(frozen=True, config=STRICT)
class TurnSettings:
    """From one pose to another while the body turns.

    Attributes:
        start, end: poses by joint name [rad].
        angles: turned since the behaviour began, where it leaves the one and where it has come to
            the other [deg].
    """

    start: dict[str, Turn]
    end: dict[str, Turn]
    angles: tuple[Finite, Finite]

    def __post_init__(self) -> None:
        if self.angles[0] == self.angles[1]:
            raise ValueError(f"angles {self.angles[0]:g} and {self.angles[1]:g} are the same")

    def make(self, model: Model, key: str) -> "OverTurn":
        """For one run.

        Raises:
            InputError: a name is no joint of the model.
        """
        start = make_pose(model, self.start, f"{key}.start")
        end = make_pose(model, self.end, f"{key}.end")
        first, last = self.angles
        return OverTurn(start, end, radians(first), radians(last))


@dataclass(frozen=True)
class OverTurn(Memoryless):
    """Joints follow the turn, as the slides' hands and arms do: faster where the body is faster.

    Attributes:
        start, end: (nu,) poses [rad].
        first, last: turned, where they are to be there [rad].
    """

    start: Array
    end: Array
    first: float
    last: float

    def poses(self, scene: Scene, memory: None) -> tuple[Array, Array]:
        """See `PoseLaw`."""
        way = self.last - self.first
        gone = (scene.turned - self.first) / way
        share = min(max(gone, 0.0), 1.0)
        rate = dot(scene.state.momentum.angular_velocity, scene.turning) / way
        speed = max(rate, 0.0) if share == gone else 0.0
        change = self.end - self.start
        pose, speeds = self.start + share * change, speed * change
        return np.array((pose, pose)), np.array((speeds, speeds))


@validated(frozen=True, config=STRICT)
class GlideSettings:
    """From one pose to another in a time: what is in balance all the way waits for nothing.

    Attributes:
        start, end: poses by joint name [rad].
        seconds: that it takes [s], from rest to rest.
    """

    start: dict[str, Turn]
    end: dict[str, Turn]
    seconds: Positive

    def make(self, model: Model, key: str) -> "Glide":
        """For one run.

        Raises:
            InputError: a name is no joint of the model.
        """
        start = make_pose(model, self.start, f"{key}.start")
        end = make_pose(model, self.end, f"{key}.end")
        return Glide(start, end, self.seconds)


@dataclass(frozen=True)
class Glide(Memoryless):
    """Joints move without a jerk at either end.

    Attributes:
        start, end: (nu,) poses [rad].
        seconds: from one to the other [s].
    """

    start: Array
    end: Array
    seconds: float

    def poses(self, scene: Scene, memory: None) -> tuple[Array, Array]:
        """See `PoseLaw`."""
        gone = min((scene.state.time - scene.begin.time) / self.seconds, 1.0)
        share = gone**3 * (10.0 - 15.0 * gone + 6.0 * gone * gone)
        rate = 30.0 * (gone * (1.0 - gone)) ** 2 / self.seconds
        change = self.end - self.start
        pose, speed = self.start + share * change, rate * change
        return np.array((pose, pose)), np.array((speed, speed))


@validated(frozen=True, config=STRICT)
class ReachSettings:
    """From the pose that a stage begins in to another one.

    Attributes:
        pose: by joint name [rad].
        seconds: that it takes, from rest to rest [s].
    """

    pose: dict[str, Turn]
    seconds: Positive

    def make(self, model: Model, key: str) -> "Reach":
        """For one run.

        Raises:
            InputError: a name is no joint of the model.
        """
        return Reach(make_pose(model, self.pose, f"{key}.pose"), self.seconds)


@dataclass(frozen=True)
class Reach(Memoryless):
    """Joints go to a pose (nu,) [rad] in a time [s], smoothly."""

    end: Array
    seconds: float

    def poses(self, scene: Scene, memory: None) -> tuple[Array, Array]:
        """See `PoseLaw`."""
        gone = min((scene.state.time - scene.begin.time) / self.seconds, 1.0)
        share = smooth(gone)
        change = self.end - scene.begin.angles
        pose = scene.begin.angles + share * change
        speed = 6.0 * gone * (1.0 - gone) / self.seconds * change
        return np.array((pose, pose)), np.array((speed, speed))
