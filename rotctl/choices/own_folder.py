"""A file of one's own, begun as a copy of one that there is."""

import re
from pathlib import Path

from rotctl import __version__, files
from rotctl.choices.config_folders import MARK, is_shipped, own_dir
from rotctl.choices.listing import (
    NO_GROUPS,
    group_names,
    instead_of,
    named_file,
    named_files,
    shipped_files,
    unfit,
)
from rotctl.errors import InputError
from rotctl.settings import documents
from rotctl.suggestion import instead

MARKED = """\
# Your own configs for rotctl: behaviour/, character/, terrain/, start/, ..., clips in motion/,
# search spaces in tune/, experiments in experiments/. rotctl takes this folder, ./conf, by itself
# because this file is in it, and any other by --config-dir. Nothing in it is executed.
"""
_NAME = re.compile(r"^name: .*$", re.MULTILINE)


def kinds() -> list[str]:
    """The folders that a file of one's own may be in."""
    return [*group_names(), *NO_GROUPS]


def make(kind: str, name: str, source: str) -> Path:
    """Copy a choice, with its comments, under another name into the user's folder.

    Args:
        kind: one of `kinds()`.
        source: the choice that is copied, rotctl's or the user's.

    Raises:
        InputError: there is no such choice, or one of that name already; nothing is written.
    """
    path, there = free(kind, name), named_files(kind)
    if source not in there:
        what = "start or run" if kind == "start" else kind
        raise InputError(
            f"--from={source}: no such {what}; {instead_of(kind, source, instead(source, there))}"
        )
    text = files.text(named_file(kind, source), documents.LARGEST, linked=True)
    text = _NAME.sub(f"name: {name}", text, count=1)
    copied = f"# Copied from {kind}/{source} of rotctl {__version__}.\n"
    return write(path, text if text.startswith("# @") else copied + text)


def free(kind: str, name: str) -> Path:
    """Where a file of that name goes in the user's folder.

    Raises:
        InputError: there is one of that name already, or it can be none.
    """
    if kind not in kinds():
        raise InputError(f"{kind}: no such kind of file; {instead(kind, kinds())}")
    if not re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII):
        raise InputError(f"{name}: must be letters, digits and _, a letter first")
    if wrong := unfit(name):
        raise InputError(f"{name}: {wrong}; give another name")
    there = named_files(kind)
    if name in there:
        raise InputError(f"{name}: there is a {kind} of that name: {there[name]}")
    mine, here = own_dir() or Path("conf"), Path.cwd()
    return (mine.relative_to(here) if mine.is_relative_to(here) else mine) / kind / f"{name}.yaml"


def require_own_name(kind: str, path: Path) -> None:
    """See that a file that goes into the user's folder is called as none that comes with rotctl.

    Raises:
        InputError: it is, or as no choice can be; nobody could choose it.
    """
    if not _is_found(kind, path):
        return
    if wrong := unfit(path.stem):
        raise InputError(f"{path}: {wrong}; give another name")
    if path.stem in shipped_files(kind):
        raise InputError(
            f"{path}: there is a {kind} of that name that comes with rotctl; give yours another"
        )


def put(kind: str, path: Path, text: str) -> None:
    """Write a file of some kind wherever the user says, if that is their folder as one of it."""
    if _is_found(kind, path):
        write(path, text)
        return
    with files.folder(path.parent, linked=True):
        files.replace(path, files.encoded(text))


def _is_found(kind: str, path: Path) -> bool:
    """Whether a file is where the user's choices are looked for, once the folder is marked."""
    mine = own_dir() or (None if is_shipped(Path("conf")) else Path("conf"))
    return mine is not None and path.parent.resolve() == (mine / kind).resolve()


def write(path: Path, text: str) -> Path:
    """Write a file of the user's folder, which is marked as one."""
    folder = path.parent.parent
    with files.folder(path.parent, linked=True):
        if own_dir() is None and not is_shipped(folder) and not (folder / MARK).exists():
            files.replace(folder / MARK, MARKED.encode())
        files.replace(path, files.encoded(text))
    return path
