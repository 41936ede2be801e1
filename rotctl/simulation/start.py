"""What a start state is, and the ranges that it is drawn from."""

from dataclasses import dataclass, field

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import Array
from rotctl.settings.fields import SPARSE, STRICT, Finite, HalfTurn, Range
from rotctl.simulation.aloft import AloftSettings
from rotctl.simulation.falling import FallingSettings
from rotctl.simulation.known import Known, StateSettings


@validated(frozen=True, config=STRICT)
class Posture:
    """How a character waits for its roll: pitch of the pelvis [rad] and joint angles [rad].

    A joint name without a side stands for both sides; joints not named are at 0.
    """

    pitch: Finite
    pose: dict[str, Finite]
    description: str = ""


@validated(frozen=True, config=STRICT)
class StartSettings:
    """Uniform ranges that a start state is drawn from.

    Attributes:
        pitch: of the pelvis about world y [rad]; negative leans back.
        speed_x, speed_y: velocity of the centre of mass [m/s].
        angular_velocity_x, angular_velocity_y, angular_velocity_z: of the whole body,
            moving as one rigid piece [rad/s].
        postures: to start in, by the axis that is rolled about; `pitch` is then added to
            theirs. Without any a run starts in its behaviour's own pose.
        scatter: how far each joint may be from its posture, either way [rad].
        tilt: how far the whole body may be turned about any axis [rad].
        falling: in the air, instead of on the ground; or
        aloft: high in it; or
        state: known to the last number, to which the ranges above are added.
    """

    name: str
    pitch: Range
    speed_x: Range
    speed_y: Range
    angular_velocity_x: Range
    angular_velocity_y: Range
    angular_velocity_z: Range
    postures: dict[str, Posture] = field(default_factory=dict)
    scatter: HalfTurn = 0.0
    tilt: HalfTurn = 0.0
    falling: FallingSettings | None = None
    aloft: AloftSettings | None = None
    state: StateSettings | None = field(default=None, metadata=SPARSE)
    description: str = ""

    def __post_init__(self) -> None:
        own = [name for name in ("falling", "aloft", "state", "postures") if getattr(self, name)]
        if len(own) > 1:
            raise ValueError(f"{own[0]} has its own pose, and there is {own[1]}")
        if (self.scatter or self.tilt) and not own:
            raise ValueError("scatter and tilt are about postures, and there are none")


@dataclass(frozen=True)
class Start:
    """A drawn start.

    Attributes:
        pitch: of the pelvis [rad].
        velocity: (3,) of the centre of mass [m/s].
        angular_velocity: (3,) of the whole body [rad/s].
        pose: (nu,) [rad]; None leaves it to the behaviour.
        tilt: (3,) rotation vector of the whole body [rad].
        gap: between its lowest point and the ground [m].
        height: of the centre of mass over what is below it, instead of a gap [m].
        ahead: of the origin [m].
        known: a state that the rest is beside: turned by `pitch` and `tilt`, faster by `velocity`
            and `angular_velocity`, with the joints at `pose`.
    """

    pitch: float
    velocity: Array
    angular_velocity: Array
    pose: Array | None = None
    tilt: Array = field(default_factory=lambda: np.zeros(3))
    gap: float = 0.0
    height: float = 0.0
    ahead: float = 0.0
    known: Known | None = None
