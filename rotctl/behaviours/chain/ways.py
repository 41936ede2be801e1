"""Ways of a chain: which of its parts follow each other, by how the body is as it begins."""

from dataclasses import field
from math import cos, radians, sin, tau
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.named_bodies import NamesNothing
from rotctl.maths.rotations import dot
from rotctl.mechanics.bodies import body_ids
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.settings.fields import MOST_PARTS, SPARSE, STRICT, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class FaceDown(NamesNothing):
    """The trunk's front looks down: on the front, on hands and knees.

    Attributes:
        angle: off straight down, at most [deg].
    """

    kind: Literal["face_down"]
    angle: Annotated[Positive, Field(le=180.0)]

    def met(self, model: Model, state: State) -> bool:
        """Whether it is so."""
        return float(state.trunk_axes[2, 0]) <= -cos(radians(self.angle))


@validated(frozen=True, config=STRICT)
class OnFeet:
    """A foot is on the ground, or all but, and the centre of mass over both: a squat, a stand.

    Attributes:
        feet: they.
        out: the centre of mass is so far outside them at most, as seen from above [m].
        lean: of the trunk at most, from upright [deg].
        speed: of the centre of mass at most: who rolls through a squat goes on [m/s].
    """

    kind: Literal["on_feet"]
    feet: SomeNames
    out: Positive
    lean: Annotated[Positive, Field(le=180.0)]
    speed: Positive

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where this stands."""
        body_ids(model.mj, self.feet, f"{key}.feet")

    def met(self, model: Model, state: State) -> bool:
        """Whether it is so."""
        feet = body_ids(model.mj, self.feet)
        if all(support.lifted(model, state, foot) for foot in feet):
            return False
        corners = support.hull(support.ends(model, state.data, feet))
        x, y, _ = state.momentum.com.tolist()
        velocity = state.momentum.com_velocity
        if dot(velocity, velocity) > self.speed**2:
            return False
        upright = float(state.trunk_axes[2, 2]) >= cos(radians(self.lean))
        return upright and support.outside(corners, (x, y)) <= self.out


@validated(frozen=True, config=STRICT)
class Rolls(NamesNothing):
    """It still rolls, forward or backward: the whole body turns about the trunk's left.

    Attributes:
        turning: so fast at least, whichever way [rev/s].
        tilt: of the trunk's left out of the level at most [deg].
    """

    kind: Literal["rolls"]
    turning: Positive
    tilt: Annotated[Positive, Field(le=90.0)]

    def met(self, model: Model, state: State) -> bool:
        """Whether it is so."""
        left = state.trunk_axes[:, 1]
        level = abs(float(left[2])) <= sin(radians(self.tilt))
        return level and abs(dot(left, state.momentum.angular_velocity)) >= tau * self.turning


Posture = Annotated[FaceDown | OnFeet | Rolls, Field(discriminator="kind")]


@validated(frozen=True, config=STRICT)
class Way:
    """Parts that follow each other.

    Attributes:
        parts: their numbers, from 0.
        when: how the body is that takes it; the last way is for all others and has none.
        patience: a part that lasts longer has come to nothing, and the way is chosen anew [s];
            None waits for ever.
    """

    parts: Annotated[tuple[Annotated[int, Field(ge=0)], ...], Field(min_length=1)]
    when: Posture | None = field(default=None, metadata=SPARSE)
    patience: Positive | None = field(default=None, metadata=SPARSE)


Ways = Annotated[tuple[Way, ...], Field(min_length=1, max_length=MOST_PARTS)]


def check(ways: tuple[Way, ...], parts: int) -> None:
    """See that ways lead through the parts of a chain.

    Args:
        parts: how many there are.

    Raises:
        ValueError: one names a part that is not there, or one twice; a part is on no way; not the
            last way alone is for all others.
    """
    for number, way in enumerate(ways):
        for part in way.parts:
            if part >= parts:
                raise ValueError(f"ways.{number}.parts: no part {part}; valid: 0 to {parts - 1}")
        if len(set(way.parts)) < len(way.parts):
            raise ValueError(f"ways.{number}.parts: a part comes once on a way")
        if (way.when is None) != (number + 1 == len(ways)):
            wrong = "must have a when" if way.when is None else "must have no when, as the last one"
            raise ValueError(f"ways.{number}: {wrong}")
    unused = set(range(parts)).difference(*(way.parts for way in ways))
    if unused:
        raise ValueError(f"ways: none leads through part {min(unused)}")


def chosen(ways: tuple[Way, ...], model: Model, state: State) -> int:
    """Number of the first way that is for a body as it is now."""
    for number, way in enumerate(ways):
        if way.when is None or way.when.met(model, state):
            return number
    raise AssertionError("the last way is for all others")
