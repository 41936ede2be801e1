"""Which bodies of a model an aim or a condition names, and whether they are there.

`bodies` and `body` are fields of the aim itself, in their place among its others.
"""

from rotctl.mechanics.bodies import body_id, body_ids
from rotctl.mechanics.model import Model
from rotctl.settings.fields import SomeNames


class NamesNothing:
    """Names nothing, so that any model will do."""

    def check(self, model: Model, key: str) -> None:
        """Nothing can be wrong."""


class NamesBodies:
    """Names bodies; one without a side stands for both sides."""

    bodies: SomeNames

    def check(self, model: Model, key: str) -> None:
        """See that they are there.

        Args:
            key: where this stands.

        Raises:
            InputError: one is not.
        """
        body_ids(model.mj, self.bodies, f"{key}.bodies")


class NamesBody:
    """Names one body."""

    body: str

    def check(self, model: Model, key: str) -> None:
        """See that it is there; as `NamesBodies.check`."""
        body_id(model.mj, self.body, f"{key}.body")
