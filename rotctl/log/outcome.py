"""The outcome of a log, which is the summary row of its run: from text to what can be relied on."""

from collections.abc import Mapping
from typing import Any

from rotctl.errors import LogError
from rotctl.settings.json_documents import from_json

LARGE = 1e300  # no number in a summary is, and none is infinite
_NEEDED = {"success": bool, "failure_reason": str, "solver_failures": int}


def outcome_of(text: str) -> dict[str, Any]:
    """Columns to plain values; which columns there are is not looked at.

    Raises:
        LogError: it is not what rotctl writes.
    """
    try:
        outcome = from_json(text)
    except ValueError:
        raise LogError("outcome is not JSON") from None
    if not isinstance(outcome, dict):
        raise LogError("outcome is not a JSON object")
    plain_outcome(outcome)
    return outcome


def plain_outcome(outcome: Mapping[str, Any]) -> None:
    """Check that all values are numbers of a possible size, texts or null.

    Raises:
        LogError: one is not.
    """
    for name, value in outcome.items():
        number = isinstance(value, int | float) and abs(value) < LARGE
        if not (number or value is None or isinstance(value, str)):
            raise LogError(f"outcome has no plain value for {name!r:.60}")


def require_verdict(outcome: Mapping[str, Any]) -> None:
    """Check that an outcome says how its run ended.

    Raises:
        LogError: it does not.
    """
    for name, kind in _NEEDED.items():
        if type(outcome.get(name)) is not kind:
            raise LogError(f"outcome does not say {name}")
