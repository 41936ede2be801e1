"""A foot that is put down beside the other one: who stands anyhow comes to stand as one begins."""

from math import copysign
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.named_bodies import NamesBody
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.standing.swinging import SOONEST, arrival, rise, velocity_of
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.maths.rotations import dot
from rotctl.mechanics.bodies import body_ids
from rotctl.settings.fields import STRICT, NonNegative, Positive


@validated(frozen=True, config=STRICT)
class Beside(NamesBody):
    """Set a foot down beside the other one, which bears the body, in a time: point.

    It stays on its side, and is neither before nor behind the other, as the behaviour faces.

    Attributes:
        body: the foot that bears.
        width: of the stance, from foot to foot [m].
        time: of the step [s].
        lift: of the foot on its way [m].
        height: of the point over the ground when the foot is down [m].
    """

    law: Literal["beside"]
    body: str
    width: Positive
    time: Positive
    lift: NonNegative
    height: NonNegative

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target, velocity and acceleration; the task has stiffness upward alone."""
        model, data, body = scene.model, scene.state.data, int(task["body"])
        place = data.xpos[body] + product(data.xmat[body].reshape(3, 3), task["point"])
        velocity = velocity_of(scene, body, place)
        gone = min((scene.state.time - scene.begin.time) / self.time, 1.0)
        left = max(self.time * (1.0 - gone), SOONEST)
        x, y = support.middle(support.ends(model, data, body_ids(model.mj, [self.body])))
        stands, forward, side = np.array([x, y, 0.0]), scene.axes[0], scene.axes[1]
        out = copysign(self.width, dot(place - stands, side))
        aside = out - dot(place - stands, side)
        ahead = dot(stands - place, forward)
        task["acceleration"] = arrival(ahead, dot(velocity, forward), left) * forward
        task["acceleration"] += arrival(aside, dot(velocity, side), left) * side
        rise(task, scene, self, gone, place, velocity)
