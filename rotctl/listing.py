"""Where the configs lie, what can be chosen, and whether it is plain; needs YAML alone: quick."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rotctl import documents, files, plain
from rotctl.errors import InputError

_NO_GROUPS = {"motion", "tune"}  # folders of conf/ that no config is composed from
MOST_VALUES = 20_000  # of a file; Hydra takes seconds for as many
_DEFAULT = re.compile(r"(?:override )?/?(\w+)(?:@[\w.]+)?")  # a group in a list of defaults


def conf_dir() -> Path:
    """The folder of configs.

    Raises:
        InputError: there is none.
    """
    return shipped("conf", "config.yaml")


def shipped(name: str, holds: str = "*.yaml") -> Path:
    """A folder that comes with rotctl: inside an installed package, else beside a checkout's.

    Args:
        holds: a pattern that at least one file in it fits.

    Raises:
        InputError: there is none.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / name, package.parent / name):
        if any(folder.glob(holds)):
            return folder
    raise InputError(f"no {name}/{holds} in {package} or beside it; reinstall rotctl")


def choices(group: str) -> list[str]:
    """The choices of a config group, sorted; empty if there is no such group."""
    if not group.isidentifier() or group in _NO_GROUPS:
        return []
    return sorted(path.stem for path in (conf_dir() / group).glob("*.yaml"))


def groups() -> dict[str, dict[str, str]]:
    """Config groups to their choices to a line of description each, sorted.

    The line is the file's `description`, or else the comment that the file opens with; or what
    is wrong with the file.
    """
    found: dict[str, dict[str, str]] = {}
    for path in sorted(conf_dir().glob("*/*.yaml")):
        if path.parent.name not in _NO_GROUPS:
            found.setdefault(path.parent.name, {})[path.stem] = _described(path)
    return found


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
            waiting += _defaults(conf_dir() / group / f"{name}.yaml")


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
            if not match or name not in choices(match[1]):
                raise InputError(f"{path}: defaults: {key}: {name}: no such choice of a group")
            pairs.append((match[1], name))
    return pairs


def _described(path: Path) -> str:
    try:
        description = content(path).get("description")
        text = files.text(path, documents.LARGEST, linked=True)
        return " ".join(str(description or _first_comment(text)).split())
    except InputError as error:
        return f"cannot be used: {error}"


def _first_comment(text: str) -> str:
    """The first line of the comment that a file opens with, less Hydra's own `@package`."""
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        if not line.startswith("# @"):
            return line.removeprefix("#").strip()
    return ""
