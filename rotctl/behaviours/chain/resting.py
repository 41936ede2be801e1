"""When a part of a chain is over whose last stage has no condition: it rests on its feet."""

from math import cos, radians

from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import dot
from rotctl.mechanics.state import State
from rotctl.settings.fields import STRICT, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class RestSettings:
    """When a part that has come to its last stage is over.

    Attributes:
        seconds: it has rested for so long [s].
        feet: that alone touch the ground meanwhile.
        lean: of the trunk at most [deg].
        speed: of the centre of mass at most [m/s].
        height: of it at least, as a share of that as the part began [-].
    """

    seconds: NonNegative
    feet: SomeNames
    lean: Positive
    speed: Positive
    height: Positive

    def seen(self, state: State, feet: set[int], height: float, first: float) -> bool:
        """Whether the body rests now.

        Args:
            feet: bodies that may touch.
            height: of the centre of mass over the ground, and
            first: as the part began [m].
        """
        touching = set(state.contacts.body.tolist())
        velocity = state.momentum.com_velocity
        return (
            bool(touching)
            and touching <= feet
            and float(state.trunk_axes[2, 2]) > cos(radians(self.lean))
            and dot(velocity, velocity) < self.speed**2
            and height > self.height * first
        )
