"""Onto one foot: the centre of mass is taken over a point of it, about which the body may turn.

Who turns on the ball of a foot has no pressure to move, so balance is made before the foot is
alone: the centre of mass is brought over that point, to be there at rest in time.
"""

from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.scene import Scene
from rotctl.behaviours.stepping import arrival
from rotctl.control.task import Tasks
from rotctl.linear import product
from rotctl.mechanics.bodies import body_id, body_ids
from rotctl.mechanics.model import Model
from rotctl.settings import STRICT, Positive, Vector


@validated(frozen=True, config=STRICT)
class Bring:
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

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        body_id(model.mj, self.body, f"{key}.body")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration: along the ground alone, and none upward."""
        data, (body,) = scene.state.data, body_ids(scene.model.mj, [self.body])
        place = data.xpos[body] + product(data.xmat[body].reshape(3, 3), np.array(self.point))
        (x, y, _), momentum = place.tolist(), scene.state.momentum
        cx, cy, _ = momentum.com.tolist()
        vx, vy, _ = momentum.com_velocity.tolist()
        left = max(self.seconds - (scene.state.time - scene.begin.time), self.soonest)
        task["acceleration"] = [arrival(x - cx, vx, left), arrival(y - cy, vy, left), 0.0]
