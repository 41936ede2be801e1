"""Where the configs lie: those that come with rotctl, and beside them the user's.

Which folder is the user's is in the environment, so that workers have the same. A `./conf` counts
by itself only with a `rotctl.yaml` in it: many a program keeps its own configs in a folder of that
name.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rotctl.errors import InputError

OWN = "ROTCTL_CONFIG_DIR"
MARK = "rotctl.yaml"  # in a folder of configs that is the user's


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


def folders() -> tuple[Path, ...]:
    """Where configs lie: rotctl's, then the user's."""
    return tuple(filter(None, (conf_dir(), own_dir())))


def is_own(path: Path) -> bool:
    """Whether a file is of the user's folder."""
    mine = own_dir()
    return mine is not None and path.is_relative_to(mine)
