"""The criteria that runs are to be judged by once more, in place of their own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rotctl.choices.overrides import assigned, single
from rotctl.config.loading import composed
from rotctl.errors import InputError
from rotctl.settings.complaints import clip, unknown_key
from rotctl.settings.plain import NOTHING, Way, exchanged, way


@dataclass(frozen=True)
class Criteria:
    """What is asked for.

    Attributes:
        base: criteria in place of a run's own; None: its own.
        changes: values that are set on them.
    """

    base: Mapping[str, Any] | None
    changes: Sequence[tuple[Way, Any]]

    def of(self, own: Mapping[str, Any]) -> Mapping[str, Any]:
        """The criteria for a run with these of its own.

        Raises:
            InputError: they have no such key.
        """
        found: Any = own if self.base is None else self.base
        if not isinstance(found, Mapping):
            raise InputError("its config has no criteria")
        if found.get("kind") == own.get("kind") == "chain" and not found.get("parts"):
            found = own  # those that its parts have by themselves, which came with the behaviour
        for place, value in self.changes:
            changed = exchanged(found, place, value)
            if changed is NOTHING:
                unknown = unknown_key(f"criteria.{place[0]}", "criteria", list(found))
                raise InputError(f"criteria={clip(str(found.get('name')))}: {unknown}")
            found = changed
        return dict(found)


def criteria(overrides: Sequence[str], none: bool = False) -> Criteria:
    """What overrides such as `criteria=landing criteria.tilt=20` ask for.

    Args:
        none: whether there may be none, which are a run's own.

    Raises:
        InputError: one is about something else, which would have to be simulated.
    """
    base, changes = None, []
    for text in overrides:
        found = assigned(single(text))
        if found and found.key == "criteria":
            base = composed([text])["criteria"]
        elif found and found.key.startswith("criteria."):
            changes.append((way(found.key)[1:], found.value))
        else:
            raise InputError(f"{text}: judge takes criteria=CHOICE and criteria.KEY=VALUE alone")
    if base is None and not changes and not none:
        raise InputError(
            "no criteria; such as criteria=landing or criteria.stall_time=2, or --metric"
        )
    return Criteria(base, changes)
