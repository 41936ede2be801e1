"""The numbers of a character: bodies, joints and capsules of `conf/character/*.yaml`."""

from collections.abc import Sequence
from dataclasses import field, replace
from math import dist
from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.flesh import Flesh
from rotctl.settings.fields import (
    SPARSE,
    STRICT,
    Finite,
    Fraction,
    Names,
    NonNegative,
    Positive,
    Range,
    SomeNames,
    Vector,
)

Colour = tuple[Fraction, Fraction, Fraction]
# Of a whole character, both sides counted: what a model may have out of a file, where a plate is
# two capsules. Control has room for 250 hinges.
MOST_CORNERS = 100  # of a hull
ROUNDED = 5e-4  # [m] its ball may be off: of corners of five decimals, ten times as big
MOST = {"bodies": 300, "joints": 200, "geoms": 4500, "pairs of geoms in self_collision": 20_000}


@validated(frozen=True, config=STRICT)
class Joint:
    """One hinge: axis in the body's frame, range [rad], torque limit [N m].

    `damping` [N m s/rad] and `armature` [kg m2] are the character's where absent; a spring is
    its stiffness [N m/rad] and the angle [rad] at which it gives nothing.
    """

    name: str
    axis: Vector
    range: Range
    torque: Positive
    damping: NonNegative | None = field(default=None, metadata=SPARSE)
    armature: NonNegative | None = field(default=None, metadata=SPARSE)
    spring: tuple[NonNegative, Finite] | None = field(default=None, metadata=SPARSE)


@validated(frozen=True, config=STRICT)
class Geom:
    """A capsule from `start` to `end` [m], or a sphere where `end` is absent; radius `size` [m].

    With a `hull`, corners [m] in the body's frame, it is what is between them; `start` and `size`
    are the ball around it, whose centre is the middle of its box, and it has no `end`. `mass` is
    a fraction of the character's mass. A geom of mass 0 is only seen: it neither weighs nor
    touches anything.
    """

    name: str
    size: Positive
    start: Vector
    mass: Fraction
    end: Vector | None = None
    hull: Annotated[tuple[Vector, ...], Field(min_length=4, max_length=MOST_CORNERS)] | None = (
        field(default=None, metadata=SPARSE)
    )
    colour: Colour | None = None

    def __post_init__(self) -> None:
        if self.hull is None:
            return
        if self.end is not None:
            raise ValueError("a hull has no end; leave it out")
        along = list(zip(*self.hull, strict=True))
        centre = [0.5 * (min(x) + max(x)) for x in along]
        off = max(map(abs, (a - b for a, b in zip(self.start, centre, strict=True))))
        radius = max(dist(corner, centre) for corner in self.hull)
        if max(off, abs(self.size - radius)) > ROUNDED * max(1.0, radius):
            ball = ", ".join(f"{x:.5g}" for x in centre)
            raise ValueError(
                f"start and size must be the ball around its hull: [{ball}] and {radius:.5g}"
            )


@validated(frozen=True, config=STRICT)
class Body:
    """A rigid segment; `mirror` makes a left one as written and a right one reflected.

    `position` [m] is in the parent's frame.
    """

    name: str
    geoms: tuple[Geom, ...]
    parent: str | None = None
    position: Vector = (0.0, 0.0, 0.0)
    joints: tuple[Joint, ...] = ()
    mirror: bool = False
    colour: Colour = (0.8, 0.6, 0.5)

    @property
    def thickness(self) -> float:
        """From the surface of what touches to its middle, where that is most [m]."""
        return max((geom.size for geom in self.geoms if geom.mass > 0), default=0.0)


@validated(frozen=True, config=STRICT)
class Drawn:
    """Whom the numbers of the bodies are of: height [m], mass [kg]."""

    height: Annotated[Positive, Field(le=10)]
    mass: Annotated[Positive, Field(le=10_000)]


@validated(frozen=True, config=STRICT)
class Character:
    """All numbers of one character; see `conf/character/adult.yaml` for units and sources.

    Attributes:
        height, mass: as it is to be; with `drawn`, bodies, joints and gains follow from it by the
            law of `rotctl.mechanics.stature`.
        drawn: whom the bodies draw; without, the height must be theirs.
        gains_for: whom the controller's gains are for, if not the drawn.
        absent: joints that others have, so that poses name them, and this one has not.
        strength: factor on all torque limits [-].
        flesh: what is soft where it meets the ground, if anything.
    """

    name: str
    height: Annotated[Positive, Field(le=10)]
    mass: Annotated[Positive, Field(le=10_000)]
    root_height: Annotated[Positive, Field(le=10)]
    joint_damping: NonNegative
    joint_armature: NonNegative
    limit_solref: tuple[Positive, Positive]
    trunk: SomeNames
    exclude_from_control: Names
    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]
    self_collision: tuple[tuple[str, str], ...] = ()
    drawn: Drawn | None = None
    gains_for: Drawn | None = None
    strength: Annotated[Positive, Field(le=1000)] = 1.0
    absent: Names = ()
    flesh: Flesh | None = field(default=None, metadata=SPARSE)
    description: str = ""

    def __post_init__(self) -> None:
        if self.drawn and not 0.1 <= self.height / self.drawn.height <= 10.0:
            raise ValueError(
                f"height={self.height:g}: must be within a tenth and ten times "
                f"{self.drawn.height:g} m"
            )
        if self.flesh:
            self.flesh.require_room({body.name: body.thickness for body in self.bodies})
            flesh = replace(self.flesh, bodies=_in_order(self.flesh.bodies, self.bodies))
            object.__setattr__(self, "flesh", flesh)
        excluded = _in_order(self.exclude_from_control, self.bodies)
        object.__setattr__(self, "exclude_from_control", excluded)
        for (what, most), count in zip(MOST.items(), _counts(self), strict=True):
            if count > most:
                raise ValueError(f"has {count} {what}; at most {most} can be simulated")


def _in_order(names: Names, bodies: Sequence[Body]) -> Names:
    """Names in the order of the bodies: in whichever they are written acts on nothing."""
    order = [body.name + side for body in bodies for side in ("", *SIDES)]
    return tuple(sorted(names, key=lambda name: order.index(name) if name in order else len(order)))


def _counts(character: Character) -> tuple[int, int, int, int]:
    """How many there will be of each of `MOST`."""
    sides = [2 if body.mirror else 1 for body in character.bodies]
    both = list(zip(sides, character.bodies, strict=True))
    solid: dict[str, int] = {}
    for n, body in both:
        solid[body.name] = solid.get(body.name, 0) + n * sum(geom.mass > 0 for geom in body.geoms)
    pairs = sum(  # of one body, left ones with right ones
        solid.get(a, 0) * solid.get(b, 0) // (4 if a == b else 1)
        for a, b in character.self_collision
    )
    joints, geoms = (sum(n * len(getattr(b, it)) for n, b in both) for it in ("joints", "geoms"))
    return sum(sides), joints, geoms, pairs
