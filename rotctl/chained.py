"""Parts of a chain by what one would write on a command line: `parts: [back_flip, stand]`.

They are composed before the config is checked, so that a run and its log hold the whole of it. A
part brings its behaviour, its criteria, and, where the run's are others by name, its gains and how
its excursion is measured. What was said of it stays beside it: parts of one name may differ.
"""

import shlex
from collections.abc import Callable
from typing import Any

from rotctl.checked import brief
from rotctl.errors import InputError

KIND, SAID = "chain", "said"
MOST = 20  # parts
GAINS = ("supervisor", "thresholds", "contact", "pose", "tasks", "poses", "contacts")
ABOUT = ("behaviour", "catch", "course", "criteria", "finish")  # what of a run a part may say
Composing = Callable[[list[str]], dict[str, Any]]


def composed(data: dict[str, Any], compose: Composing) -> dict[str, Any]:
    """The same with the parts of its chain, if it is one, in full.

    Args:
        data: of a config, not checked yet.
        compose: makes the data of a config from overrides.

    Raises:
        InputError: a part is wrong; one line that names it.
    """
    behaviour = data.get("behaviour")
    if not isinstance(behaviour, dict) or behaviour.get("kind") != KIND:
        return data
    said = behaviour.get("parts")
    if not isinstance(said, list) or not any(isinstance(part, str) for part in said):
        return data
    if len(said) > MOST:
        raise InputError(f"behaviour.parts: has {len(said)} parts, valid: up to {MOST}")
    between = behaviour.get("between")
    made = [_made(f"behaviour.parts[{i}]", part, compose) for i, part in enumerate(said)]
    if between is not None:
        made = _joined(made, _made("behaviour.between", between, compose))
    chain = {key: value for key, value in behaviour.items() if key != "between"}
    data = {**data, "behaviour": {**chain, "parts": [_part(one, data) for one in made]}}
    criteria = data.get("criteria")
    if isinstance(criteria, dict) and criteria.get("kind") == KIND and not criteria.get("parts"):
        data["criteria"] = {**criteria, "parts": [one["criteria"] for one in made]}
    return data


def _joined(made: list[dict[str, Any]], between: dict[str, Any]) -> list[dict[str, Any]]:
    """The configs of the parts, one between any two, but after a part that says when it ends."""
    found = made[:1]
    for before, one in zip(made, made[1:], strict=False):
        stages = before["behaviour"].get("stages") or [{}]
        found += [one] if stages[-1].get("until") else [between, one]
    return found


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
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    if made["behaviour"].get("kind") == KIND:
        raise InputError(f"{where}={brief(said)}: is a chain; name its parts")
    return {**made, SAID: shlex.join([words[0].partition("=")[2], *words[1:]])}


def _part(made: dict[str, Any], data: dict[str, Any]) -> dict[str, Any]:
    part = {"behaviour": made["behaviour"], SAID: made[SAID]}
    if made["controller"].get("name") != data["controller"].get("name"):
        part["gains"] = {key: made["controller"][key] for key in GAINS if key in made["controller"]}
    if made["excursion"].get("name") != data["excursion"].get("name"):
        part["excursion"] = made["excursion"]
    return part
