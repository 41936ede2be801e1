"""Where the configs lie, what can be chosen, and whether it is plain; needs YAML alone: quick.

Beside what comes with rotctl the user may have a folder of configs of the same form. Which one is
in the environment, so that workers have the same. A `./conf` counts by itself only with a
`rotctl.yaml` in it: many a program keeps its own configs in a folder of that name.
"""

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rotctl.errors import InputError
from rotctl.settings import documents, plain
from rotctl.suggestion import meant

OWN = "ROTCTL_CONFIG_DIR"
EXPERIMENTS = "experiments"  # beside conf/, where it comes with rotctl
MARK = "rotctl.yaml"  # in a folder of configs that is the user's
NO_GROUPS = ("motion", "tune", EXPERIMENTS)  # folders of conf/ that no config is composed from
MOST_VALUES = 20_000  # of a file; Hydra takes seconds for as many
_CHOICE = re.compile(r"\w([\w. -]*[\w.-])?", re.ASCII)  # what Hydra reads as one value
_NUMBER = re.compile(r"[\d_.]+(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
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
    package = Path(__file__).resolve().parents[1]
    for folder in (package / name, package.parent / name):
        if any(folder.glob(holds)):
            return folder
    raise InputError(f"no {name}/{holds} in {package} or beside it; reinstall rotctl")


def own_dir() -> Path | None:
    """The user's folder of configs, if there is one."""
    named = os.environ.get(OWN)
    return Path(named) if named else None


@contextmanager
def own(folder: Path | None) -> Iterator[None]:
    """While it lasts, a folder is the user's; without one, a `./conf` that is marked.

    Raises:
        InputError: there is no such folder.
    """
    before = os.environ.get(OWN)
    usual = not before and Path("conf", MARK).is_file() and not is_shipped(Path("conf"))
    found = folder or (Path("conf") if usual else None)
    if found:
        if not found.is_dir():
            raise InputError(f"--config-dir={found}: no such folder")
        os.environ[OWN] = str(found.resolve())
    try:
        yield
    finally:
        if found:
            os.environ.pop(OWN)
            os.environ.update({OWN: before} if before else {})


def is_shipped(folder: Path) -> bool:
    """Whether it is rotctl's own folder of configs, as in a clone of it."""
    return folder.is_dir() and folder.samefile(conf_dir())


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


def folders() -> tuple[Path, ...]:
    """Where configs lie: rotctl's, then the user's."""
    return tuple(filter(None, (conf_dir(), own_dir())))


def is_own(path: Path) -> bool:
    """Whether a file is of the user's folder."""
    mine = own_dir()
    return mine is not None and path.is_relative_to(mine)


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
