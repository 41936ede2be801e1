"""One part of a chain, composed of what one would write on a command line for it alone."""

import shlex
from collections.abc import Callable
from dataclasses import fields
from typing import Any

from rotctl.choices import composing, labels
from rotctl.choices.contents import usual
from rotctl.choices.listing import choices
from rotctl.control.settings import Gains
from rotctl.errors import InputError
from rotctl.settings.complaints import brief

KIND, SAID = "chain", "said"
GAINS = tuple(part.name for part in fields(Gains))
GROUPS = ("behaviour", "controller", "criteria", "excursion")  # that make a part
WORLD = ("character", "terrain")  # that a part has from the run
ABOUT = ("behaviour", "catch", "course", "criteria", "finish")  # what of a run a part may say
Composing = Callable[[list[str]], dict[str, Any]]


def made(where: str, said: Any, compose: Composing) -> dict[str, Any]:
    """The config of a part by itself.

    Args:
        where: it stands, for messages; said: what one would write.
        compose: makes the data of a config from overrides.

    Raises:
        InputError: it makes none, or a chain; one line that names it.
    """
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
        found = compose(words)
        labels.require_own_in_files(composing.chosen(words), found)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    for group in GROUPS:
        if not isinstance(found.get(group), dict):
            raise InputError(f"{where}={brief(said)}: leaves no {group}, it must have one")
    if found["behaviour"].get("kind") == KIND:
        raise InputError(f"{where}={brief(said)}: {_instead(found, compose)}")
    return {**found, SAID: shlex.join([words[0].partition("=")[2], *words[1:]])}


def _instead(made: dict[str, Any], compose: Composing) -> str:
    """What to write in place of a chain as a part."""
    parts = made["behaviour"].get("parts")
    names = [part for part in parts if isinstance(part, str)] if isinstance(parts, list) else []
    judged = made["criteria"].get("kind")
    if judged == KIND:
        return "is a chain; name its parts" + f", {', '.join(names)}" * bool(names)
    alike = []
    for choice in filter(choices("behaviour").__contains__, names):
        one = compose([f"behaviour={choice}"]).get("criteria")
        alike += [choice] if isinstance(one, dict) and one.get("kind") == judged else []
    less = f"; {' or '.join(alike)} of them can be one" if alike else ""
    return f"is a chain that is judged as a whole, and no part of another{less}: see docs/chains.md"


def require_here(where: str, part: dict[str, Any], data: dict[str, Any]) -> None:
    """See that the run, of this data, has the world and the body that a part asks for.

    Raises:
        InputError: it has others.
    """
    for group in WORLD:
        asked = name(part, group)
        if asked not in (usual()[group], name(data, group)):
            raise InputError(
                f"{where}: is for {group}={asked}, and the run has {group}={name(data, group)}; "
                f"give the run {group}={asked}"
            )


def require_facing(where: str, part: dict[str, Any], compose: Composing) -> None:
    """See that a later part is not told where to head.

    Raises:
        InputError: it is.
    """
    choice = f"behaviour={shlex.split(part[SAID])[0]}"
    heading, usual = (one["behaviour"].get("heading") for one in (part, compose([choice])))
    if heading not in (None, usual):
        raise InputError(
            f"{where}: behaviour.heading={brief(heading)}: acts on nothing, a later part heads "
            "where the feet point as it begins"
        )


def says_when(behaviour: dict[str, Any]) -> bool:
    """Whether its last stage, or that of a roll's finish, has a condition; not checked yet."""
    finish = behaviour.get("finish")
    stages = (finish if isinstance(finish, dict) else behaviour).get("stages")
    last = stages[-1] if isinstance(stages, list) and stages else None
    return isinstance(last, dict) and bool(last.get("until"))


def settings(part: dict[str, Any], data: dict[str, Any]) -> dict[str, Any]:
    """What of a part's config the chain keeps.

    Args:
        data: of the run, whose gains and excursion it has where it names no others.
    """
    kept = {"behaviour": part["behaviour"], SAID: part[SAID]}
    if part["controller"].get("name") != name(data, "controller"):
        kept["gains"] = {key: part["controller"][key] for key in GAINS if key in part["controller"]}
    if part["excursion"].get("name") != name(data, "excursion"):
        kept["excursion"] = part["excursion"]
    return kept


def name(data: dict[str, Any], group: str) -> Any:
    """Of a group's choice; None without one, which the check tells."""
    chosen = data.get(group)
    return chosen.get("name") if isinstance(chosen, dict) else None
