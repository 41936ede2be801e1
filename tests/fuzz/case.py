"""An input on the disk and the command that gets it; what else may lie in the place of a file."""

import os
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Case:
    """An input on the disk, and the command that gets it.

    Attributes:
        simulates: it may compute for as long as it likes, if it can be interrupted.
        conf: the folder of configs; None: our own.
        drawn: rows of a report with pictures.
        environ: variables of the environment.
    """

    argv: list
    simulates: bool = False
    conf: Path | None = None
    drawn: int = 0
    environ: dict = field(default_factory=dict)


OTHERS = ("secret", "victim", "pipe", "folder", "nothing", "empty", "huge", "zero", "self")


def other(rng, path, here):
    """Something else in the place of a file."""
    if path.is_dir():
        return
    path.unlink(missing_ok=True)
    how = rng.choice(OTHERS)
    if how in ("secret", "victim"):
        path.symlink_to(here.parent / "outside" / how)
    elif how == "pipe":
        os.mkfifo(path)
    elif how == "folder":
        path.mkdir()
    elif how == "empty":
        path.touch()
    elif how == "huge":
        path.touch()
        os.truncate(path, 6 * 2**30)  # without a block on the disk
    elif how in ("zero", "self"):
        path.symlink_to("/dev/zero" if how == "zero" else path)
