"""Flesh: soft at the first touch, firm once it is pressed together.

A damper that is whole from the first touch makes the hardest blow there. Of flesh the damping grows
with the depth too, as Hunt and Crossley have it (J. Appl. Mech. 42, 1975).
"""

from collections.abc import Mapping
from typing import Annotated

import mujoco
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.physics.mujoco_physics import IMPEDANCES
from rotctl.settings.fields import STRICT, Fraction, Positive, SomeNames
from rotctl.suggestion import instead

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

    bodies: SomeNames
    depth: Annotated[Positive, Field(le=10)]
    onset: Annotated[Fraction, Field(ge=IMPEDANCES[0])]

    def require_room(self, thick: Mapping[str, float]) -> None:
        """See that bodies are as thick [m], from their surfaces to their middles, as their flesh.

        Raises:
            ValueError: one is not, or there is none of a name.
        """
        for name in self.bodies:
            if name not in thick:
                raise ValueError(f"flesh.bodies: no body {name!r}; {instead(name, thick)}")
            if self.depth > thick[name]:
                raise ValueError(
                    f"flesh.depth={self.depth:g}: must be at most {thick[name]:g}, which {name} "
                    "has from its surface to its middle"
                )


def add_flesh(spec: mujoco.MjSpec, flesh: Flesh) -> None:
    """Give the character in `spec` its flesh.

    Raises:
        InputError: it is firmer at its surface than in its depth.
    """
    soft = {name + side for name in flesh.bodies for side in ("", *SIDES)}
    for geom in [geom for geom in spec.geoms if geom.contype and geom.parent.name in soft]:
        firm = float(geom.solimp[1])
        if flesh.onset >= firm:
            raise InputError(
                f"character.flesh.onset={flesh.onset:g}: must be less than {firm:g}, which the "
                "contact comes to as it is pressed together"
            )
        geom.solimp = [flesh.onset, firm, flesh.depth, *LINEAR]
