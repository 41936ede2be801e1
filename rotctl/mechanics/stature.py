"""A character of another height and weight than it is drawn: the law of similarity under gravity.

Of a body that is s times as tall and m times as heavy all lengths grow by s. It falls as everything
does, so its times grow by sqrt(s); its forces grow by m, its torques by m s. So a motion of the one
is a motion of the other, only slower, and it is as strong for its weight. `strength` is on top.
"""

from dataclasses import dataclass, replace
from math import sqrt

from rotctl.maths.rotations import scaled
from rotctl.mechanics.character import Body, Character, Drawn, Geom, Joint


@dataclass(frozen=True)
class Likeness:
    """Ratios of a character to the one that is drawn.

    Attributes:
        size: of lengths [-]; mass: of masses and forces [-].
    """

    size: float = 1.0
    mass: float = 1.0

    @property
    def time(self) -> float:
        """Of times [-]."""
        return sqrt(self.size)

    @property
    def torque(self) -> float:
        """Of torques and energies [-]."""
        return self.mass * self.size

    @property
    def same(self) -> bool:
        """Whether there is nothing to do."""
        return self.size == 1.0 == self.mass


def likeness(character: Character) -> Likeness:
    """How a character differs from the one that its bodies draw."""
    return _to(character, character.drawn)


def gains_likeness(character: Character) -> Likeness:
    """How it differs from the one that the controller's gains are for."""
    return _to(character, character.gains_for or character.drawn)


def _to(character: Character, other: Drawn | None) -> Likeness:
    if other is None:
        return Likeness()
    return Likeness(character.height / other.height, character.mass / other.mass)


def grown(character: Character) -> Character:
    """The same with its bodies, joints and strength as they are to be, and drawn so."""
    by = likeness(character)
    if by.same and character.strength == 1.0:
        return character
    return replace(
        character,
        root_height=character.root_height * by.size,
        joint_damping=character.joint_damping * by.torque * by.time,
        joint_armature=character.joint_armature * by.torque * by.size,
        bodies=tuple(_body(body, by, character.strength) for body in character.bodies),
        flesh=character.flesh and replace(character.flesh, depth=character.flesh.depth * by.size),
        drawn=None,
        strength=1.0,
    )


def _body(body: Body, by: Likeness, strength: float) -> Body:
    return replace(
        body,
        position=scaled(body.position, by.size),
        joints=tuple(_joint(joint, by, strength) for joint in body.joints),
        geoms=tuple(_geom(geom, by.size) for geom in body.geoms),
    )


def _joint(joint: Joint, by: Likeness, strength: float) -> Joint:
    def times(value: float | None, factor: float) -> float | None:
        return None if value is None else value * factor

    return replace(
        joint,
        torque=joint.torque * by.torque * strength,
        damping=times(joint.damping, by.torque * by.time),
        armature=times(joint.armature, by.torque * by.size),
        spring=joint.spring and (joint.spring[0] * by.torque, joint.spring[1]),
    )


def _geom(geom: Geom, size: float) -> Geom:
    return replace(
        geom,
        size=geom.size * size,
        start=scaled(geom.start, size),
        end=None if geom.end is None else scaled(geom.end, size),
        hull=geom.hull and tuple(scaled(corner, size) for corner in geom.hull),
    )
