"""A stage's pose that goes by time: from one pose to another, or from where it is."""

from dataclasses import dataclass

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.easing import smooth
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.staged.posing import Memoryless
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion import Turn, make_pose
from rotctl.settings.fields import STRICT, Positive


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
