"""What can be chosen: names of files of configs, rotctl's and the user's of the same form."""

import os
import re
from pathlib import Path

from rotctl.choices.config_folders import conf_dir, own_dir
from rotctl.errors import InputError

EXPERIMENTS = "experiments"  # beside conf/, where it comes with rotctl
NO_GROUPS = ("motion", "tune", EXPERIMENTS)  # folders of conf/ that no config is composed from
_CHOICE = re.compile(r"\w([\w. -]*[\w.-])?", re.ASCII)  # what Hydra reads as one value
_NUMBER = re.compile(r"[\d_.]+(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)


def named_files(folder: str) -> dict[str, Path]:
    """Name -> file of a folder of configs, what comes with rotctl and then the user's.

    Args:
        folder: a group, or `motion`, `tune`, `experiments`.
    """
    mine = own_dir()
    found = shipped_files(folder)
    for name, path in _files(mine / folder).items() if mine else ():
        found.setdefault(name, path)
    return found


def shipped_files(folder: str) -> dict[str, Path]:
    """As `named_files`, of what comes with rotctl alone, and is never wrong."""
    place = conf_dir().parent if folder == EXPERIMENTS else conf_dir()
    return _files(place / folder)


def _files(place: Path) -> dict[str, Path]:
    paths = sorted(place.glob("*.yaml"))
    return {path.stem: path for path in paths if not path.name.startswith(".")}  # editors' locks


def misnamed(folder: str) -> dict[str, Path]:
    """As `named_files`, of the user's that nobody can choose, as they end in `.yml`, say."""
    mine = own_dir()
    paths = sorted((mine / folder).glob("*.*")) if mine else []
    odd = [path for path in paths if path.suffix.lower() in (".yml", ".yaml")]
    return {path.stem: path for path in odd if path.suffix != ".yaml" and path.stem[0] != "."}


def instead_of(folder: str, name: object, valid: str) -> str:
    """For a name that is none: `valid`, or how a file of the user's must be called."""
    path = misnamed(folder).get(name) if isinstance(name, str) else None
    return f"{path} must be called {path.stem}.yaml" if path else valid


def named_file(folder: str, name: str) -> Path:
    """The file of a name, which may not be there.

    Raises:
        InputError: rotctl has one of that name, and the user too.
    """
    found = named_files(folder).get(name, conf_dir() / folder / f"{name}.yaml")
    mine = own_dir()
    if mine and found != mine / folder / found.name and (mine / folder / found.name).exists():
        raise InputError(
            f"{mine / folder / found.name}: rotctl has one of that name; give yours another"
        )
    return found


def unfit(name: str) -> str:
    """Why nobody can choose a name, as YAML or Hydra takes it for something else; mostly empty."""
    if name.lower() in ("true", "false", "yes", "no", "on", "off", "null", "inf", "nan"):
        return f"YAML takes {name} for something else"
    if _NUMBER.fullmatch(name):
        return f"YAML takes {name} for a number"
    if not _CHOICE.fullmatch(name):
        return "a choice is called by plain letters, digits and _ - ."
    return ""


def choices(group: str) -> list[str]:
    """The choices of a config group, sorted; empty if there is no such group.

    Args:
        group: also as it is written to add a choice to a config, `+finish`.
    """
    group = group.removeprefix("+")
    known = group.isidentifier() and group not in NO_GROUPS
    if not known or not os.path.isdir(conf_dir() / group):  # of a name of any length
        return []
    return sorted(name for name in named_files(group) if not unfit(name))


def group_names() -> list[str]:
    """The config groups, sorted."""
    return sorted({path.parent.name for path in conf_dir().glob("*/*.yaml")}.difference(NO_GROUPS))
