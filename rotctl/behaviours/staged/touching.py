"""When a stage ends by what touches: ground, water, or nothing any more."""

from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.launch import Whirl
from rotctl.behaviours.named_bodies import NamesBodies, NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.errors import InputError
from rotctl.mechanics.bodies import body_ids, lowest_and_highest
from rotctl.mechanics.model import Model
from rotctl.mechanics.terrain.pool import Basin
from rotctl.settings.fields import STRICT, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class Touches(NamesBodies):
    """One of these bodies is on the ground; a name without a side stands for both sides.

    Attributes:
        after: not before so long in the stage: a foot has to leave the ground first [s].
    """

    kind: Literal["touches"]
    bodies: SomeNames
    after: NonNegative = 0.0

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if scene.state.time - scene.begin.time < self.after - 1e-9:
            return False
        wanted = body_ids(scene.model.mj, self.bodies)
        return any(body in wanted for body in scene.state.contacts.body.tolist())


@validated(frozen=True, config=STRICT)
class Airborne(NamesNothing):
    """Nothing has touched the ground for so long [s]."""

    kind: Literal["airborne"]
    seconds: NonNegative

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.airborne > 0.0 and scene.airborne >= self.seconds


@validated(frozen=True, config=STRICT)
class Lands(NamesBodies):
    """As `touches`, on the way down: feet that leave the ground in their time do not count."""

    kind: Literal["lands"]
    bodies: SomeNames

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        falls = float(scene.state.momentum.com_velocity[2]) < 0.0
        return falls and Touches("touches", self.bodies).met(scene)


@validated(frozen=True, config=STRICT)
class Enters:
    """One of these bodies is under water."""

    kind: Literal["enters"]
    bodies: SomeNames

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there, and where there is no water."""
        body_ids(model.mj, self.bodies, f"{key}.bodies")
        if not isinstance(model.ground, Basin):
            raise InputError(
                f"{key}: this behaviour dives, and here is no water; choose terrain=pool"
            )

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        mj, data = scene.model.mj, scene.state.data
        bodies = body_ids(mj, self.bodies)
        x, y, _ = scene.state.momentum.com.tolist()
        chosen = np.isin(mj.geom_bodyid, bodies) & (mj.geom_contype > 0)
        return lowest_and_highest(mj, data, chosen)[0] < scene.model.ground.height(x, y)


@validated(frozen=True, config=STRICT)
class Launched(NamesNothing):
    """It rises at a speed [m/s], has come to a height [m], or its legs are straight [rad].

    Attributes:
        knee: legs are straight where knees bend less [rad]; the mean counts.
        turning: task whose aim is `whirl`: without ground and with as much angular momentum as
            that wants it ends as well. Who came down again would stamp more into it.
    """

    kind: Literal["launched"]
    up: Positive
    height: Positive
    knee: Positive
    turning: str = ""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if self.turning and scene.airborne > 0.0:
            whirl = scene.aims[self.turning]
            assert isinstance(whirl, Whirl)  # see `staged.named_tasks`
            if whirl.enough(scene):
                return True
        state, model = scene.state, scene.model
        knees = state.position[model.angles][model.motors("knee", "knee")]
        return (
            float(state.momentum.com_velocity[2]) >= self.up
            or float(state.momentum.com[2]) - scene.floor >= self.height
            or float(knees.sum()) / len(knees) < self.knee
            or scene.airborne > 0.012
        )
