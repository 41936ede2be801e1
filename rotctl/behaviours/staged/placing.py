"""Where points of bodies and the centre of mass are to be: aims of point and linear tasks."""

from math import sqrt
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.named_bodies import NamesBodies, NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.maths.rotations import dot
from rotctl.mechanics.bodies import body_ids
from rotctl.mechanics.model import Model
from rotctl.settings.fields import STRICT, Finite, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class Watch(NamesNothing):
    """Nothing is wanted: the log's error is the way from the point to the centre of mass: point."""

    law: Literal["watch"]

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target, and no weight."""
        task["target"][:3] = scene.state.momentum.com
        task["weight"] = 0.0


@validated(frozen=True, config=STRICT)
class Ground(NamesNothing):
    """A point that has left the ground is brought back to it: point.

    Attributes:
        height: of the point above the ground when its body stands [m].
    """

    law: Literal["ground"]
    height: NonNegative

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target; a body that stands has no weight here, its contacts hold it."""
        body = int(task["body"])
        x, y, _ = scene.state.data.xpos[body].tolist()
        task["target"][:3] = [x, y, scene.model.ground.height(x, y) + self.height]
        if body == scene.step.swing or body in scene.state.contacts.body.tolist():
            task["weight"] = 0.0


@validated(frozen=True, config=STRICT)
class Above(NamesBodies):
    """The centre of mass comes over the middle of bodies that may bear nothing yet: linear.

    Attributes:
        bodies: seen from above; a name without a side stands for both sides.
        ahead: of their middle, along the way [m].
        height: over the ground [m].
        most: of what is missing, that the spring is given at once [m].
    """

    law: Literal["above"]
    bodies: SomeNames
    height: Positive
    most: Positive
    ahead: Finite = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        model, state, com = scene.model, scene.state, scene.state.momentum.com
        bodies = body_ids(model.mj, self.bodies)
        x, y = support.middle(support.ends(model, state.data, bodies))
        missing = np.array([x, y, scene.floor + self.height]) + self.ahead * scene.axes[0] - com
        far = sqrt(dot(missing, missing))
        task["target"][:3] = com + min(1.0, self.most / far if far else 1.0) * missing


@validated(frozen=True, config=STRICT)
class Opposite:
    """A point is put on the ground where the capture point lies between it and a body: point.

    A foot that comes down there leaves nothing to tip the body to a side of the line from the one
    support to the other, however narrow both are.

    Attributes:
        body: the other support.
        ahead: of the capture point, as seen from that body [m].
        height: of the point above the ground when its body stands [m].
    """

    law: Literal["opposite"]
    body: str
    ahead: NonNegative
    height: NonNegative

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        body_ids(model.mj, [self.body], f"{key}.body")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        model, state = scene.model, scene.state
        other = body_ids(model.mj, [self.body])
        ox, oy = support.middle(support.ends(model, state.data, other))
        x, y = support.capture_point(state, support.pendulum_rate(model, state))
        far = sqrt((x - ox) ** 2 + (y - oy) ** 2)
        share = self.ahead / far if far else 0.0
        px, py = x + share * (x - ox), y + share * (y - oy)
        task["target"][:3] = [px, py, model.ground.height(px, py) + self.height]
