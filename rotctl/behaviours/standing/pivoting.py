"""Onto one foot: the centre of mass is taken over a point of it, about which the body may turn.

Who turns on the ball of a foot has no pressure to move, so balance is made before the foot is
alone: the centre of mass is brought over that point, to be there at rest in time.
"""

from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.named_bodies import NamesBody
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.standing.swinging import arrival
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import body_ids
from rotctl.settings.fields import STRICT, Positive, Vector


@validated(frozen=True, config=STRICT)
class Bring(NamesBody):
    """Bring the centre of mass over a point of a body, at rest, in a time: linear.

    Attributes:
        body: that bears it, or is to.
        point: of the body, in its frame [m].
        seconds: since the stage began, after which it is there [s].
        soonest: the time that is left counts as so much at least [s].
    """

    law: Literal["bring"]
    body: str
    point: Vector
    seconds: Positive
    soonest: Positive

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration: along the ground alone, and none upward."""
        (x, y, _), momentum = _place(scene, self.body, self.point).tolist(), scene.state.momentum
        cx, cy, _ = momentum.com.tolist()
        vx, vy, _ = momentum.com_velocity.tolist()
        left = max(self.seconds - (scene.state.time - scene.begin.time), self.soonest)
        task["acceleration"] = [arrival(x - cx, vx, left), arrival(y - cy, vy, left), 0.0]


@validated(frozen=True, config=STRICT)
class Escapes(NamesBody):
    """The capture point is so far from a point of a body that another foot is needed.

    Attributes:
        body: that bears it.
        point: of the body, in its frame [m].
        distance: seen from above [m].
    """

    kind: Literal["escapes"]
    body: str
    point: Vector
    distance: Positive

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        px, py, _ = _place(scene, self.body, self.point).tolist()
        x, y = support.capture_point(scene.state, support.pendulum_rate(scene.model, scene.state))
        return (x - px) ** 2 + (y - py) ** 2 > self.distance**2


def _place(scene: Scene, name: str, point: Vector) -> Array:
    """Of a point of a body (3,), world [m]."""
    data, (body,) = scene.state.data, body_ids(scene.model.mj, [name])
    turned = product(data.xmat[body].reshape(3, 3), np.array(point))
    return np.asarray(data.xpos[body] + turned)
