"""When a stage ends: a small closed set of conditions on the state."""

from dataclasses import field
from math import atan2, cos, radians, sin, tau
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.pendulum import leaning
from rotctl.behaviours.named_bodies import NamesBodies, NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.staged.touching import Airborne, Enters, Lands, Launched, Touches
from rotctl.behaviours.standing.pivoting import Escapes
from rotctl.behaviours.standing.poising import borne_at
from rotctl.behaviours.standing.tipping import beyond
from rotctl.maths.rotations import dot
from rotctl.settings.fields import SPARSE, STRICT, Finite, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class After(NamesNothing):
    """So long after the stage began [s]."""

    kind: Literal["after"]
    seconds: NonNegative

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.state.time - scene.begin.time >= self.seconds - 1e-9


@validated(frozen=True, config=STRICT)
class Turned(NamesNothing):
    """Turned so far since the behaviour began, as a share of its target or by an angle [deg]."""

    kind: Literal["turned"]
    share: NonNegative | None = None
    angle: Finite | None = None

    def __post_init__(self) -> None:
        if (self.share is None) == (self.angle is None):
            raise ValueError("give either share or angle, not both and not neither")

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if self.share is not None:
            goal = self.share * scene.target
        else:
            goal = radians(self.angle or 0.0)
        return scene.turned >= goal if goal >= 0.0 else scene.turned <= goal


@validated(frozen=True, config=STRICT)
class Near(NamesNothing):
    """So near to the behaviour's target, on either side [deg], and calm.

    Attributes:
        speed: of the centre of mass, at most [m/s]; any if None.
        turning: of the whole body about the axis that it turns about, at most [rev/s]; likewise.
        level: the trunk's long axis is so far out of it at most [deg]: who sits, or stands on its
            shoulders, lies down first; any if None.
    """

    kind: Literal["near"]
    angle: NonNegative
    speed: Positive | None = field(default=None, metadata=SPARSE)
    turning: Positive | None = field(default=None, metadata=SPARSE)
    level: Annotated[Positive, Field(le=90.0)] | None = field(default=None, metadata=SPARSE)

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        steep = abs(float(scene.state.trunk_axes[2, 2]))
        if self.level is not None and steep > sin(radians(self.level)):
            return False
        momentum = scene.state.momentum
        velocity, turns = momentum.com_velocity, dot(scene.turning, momentum.angular_velocity)
        if self.speed is not None and dot(velocity, velocity) > self.speed**2:
            return False
        if self.turning is not None and abs(turns) > tau * self.turning:
            return False
        return abs(scene.target - scene.turned) <= radians(self.angle)


@validated(frozen=True, config=STRICT)
class Leant(NamesNothing):
    """The trunk leans so far, whichever way [deg]: 90 lies, 180 is head down.

    From the ground's normal: who lies with the head downhill has not begun to lean by that.

    Attributes:
        after: not before so long in the stage [s].
    """

    kind: Literal["leant"]
    angle: Annotated[NonNegative, Field(le=180.0)]
    after: NonNegative

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        x, y, _ = scene.state.momentum.com.tolist()
        up = dot(scene.model.ground.normal(x, y), scene.state.trunk_axes[:, 2])
        leant = up <= cos(radians(self.angle))
        return leant and scene.state.time - scene.begin.time >= self.after - 1e-9


@validated(frozen=True, config=STRICT)
class Low(NamesNothing):
    """The centre of mass is nearer to the ground than that [m]."""

    kind: Literal["low"]
    height: Positive

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        x, y, z = scene.state.momentum.com.tolist()
        return z - scene.model.ground.height(x, y) < self.height


@validated(frozen=True, config=STRICT)
class Still(NamesNothing):
    """Nothing has moved fast for so long [s]."""

    kind: Literal["still"]
    seconds: NonNegative

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return scene.still > 0.0 and scene.still >= self.seconds


@validated(frozen=True, config=STRICT)
class Tilted(NamesBodies):
    """The centre of mass leans so far over the middle of these bodies, to forward [deg]."""

    kind: Literal["tilted"]
    bodies: SomeNames
    angle: Finite

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        ahead, height = leaning(scene, self.bodies)
        tilt = atan2(ahead, height)
        goal = radians(self.angle)
        return tilt >= goal if goal >= 0.0 else tilt <= goal


@validated(frozen=True, config=STRICT)
class Passed(NamesBodies):
    """The centre of mass is so far beyond the middle of these bodies along the way, or nearer [m].

    Attributes:
        distance: beyond it; negative before it.
    """

    kind: Literal["passed"]
    bodies: SomeNames
    distance: Finite

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        return beyond(scene, self.bodies) >= self.distance


@validated(frozen=True, config=STRICT)
class Leaves(NamesBodies):
    """None of these bodies is on the ground any more, or it has turned too far to push on.

    Attributes:
        after: not before so long in the stage: who lands may bounce [s].
        angle: turned so far since the behaviour began, it ends in any case [deg].
    """

    kind: Literal["leaves"]
    bodies: SomeNames
    after: NonNegative
    angle: Finite

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if Turned("turned", angle=self.angle).met(scene):
            return True
        settled = scene.state.time - scene.begin.time >= self.after - 1e-9
        return settled and not Touches("touches", self.bodies).met(scene)


@validated(frozen=True, config=STRICT)
class Over(NamesBodies):
    """The centre of mass is over the middle of these bodies' contacts, along the way, and calm.

    Attributes:
        within: so near to it [m].
        speed: no faster than this [m/s].
    """

    kind: Literal["over"]
    bodies: SomeNames
    within: Positive
    speed: Positive

    def met(self, scene: Scene) -> bool:
        """Whether the stage ends now."""
        if not Touches("touches", self.bodies).met(scene):
            return False
        momentum, (fx, fy, _) = scene.state.momentum, scene.axes[0].tolist()
        (x, y, _), (mx, my) = momentum.com.tolist(), borne_at(scene, self.bodies)
        off = fx * (x - mx) + fy * (y - my)
        speed = dot(momentum.com_velocity, scene.axes[0])
        return abs(off) < self.within and abs(speed) < self.speed


Until = Annotated[
    After
    | Turned
    | Near
    | Leant
    | Low
    | Touches
    | Airborne
    | Still
    | Lands
    | Enters
    | Tilted
    | Passed
    | Launched
    | Leaves
    | Over
    | Escapes,
    Field(discriminator="kind"),
]
