"""Where the configs lie, and what can be chosen; needs nothing but YAML, so it is quick."""

from pathlib import Path

import yaml

from rotctl.errors import InputError

_NO_GROUPS = {"motion", "tune"}  # folders of conf/ that no config is composed from


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

    The line is the file's `description`, or else the comment that the file opens with.
    """
    found: dict[str, dict[str, str]] = {}
    for path in sorted(conf_dir().glob("*/*.yaml")):
        if path.parent.name in _NO_GROUPS:
            continue
        text = path.read_text(encoding="utf-8")
        description = (yaml.safe_load(text) or {}).get("description") or _first_comment(text)
        found.setdefault(path.parent.name, {})[path.stem] = str(description)
    return found


def _first_comment(text: str) -> str:
    """The first line of the comment that a file opens with, less Hydra's own `@package`."""
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        if not line.startswith("# @"):
            return line.removeprefix("#").strip()
    return ""
