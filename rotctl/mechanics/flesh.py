"""Flesh: soft at the first touch, firm once it is pressed together.

A damper that is whole from the first touch makes the hardest blow there. Of flesh the damping grows
with the depth too, as Hunt and Crossley have it (J. Appl. Mech. 42, 1975).
"""

from collections.abc import Sequence
from typing import Annotated

import mujoco
from pydantic import AfterValidator, Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.mechanics.bodies import SIDES
from rotctl.settings.fields import STRICT, Fraction, Positive, each_once
from rotctl.suggestion import instead

LEAST = 1e-4  # [-] of MuJoCo's impedance, which takes a smaller one for it
LINEAR = (0.5, 1.0)  # midpoint and power of MuJoCo's impedance: as much more as it is deeper


@validated(frozen=True, config=STRICT)
class Flesh:
    """What a character is soft with where it meets the ground in MuJoCo's physics.

    Attributes:
        bodies: that have it, both sides of each.
        depth: at which a contact is as firm as the physics says [m]; no body is less thick, from
            its surface to its middle.
        onset: its impedance at the first touch [-], 1 of a rigid contact; less than the physics'.
    """

    bodies: Annotated[tuple[str, ...], Field(min_length=1), AfterValidator(each_once)]
    depth: Annotated[Positive, Field(le=10)]
    onset: Annotated[Fraction, Field(ge=LEAST)]


def add_flesh(spec: mujoco.MjSpec, flesh: Flesh, known: Sequence[str]) -> None:
    """Give bodies of the character in `spec`, all of whose are `known`, their flesh.

    Raises:
        InputError: there is no body of a name, it is less thick than its flesh, or the flesh is
            firmer at its surface than in its depth.
    """
    for name in flesh.bodies:
        if name not in known:
            raise InputError(
                f"character.flesh.bodies names the unknown body {name!r}; {instead(name, known)}"
            )
        both = {name + side for side in ("", *SIDES)}
        _soften([geom for geom in spec.geoms if geom.contype and geom.parent.name in both], flesh)


def _soften(geoms: Sequence[mujoco.MjsGeom], flesh: Flesh) -> None:
    """Of one body."""
    name, thick = geoms[0].parent.name, max(float(geom.size[0]) for geom in geoms)
    if flesh.depth > thick:
        raise InputError(
            f"character.flesh.depth is {flesh.depth:g} m, and {name} is {thick:.3g} m thick from "
            "its surface to its middle; valid: at most that"
        )
    for geom in geoms:
        firm = float(geom.solimp[1])
        if flesh.onset >= firm:
            raise InputError(
                f"character.flesh.onset={flesh.onset:g}: must be less than {firm:g}, which the "
                "contact comes to as it is pressed together"
            )
        geom.solimp = [flesh.onset, firm, flesh.depth, *LINEAR]
