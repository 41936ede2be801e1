"""What is in a file of configs, and whether it is plain; needs YAML alone: quick."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rotctl.choices.config_folders import conf_dir
from rotctl.choices.listing import choices, instead_of, named_file
from rotctl.errors import InputError
from rotctl.settings import documents, plain
from rotctl.suggestion import meant

MOST_VALUES = 20_000  # of a file; Hydra takes seconds for as many
_DEFAULT = re.compile(r"(?:override )?/?(\w+)(?:@[\w.]+)?")  # a group in a list of defaults


def require_plain(chosen: Iterable[tuple[str, str]]) -> None:
    """Check the files that a config is composed from, before Hydra reads them.

    Args:
        chosen: groups and their choices, beside those that the files bring themselves.

    Raises:
        InputError: one is wrong, or would have something looked up; one line that names it.
    """
    waiting, seen = [("", "config"), *chosen], set()
    while waiting:
        group, name = waiting.pop()
        if (group, name) not in seen:
            seen.add((group, name))
            waiting += _defaults(named_file(group, name) if group else conf_dir() / "config.yaml")


def content(path: Path) -> dict[str, Any]:
    """The data of a file of conf/.

    Raises:
        InputError: it is wrong, or would have something looked up; one line that names it.
    """
    data = documents.read_yaml(path, MOST_VALUES, linked=True) or {}
    if not isinstance(data, dict):
        raise InputError(f"{path}: must be keys with values")
    for parts, value in plain.leaves(data):
        where = plain.dotted(parts)
        if "${" in where or isinstance(value, str) and "${" in value:
            raise InputError(f"{path}: {where}: interpolations are not honoured; give a value")
    return data


def usual() -> dict[str, str]:
    """Config groups to what they are where nobody chooses; a behaviour may bring others."""
    entries = content(conf_dir() / "config.yaml")["defaults"]
    return {group: name for entry in entries if entry != "_self_" for group, name in entry.items()}


def _defaults(path: Path) -> list[tuple[str, str]]:
    """The choices that a file brings."""
    data = content(path)
    found = data.get("defaults", [])
    if not isinstance(found, list):
        raise InputError(f"{path}: defaults: must be a list, in brackets")
    pairs = []
    for entry in found:
        named = entry if isinstance(entry, dict) else {path.parent.name: entry}
        for key, name in named.items() if entry != "_self_" else ():
            match = _DEFAULT.fullmatch(key)
            valid = choices(match[1]) if match else []
            if not match or name not in valid:
                hint = instead_of(match[1], name, meant(name, valid)) if match else ""
                raise InputError(
                    f"{path}: defaults: {key}: {name}: no such choice of a group{hint and '; '}"
                    f"{hint.rstrip()}"
                )
            pairs.append((match[1], name))
    return pairs
