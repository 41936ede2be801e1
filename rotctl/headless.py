"""MuJoCo without OpenGL: half of what it takes to import it are libraries to draw with."""

import os
from importlib import import_module

VARIABLE = "MUJOCO_GL"


def mujoco_without_opengl() -> None:
    """Import MuJoCo without OpenGL, which also works where `MUJOCO_GL` makes no sense."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = "disable"
    try:
        import_module("mujoco")
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before
