"""Parts of a chain by what one would write on a command line: `parts: [back_flip, stand]`.

They are composed before the config is checked, so that a run and its log hold the whole of it. A
part brings its behaviour, its criteria, and, where the run's are others by name, its gains and how
its excursion is measured. What was said of it stays beside it: parts of one name may differ.
"""

import re
from collections.abc import Sequence
from typing import Any

from rotctl.config import chain_part
from rotctl.config.chain_part import GAINS, KIND, SAID, Composing
from rotctl.errors import InputError
from rotctl.settings import plain
from rotctl.settings.complaints import brief, clip
from rotctl.settings.fields import MOST_PARTS

_OF_A_PART = re.compile(r"behaviour\.parts\.(\d+)\.(?=behaviour\b)")


def composed(
    data: dict[str, Any], compose: Composing, overrides: Sequence[str] = ()
) -> dict[str, Any]:
    """The same with the parts of its chain, if it is one, in full.

    Args:
        data: of a config, not checked yet.
        compose: makes the data of a config from overrides.
        overrides: that it was made of.

    Raises:
        InputError: a part is wrong; one line that names it.
    """
    behaviour = data.get("behaviour")
    if not isinstance(behaviour, dict) or behaviour.get("kind") != KIND:
        return data
    chain = {key: value for key, value in behaviour.items() if key != "between"}
    said, between = chain.get("parts"), behaviour.get("between")
    if not isinstance(said, list) or not any(isinstance(part, str) for part in said):
        full = isinstance(said, list) and any(isinstance(part, dict) for part in said)
        if full and between is not None:
            raise InputError(
                f"behaviour.between={brief(between)}: goes between parts that are texts, and these "
                "are in full; give null"
            )
        return {**data, "behaviour": chain}
    _require_few(len(said), 0)
    made = [chain_part.made(f"behaviour.parts.{i}", part, compose) for i, part in enumerate(said)]
    for number, one in enumerate(made):
        chain_part.require_here(f"behaviour.parts.{number}={brief(said[number])}", one, data)
        if number:
            chain_part.require_facing(f"behaviour.parts.{number}", one, compose)
    if between is not None and chain.get("ways"):
        raise InputError(
            f"behaviour.between={brief(between)}: behaviour.ways numbers the parts, and what goes "
            "between would shift them; give null"
        )
    if between is not None:
        made = _joined(made, chain_part.made("behaviour.between", between, compose))
    _require_few(len(said), len(made) - len(said))
    parts = [chain_part.settings(one, data) for one in made]
    data = {**data, "behaviour": {**chain, "parts": parts}}
    _require_taken(data, overrides, compose)
    criteria = data.get("criteria")
    if isinstance(criteria, dict) and criteria.get("kind") == KIND and not criteria.get("parts"):
        data["criteria"] = {**criteria, "parts": [one["criteria"] for one in made]}
    return data


def told(complaint: str, data: dict[str, Any]) -> str:
    """A complaint about a part by what was said of it, with the keys that may be said there.

    Args:
        data: of the whole config.
    """
    match = _OF_A_PART.match(complaint)
    said = plain.find(data, ("behaviour", "parts", int(match[1]), SAID)) if match else None
    if not match or not isinstance(said, str):
        return complaint
    return f"behaviour.parts: {clip(said)!r}: {complaint[match.end() :]}"


def _require_few(said: int, between: int) -> None:
    if said + between > MOST_PARTS:
        more = f" and behaviour.between adds {between}" if between else ""
        raise InputError(
            f"behaviour.parts: has {said} parts{more}, valid: up to {MOST_PARTS} in all"
        )


def _joined(made: list[dict[str, Any]], between: dict[str, Any]) -> list[dict[str, Any]]:
    """The configs of the parts, one between any two, but after a part that says when it ends."""
    found = made[:1]
    for before, one in zip(made, made[1:], strict=False):
        found += [one] if chain_part.says_when(before["behaviour"]) else [between, one]
    return found


def _require_taken(data: dict[str, Any], overrides: Sequence[str], compose: Composing) -> None:
    """See that gains and an excursion that the run is told are those of some part."""
    parts = data["behaviour"]["parts"]
    for group, own in (("controller", "gains"), ("excursion", "excursion")):
        if not isinstance(data.get(group), dict) or not all(own in part for part in parts):
            continue
        names = ", ".join(dict.fromkeys(str(chain_part.name(part, "behaviour")) for part in parts))
        bring = "bring their" if ", " in names else "brings its"
        for override in overrides:
            key = override.lstrip("+~").partition("=")[0]
            others = [one for one in overrides if one != override]
            if key.partition(".")[0] == group and _same(data, others, group, compose):
                raise InputError(f"{override}: acts on nothing, {names} {bring} own {own}")


def _same(data: dict[str, Any], others: list[str], group: str, compose: Composing) -> bool:
    """Whether other overrides make what acts of a group where every part brings its own."""
    if group == "excursion":  # nothing of it
        return True
    try:
        without = compose(others)
    except InputError:  # they build on what is left out
        return False
    return _left(data[group]) == _left(without[group])


def _left(controller: dict[str, Any]) -> dict[str, Any]:
    """What of a controller acts whatever gains the parts bring."""
    aside = ("name", "description", *GAINS)
    return {key: value for key, value in controller.items() if key not in aside}
