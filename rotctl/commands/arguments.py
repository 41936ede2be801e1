"""Kinds of arguments that several commands take."""

import argparse
import os
from pathlib import Path
from typing import Any, TypeAlias

from rotctl.errors import InputError

# Where a command is added; argparse has no public name for it.
Commands: TypeAlias = "argparse._SubParsersAction[Any]"

OVERRIDES_HELP = "config overrides in Hydra's syntax, such as seed=3 (see rotctl list and show)"


def folder_name(text: str) -> Path:
    """A folder that need not be there yet."""
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)


def log_file(path: Path) -> Path:
    """The same path.

    Raises:
        InputError: it is a folder.
    """
    if os.path.isdir(path):
        raise InputError(f"{path}: is a folder; name the log in it, such as {path / 'run.h5'}")
    return path


def role_and_name(text: str) -> tuple[str, str]:
    """left_hip=Bone_7: which joint or body is what."""
    from rotctl.motion.naming import ROLES

    role, equals, joint = text.partition("=")
    if role not in ROLES or not equals:
        raise argparse.ArgumentTypeError(f"{text!r}: valid: ROLE=NAME, of {', '.join(ROLES)}")
    return role, joint
