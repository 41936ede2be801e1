"""A stage's pose that follows the body: how high it has risen, or how far it has turned."""

from dataclasses import dataclass, field
from functools import cached_property
from math import copysign, radians

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.scene import Scene
from rotctl.behaviours.staged.posing import Memoryless
from rotctl.maths.rotations import Array, dot
from rotctl.mechanics.model import Model
from rotctl.motion import Turn, make_pose
from rotctl.settings.fields import STRICT, Finite, Positive, Range


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
