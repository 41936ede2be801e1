"""Parts of a chain by what one would write on a command line: `parts: [back_flip, stand]`.

They are composed before the config is checked, so that a run and its log hold the whole of it. A
part brings its behaviour, its criteria, and, where the run's are others by name, its gains and how
its excursion is measured. What was said of it stays beside it: parts of one name may differ.
"""

import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

from rotctl.choices import composing, labels
from rotctl.choices.contents import usual
from rotctl.choices.listing import choices
from rotctl.control.settings import Gains
from rotctl.errors import InputError
from rotctl.settings import plain
from rotctl.settings.complaints import brief, clip
from rotctl.settings.fields import MOST_PARTS

KIND, SAID = "chain", "said"
GAINS = tuple(part.name for part in fields(Gains))
GROUPS = ("behaviour", "controller", "criteria", "excursion")  # that make a part
WORLD = ("character", "terrain")  # that a part has from the run
ABOUT = ("behaviour", "catch", "course", "criteria", "finish")  # what of a run a part may say
_OF_A_PART = re.compile(r"behaviour\.parts\.(\d+)\.(?=behaviour\b)")
Composing = Callable[[list[str]], dict[str, Any]]


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
    made = [_made(f"behaviour.parts.{i}", part, compose) for i, part in enumerate(said)]
    for number, one in enumerate(made):
        _require_here(f"behaviour.parts.{number}={brief(said[number])}", one, data)
        if number:
            _require_facing(f"behaviour.parts.{number}", one, compose)
    if between is not None and chain.get("ways"):
        raise InputError(
            f"behaviour.between={brief(between)}: behaviour.ways numbers the parts, and what goes "
            "between would shift them; give null"
        )
    if between is not None:
        made = _joined(made, _made("behaviour.between", between, compose))
    _require_few(len(said), len(made) - len(said))
    data = {**data, "behaviour": {**chain, "parts": [_part(one, data) for one in made]}}
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
        found += [one] if _says_when(before["behaviour"]) else [between, one]
    return found


def _says_when(behaviour: dict[str, Any]) -> bool:
    """Whether its last stage, or that of a roll's finish, has a condition; not checked yet."""
    finish = behaviour.get("finish")
    stages = (finish if isinstance(finish, dict) else behaviour).get("stages")
    last = stages[-1] if isinstance(stages, list) and stages else None
    return isinstance(last, dict) and bool(last.get("until"))


def _made(where: str, said: Any, compose: Composing) -> dict[str, Any]:
    """The config of a part by itself."""
    if not isinstance(said, str):
        raise InputError(f"{where}={brief(said)}: must be a text, such as back_flip")
    try:
        words = shlex.split(said)
    except ValueError as error:
        raise InputError(f"{where}={brief(said)}: {error}") from None
    if words and "=" not in words[0]:
        words[0] = f"behaviour={words[0]}"
    if not words or not words[0].startswith("behaviour="):
        raise InputError(
            f"{where}={brief(said)}: must begin with a behaviour, back_flip or behaviour=back_flip"
        )
    for word in words:
        key = word.partition("=")[0].lstrip("+~").partition(".")[0]
        if key not in ABOUT:
            raise InputError(f"{where}: {brief(word)}: a part may say {', '.join(ABOUT)}")
    try:
        made = compose(words)
        labels.require_own_in_files(composing.chosen(words), made)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    for group in GROUPS:
        if not isinstance(made.get(group), dict):
            raise InputError(f"{where}={brief(said)}: leaves no {group}, it must have one")
    if made["behaviour"].get("kind") == KIND:
        raise InputError(f"{where}={brief(said)}: {_instead(made, compose)}")
    return {**made, SAID: shlex.join([words[0].partition("=")[2], *words[1:]])}


def _instead(made: dict[str, Any], compose: Composing) -> str:
    """What to write in place of a chain as a part."""
    parts = made["behaviour"].get("parts")
    names = [part for part in parts if isinstance(part, str)] if isinstance(parts, list) else []
    judged = made["criteria"].get("kind")
    if judged == KIND:
        return "is a chain; name its parts" + f", {', '.join(names)}" * bool(names)
    alike = []
    for name in filter(choices("behaviour").__contains__, names):
        one = compose([f"behaviour={name}"]).get("criteria")
        alike += [name] if isinstance(one, dict) and one.get("kind") == judged else []
    less = f"; {' or '.join(alike)} of them can be one" if alike else ""
    return f"is a chain that is judged as a whole, and no part of another{less}: see docs/chains.md"


def _require_here(where: str, made: dict[str, Any], data: dict[str, Any]) -> None:
    """See that the run has the world and the body that a part's behaviour asks for."""
    for group in WORLD:
        asked = _name(made, group)
        if asked not in (usual()[group], _name(data, group)):
            raise InputError(
                f"{where}: is for {group}={asked}, and the run has {group}={_name(data, group)}; "
                f"give the run {group}={asked}"
            )


def _require_facing(where: str, made: dict[str, Any], compose: Composing) -> None:
    """See that no later part is told where to head."""
    choice = f"behaviour={shlex.split(made[SAID])[0]}"
    heading, usual = (one["behaviour"].get("heading") for one in (made, compose([choice])))
    if heading not in (None, usual):
        raise InputError(
            f"{where}: behaviour.heading={brief(heading)}: acts on nothing, a later part heads "
            "where the feet point as it begins"
        )


def _require_taken(data: dict[str, Any], overrides: Sequence[str], compose: Composing) -> None:
    """See that gains and an excursion that the run is told are those of some part."""
    parts = data["behaviour"]["parts"]
    for group, own in (("controller", "gains"), ("excursion", "excursion")):
        if not isinstance(data.get(group), dict) or not all(own in part for part in parts):
            continue
        names = ", ".join(dict.fromkeys(str(_name(part, "behaviour")) for part in parts))
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


def _part(made: dict[str, Any], data: dict[str, Any]) -> dict[str, Any]:
    part = {"behaviour": made["behaviour"], SAID: made[SAID]}
    if made["controller"].get("name") != _name(data, "controller"):
        part["gains"] = {key: made["controller"][key] for key in GAINS if key in made["controller"]}
    if made["excursion"].get("name") != _name(data, "excursion"):
        part["excursion"] = made["excursion"]
    return part


def _name(data: dict[str, Any], group: str) -> Any:
    """Of a group's choice; None without one, which the check tells."""
    chosen = data.get(group)
    return chosen.get("name") if isinstance(chosen, dict) else None
