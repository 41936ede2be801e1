"""What a run is called: each choice has a `name`, which says what it is and makes nothing of it."""

from collections.abc import Callable, Iterable
from typing import Any

from rotctl.choices.config_folders import is_own
from rotctl.choices.listing import choices, named_file
from rotctl.errors import InputError
from rotctl.settings import plain

NAME = "name"


def require_own(assigned: Iterable[tuple[str, Any]], chosen: Callable[[], Any]) -> None:
    """See that no choice is given the name of another one of its group.

    Args:
        assigned: keys and the values that they are set to, choices among them.
        chosen: makes the data of a config of the choices alone, whose names they may keep.

    Raises:
        InputError: one is; one line that names it and what was probably meant.
    """
    every = [
        (plain.dotted((key.lstrip("+"), *inner)), each)
        for key, value in assigned
        for inner, each in plain.leaves(value)
    ]
    for key, value in every:
        group, _, rest = key.partition(".")
        taken = rest == NAME and value in choices(group) and (group, value) not in every
        if taken and plain.find(chosen(), (group, NAME)) != value:
            raise InputError(
                f"{key}={value}: would only call it so, and that is another {group}; "
                f"write {group}={value}, or a name of your own"
            )


def require_own_in_files(chosen: Iterable[tuple[str, Any]], data: dict[str, Any]) -> None:
    """See that no file of the user's calls its choice by the name of another one.

    Args:
        chosen: groups with their choices.
        data: of the config that they made.

    Raises:
        InputError: as for `require_own`, with the file.
    """
    for group, choice in dict(chosen).items():  # of two for a group the later one counts
        path = named_file(group, choice)
        part = data.get(group)
        name = part.get(NAME) if is_own(path) and isinstance(part, dict) else choice
        if name != choice and name in choices(group):
            raise InputError(f"{path}: name: {name}: is another {group}; write name: {choice}")
