"""When a stage ends: a small closed set of conditions on the state."""

from math import radians
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.scene import Scene
from rotctl.mechanics.model import Model, body_ids
from rotctl.settings import STRICT, Finite, NonNegative


@validated(frozen=True, config=STRICT)
class After:
    """So long after the stage began [s]."""

    kind: Literal["after"]
    seconds: NonNegative

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.state.time - scene.begin.time >= self.seconds - 1e-9


@validated(frozen=True, config=STRICT)
class Turned:
    """Turned so far since the behaviour began, as a share of its target or by an angle [deg]."""

    kind: Literal["turned"]
    share: NonNegative | None = None
    angle: Finite | None = None

    def __post_init__(self) -> None:
        if (self.share is None) == (self.angle is None):
            raise ValueError("give either share or angle, not both and not neither")

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if self.share is not None:
            goal = self.share * scene.target
        else:
            goal = radians(self.angle or 0.0)
        return scene.turned >= goal if goal >= 0.0 else scene.turned <= goal


@validated(frozen=True, config=STRICT)
class Near:
    """So near to the behaviour's target, on either side [deg]."""

    kind: Literal["near"]
    angle: NonNegative

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return abs(scene.target - scene.turned) <= radians(self.angle)


@validated(frozen=True, config=STRICT)
class Touches:
    """One of these bodies is on the ground; a name without a side stands for both sides."""

    kind: Literal["touches"]
    bodies: tuple[str, ...]

    def check(self, model: Model) -> None:
        """Raises InputError for a body that is not there."""
        body_ids(model.mj, self.bodies, "behaviour.stages.until.bodies")

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        wanted = body_ids(scene.model.mj, self.bodies, "behaviour.stages.until.bodies")
        return bool(np.isin(scene.state.contacts.body, wanted).any())


@validated(frozen=True, config=STRICT)
class Airborne:
    """Nothing has touched the ground for so long [s]."""

    kind: Literal["airborne"]
    seconds: NonNegative

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.airborne > 0.0 and scene.airborne >= self.seconds


@validated(frozen=True, config=STRICT)
class Still:
    """Nothing has moved fast for so long [s]."""

    kind: Literal["still"]
    seconds: NonNegative

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.still > 0.0 and scene.still >= self.seconds


Until = Annotated[After | Turned | Near | Touches | Airborne | Still, Field(discriminator="kind")]
