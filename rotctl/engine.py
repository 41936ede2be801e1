"""MuJoCo, the engine, without what it brings along: libraries to draw with, and words on stdout."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

VARIABLE = "MUJOCO_GL"


def mujoco_without_opengl() -> None:
    """Import MuJoCo without OpenGL, which is half of the time that takes.

    That also works where `MUJOCO_GL` makes no sense, or names one that does not work.
    """
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = "disable"
    try:
        import_module("mujoco")
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before


@contextmanager
def quiet() -> Iterator[list[str]]:
    """Collects MuJoCo's warnings, which would go to stdout and a MUJOCO_LOG.TXT."""
    import mujoco  # not by all who import this: it takes a while

    before = mujoco.get_mju_user_warning()
    heard: list[str] = []
    mujoco.set_mju_user_warning(heard.append)
    try:
        yield heard
    finally:
        mujoco.set_mju_user_warning(before)
