"""How a stage chooses the pose that is tracked, and the first way: key poses over the phase."""

from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.scene import Scene
from rotctl.maths.rotations import Array
from rotctl.motion import PosePair
from rotctl.settings.fields import STRICT, Positive

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
