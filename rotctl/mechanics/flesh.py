"""Flesh: soft at the first touch, firm once it is pressed together.

A damper that is whole from the first touch makes the hardest blow there. Of flesh the damping grows
with the depth too, as Hunt and Crossley have it (J. Appl. Mech. 42, 1975).
"""

from collections.abc import Sequence
from typing import Annotated

import mujoco
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.mechanics.bodies import SIDES
from rotctl.settings.fields import STRICT, Fraction, Positive

LINEAR = (0.5, 1.0)  # midpoint and power of MuJoCo's impedance: as much more as it is deeper


@validated(frozen=True, config=STRICT)
class Flesh:
    """What a character is soft with where it meets the ground in MuJoCo's physics.

    Attributes:
        bodies: that have it, both sides of each.
        depth: at which a contact is as firm as the physics says [m].
        onset: its impedance at the first touch [-], 1 of a rigid contact.
    """

    bodies: Annotated[tuple[str, ...], Field(min_length=1)]
    depth: Annotated[Positive, Field(le=10)]
    onset: Fraction


def add_flesh(spec: mujoco.MjSpec, flesh: Flesh, known: Sequence[str]) -> None:
    """Give bodies of the character in `spec`, all of whose are `known`, their flesh.

    Raises:
        InputError: there is no body of a name.
    """
    for name in flesh.bodies:
        if name not in known:
            raise InputError(
                f"character.flesh.bodies names the unknown body {name!r}; "
                f"bodies: {', '.join(known)}"
            )
    soft = {name + side for name in flesh.bodies for side in ("", *SIDES)}
    for geom in spec.geoms:
        if geom.contype and geom.parent.name in soft:
            geom.solimp = [flesh.onset, geom.solimp[1], flesh.depth, *LINEAR]
