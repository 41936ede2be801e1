"""One contact for control where the physics has several in one place.

MuJoCo gives a heightfield's contacts by triangles of its cells: a limb that lies over an edge of
the grid touches both sides of it, in the same place, with normals some degrees apart even on level
cells. The physics needs them all. To control each would be one more point that must not slide and
one more force to choose, so that edges of the grid would weigh more than other places.
"""

from dataclasses import fields
from math import cos, radians
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts
from rotctl.settings.fields import STRICT, NonNegative


@validated(frozen=True, config=STRICT)
class Merging:
    """Which contacts of one body are one to control.

    Attributes:
        distance: they are nearer to each other than this [m]; 0 keeps all apart.
        angle: and their normals are within this [deg].
    """

    distance: NonNegative
    angle: Annotated[NonNegative, Field(le=90)]

    @property
    def parallel(self) -> float:
        """Least product of two unit normals [-]."""
        return cos(radians(self.angle))


APART = Merging(0.0, 0.0)


def merged(contacts: Contacts, merging: Merging) -> Contacts:
    """Of contacts that are one, the deepest: a real contact, with its own rows and frame.

    The deepest is taken first, then the next that is not one with any that was taken.
    """
    position, normal = contacts.position, contacts.frame[:, 0]
    one = contacts.body[:, None] == contacts.body
    one &= _squares(position[:, None] - position) < merging.distance**2
    one &= (normal[:, None] * normal).sum(axis=2) >= merging.parallel
    taken = np.zeros(contacts.count, dtype=bool)
    for i in np.argsort(contacts.gap, kind="stable"):
        taken[i] = not (one[i] & taken).any()
    if taken.all():
        return contacts
    return Contacts(
        **{field.name: getattr(contacts, field.name)[taken] for field in fields(contacts)}
    )


def _squares(difference: Array) -> Array:
    return np.asarray((difference**2).sum(axis=2))
