"""Where the configs lie, and what can be chosen; needs nothing but YAML, so it is quick."""

from pathlib import Path

import yaml

from rotctl.errors import InputError


def conf_dir() -> Path:
    """The folder of configs: inside an installed package, else beside it in a checkout.

    Raises:
        InputError: there is none.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "conf", package.parent / "conf"):
        if (folder / "config.yaml").is_file():
            return folder
    raise InputError(f"no conf/config.yaml in {package} or beside it; reinstall rotctl")


def choices(group: str) -> list[str]:
    """The choices of a config group, sorted; empty if there is no such group."""
    if not group.isidentifier():
        return []
    return sorted(path.stem for path in (conf_dir() / group).glob("*.yaml"))


def groups() -> dict[str, dict[str, str]]:
    """Config groups to their choices to a line of description each, sorted.

    The line is the file's `description`, or else the comment that the file opens with.
    """
    found: dict[str, dict[str, str]] = {}
    for path in sorted(conf_dir().glob("*/*.yaml")):
        text = path.read_text(encoding="utf-8")
        description = (yaml.safe_load(text) or {}).get("description") or _first_comment(text)
        found.setdefault(path.parent.name, {})[path.stem] = str(description)
    return found


def _first_comment(text: str) -> str:
    first = text.partition("\n")[0]
    return first.removeprefix("#").strip() if first.startswith("#") else ""
