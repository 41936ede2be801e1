"""How bodies are to be turned: aims of attitude tasks."""

from math import atan2, radians, sqrt
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.named_bodies import NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.maths.rotations import about_up, advance, advanced, rotation_between
from rotctl.settings.fields import STRICT, Finite, Fraction

UP = np.array([0.0, 0.0, 1.0])


@validated(frozen=True, config=STRICT)
class Upright(NamesNothing):
    """A body's up is the world's, whatever its turn about it: attitude.

    Of one that is on the ground it is the ground's normal: a foot that is held level on a slope
    stands on its edge.
    """

    law: Literal["upright"]

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        body, state = int(task["body"]), scene.state
        w, _, _, z = state.data.xquat[body].tolist()
        length = sqrt(w * w + z * z) or 1.0
        target = w / length, 0.0, 0.0, z / length
        if body in state.contacts.body.tolist():
            x, y, _ = state.data.xpos[body].tolist()
            normal = scene.model.ground.normal(x, y).tolist()
            if normal[2] < 1.0:
                target = advanced(target, rotation_between((0.0, 0.0, 1.0), normal))
        task["target"] = target


@validated(frozen=True, config=STRICT)
class Bow(NamesNothing):
    """A body faces the way, and bows to it: attitude.

    Attributes:
        angle: from upright about left [deg].
    """

    law: Literal["bow"]
    angle: Finite

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        forward, left, _ = scene.axes
        facing = about_up(atan2(float(forward[1]), float(forward[0])))
        task["target"] = advance(facing, radians(self.angle) * left)


@validated(frozen=True, config=STRICT)
class Face(NamesNothing):
    """A body is upright and faces where a turn about up has brought it: attitude.

    Attributes:
        share: of the behaviour's target [-].
    """

    law: Literal["face"]
    share: Fraction

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        forward = scene.axes[0]
        turned = self.share * scene.target
        task["target"] = about_up(atan2(float(forward[1]), float(forward[0])) + turned)


@validated(frozen=True, config=STRICT)
class Plane(NamesNothing):
    """A body turns in its plane, as far as it likes: attitude.

    The plane lies across left, or across forward where the behaviour turns about that.
    """

    law: Literal["plane"]

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target: the present attitude, less what turns its axis away."""
        body, column = int(task["body"]), 0 if np.array_equal(scene.turning, scene.axes[0]) else 1
        side = scene.state.data.xmat[body].reshape(3, 3)[:, column]
        across = scene.axes[column]
        task["target"] = advanced(
            scene.state.data.xquat[body].tolist(), rotation_between(side.tolist(), across.tolist())
        )
