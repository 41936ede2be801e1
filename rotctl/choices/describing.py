"""A line on everything that can be chosen, and on what of the user's files nobody can choose."""

from pathlib import Path

from rotctl import files
from rotctl.choices.config_folders import conf_dir, own_dir
from rotctl.choices.contents import content
from rotctl.choices.listing import (
    EXPERIMENTS,
    group_names,
    instead_of,
    misnamed,
    named_file,
    named_files,
    unfit,
)
from rotctl.errors import InputError
from rotctl.settings import documents

_NAMED_ALONE = {"tune", EXPERIMENTS}  # by no value of Hydra's


def groups() -> dict[str, dict[str, str]]:
    """Config groups to their choices to a line of description each, sorted.

    The line is the file's `description`, or else the comment that the file opens with, or its
    title; or what is wrong with the file.
    """
    return {group: described(group) for group in group_names()}


def described(folder: str) -> dict[str, str]:
    """Names in a folder of configs to a line of description each, see `groups`; sorted."""
    found = {name: _described(path) for name, path in named_files(folder).items()}
    for name in misnamed(folder).keys() - found.keys():
        found[name] = f"cannot be used: {instead_of(folder, name, '')}"
    return dict(sorted(found.items()))


def strays() -> dict[str, Path]:
    """Name -> folder of configs among the user's that is of no group, so that nobody reads it."""
    mine = own_dir()
    known = {path.name for path in conf_dir().iterdir()} | {EXPERIMENTS}
    found = sorted(path.parent for path in mine.glob("*/*.y*ml")) if mine else []
    return {path.name: path for path in found if path.name not in known and path.name[0] != "."}


def _described(path: Path) -> str:
    try:
        named_file(path.parent.name, path.stem)  # of which there must be one
        wrong = unfit(path.stem) if path.parent.name not in _NAMED_ALONE else ""
        if wrong:
            raise InputError(f"{wrong}; give it another name")
        data = content(path)
        text = files.text(path, documents.LARGEST, linked=True)
        told = data.get("description") or _first_comment(text)
        told = told or data.get("title") or data.get("file", "")  # of an experiment; of a model
        called = data.get("name", path.stem)
        told = f"{told} (its runs say {called})" if called != path.stem else told
        return " ".join(str(told).split())
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
