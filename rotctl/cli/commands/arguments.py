"""Kinds of arguments that several commands take."""

import argparse
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from rotctl.cli.wording import one_line
from rotctl.errors import InputError, LogError

if TYPE_CHECKING:
    from rotctl.log import RunLog

LOG_NAME = "run.h5"  # rotctl.log's, which takes a while to import
INTERRUPTED_NAME = "interrupted.h5"  # rotctl.runs.folder's
IS_ID = re.compile("[0-9a-f]{12}")
FRAMES = 12  # of a filmstrip, two rows of six
RUNS = Path("runs")  # where runs go unless somebody says otherwise

# Where a command is added; argparse has no public name for it.
Commands: TypeAlias = "argparse._SubParsersAction[Any]"

OVERRIDES_HELP = (
    "config overrides in Hydra's syntax, such as seed=3 (see rotctl list and show), and @FILE.yaml "
    "of such"
)
LOG_HELP = "a log, the folder of its run, or its id in runs/"


def path_name(text: str) -> Path:
    """A file or a folder, which need not be there; an empty name would be the folder one is in."""
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)


def run_folder(path: Path) -> Path:
    """A path as it is; where nothing lies there, but a run of that id in `runs`, its folder."""
    there = os.path.lexists(path) or not os.path.lexists(RUNS / path / LOG_NAME)
    return path if there else RUNS / path


def log_file(path: Path) -> Path:
    """The path of a log, which may be named by the folder of its run, or by its id in `runs`.

    Raises:
        InputError: it is a folder without a log, or an id of a run that is not in `runs`.
    """
    path = run_folder(path)
    if not os.path.isdir(path):
        if IS_ID.fullmatch(str(path)) and not os.path.lexists(path):
            raise InputError(
                f"{path}: no such file, and no run of that id in {RUNS}; write the folder that it "
                f"is in before it, as in sweeps/mine/{path}"
            )
        return path
    if not os.path.lexists(path / LOG_NAME):
        if os.path.lexists(path / INTERRUPTED_NAME):
            raise InputError(
                f"{path}: was interrupted and is no run; its beginning is {path / INTERRUPTED_NAME}"
            )
        raise InputError(
            f"{path}: is a folder without {LOG_NAME}; name a run, its folder or the log in it; "
            f"rotctl ls {path} lists them"
        )
    return path / LOG_NAME


def opened_log(path: Path) -> "RunLog":
    """The log that a user names, see `log_file`; that its content was changed is said on stderr.

    Raises:
        InputError: there is none.
        LogError: it cannot be opened.
    """
    from rotctl.log import RunLog

    log = RunLog.open(log_file(path))
    try:
        log.verify()
    except LogError as error:
        print(f"rotctl: {one_line(str(error))}; taken as it is", file=sys.stderr)
    return log


def second(text: str) -> float:
    """A time [s]."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r}: must be a time [s]; for another format see rotctl export"
        ) from None


def name_and_text(text: str) -> tuple[str, str]:
    """top=max(com[:, 2]): a name, and what it stands for."""
    name, equals, rest = text.partition("=")
    if not name.strip() or not equals or not rest.strip():
        raise argparse.ArgumentTypeError(f"{text!r}: write NAME=EXPRESSION")
    return name.strip(), rest


def keys(text: str) -> list[str]:
    """behaviour,controller: columns."""
    if not text:
        raise argparse.ArgumentTypeError("names no column")
    return text.split(",")


def role_and_name(text: str) -> tuple[str, str]:
    """left_hip=Bone_7: which joint or body is what."""
    from rotctl.motion.naming import ROLES

    role, equals, joint = text.partition("=")
    if role not in ROLES or not equals:
        raise argparse.ArgumentTypeError(f"{text!r}: valid: ROLE=NAME, of {', '.join(ROLES)}")
    return role, joint
