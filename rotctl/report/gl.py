"""An OpenGL context that works here, or one line on what to install.

Without OpenGL, MuJoCo fails with messages that help nobody, or takes the process with it.
So each backend is first tried in a process of its own.
"""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module, reload
from typing import Any

from rotctl.engine import VARIABLE
from rotctl.errors import InputError

HINT = "on Debian: apt-get install libosmesa6"
# osmesa first: in software a picture has the same bytes with and without a GPU.
_CANDIDATES = ("osmesa", "egl") if sys.platform == "linux" else ("glfw",)
# What MuJoCo takes; with any other value its import raises.
_KNOWN = ("osmesa", "egl", "glfw", "glx", "cgl", "wgl", "enable", "enabled", "on", "true", "1",
          "disable", "disabled", "off", "false", "0")  # fmt: skip
_PROBE = "from rotctl.report import gl; gl.try_out({name!r})"
_PROBE_SECONDS = 60.0  # [s] importing MuJoCo on a busy machine takes some


def chosen() -> str:
    """The user's `MUJOCO_GL`; empty without one.

    Raises:
        InputError: MuJoCo does not know it, and cannot be imported then.
    """
    name = os.environ.get(VARIABLE, "").strip().lower()
    if name and name not in _KNOWN:
        raise InputError(
            f"{VARIABLE}={name[:40]}: no such OpenGL; valid: osmesa, egl, glfw, disable; "
            f"unset it to try {', '.join(_CANDIDATES)}"
        )
    return name


@cache
def backend() -> str:
    """The backend to render with: the user's `MUJOCO_GL`, or the first that works.

    Raises:
        InputError: none works.
    """
    if wanted := chosen():
        if not works(wanted):
            raise InputError(
                f"cannot render: {VARIABLE}={wanted} gives no working OpenGL; "
                f"unset it to try {', '.join(_CANDIDATES)}; {HINT}"
            )
        return wanted
    for name in _CANDIDATES:
        if works(name):
            return name
    raise InputError(f"cannot render: no working OpenGL (tried {', '.join(_CANDIDATES)}); {HINT}")


def works(name: str) -> bool:
    """Whether a backend can draw, tried in a process of its own."""
    try:
        done = subprocess.run(
            [sys.executable, "-c", _PROBE.format(name=name)],
            env={**os.environ, VARIABLE: name},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_PROBE_SECONDS,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0


def try_out(name: str) -> None:
    """Draw an empty scene; whatever goes wrong is raised, or ends the process."""
    import mujoco

    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    with context(name, 16, 16):
        drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        drawing.free()


@contextmanager
def context(name: str, width: int, height: int) -> Iterator[None]:
    """A current OpenGL context of a backend, for pictures of width x height pixels.

    MuJoCo picks its own backend when it is imported, which is too early for us; and its
    loader of OpenGL functions reads the environment when the first context is made.
    """
    os.environ[VARIABLE] = name
    made: Any = _module(name).GLContext(width, height)
    try:
        made.make_current()
        yield
    finally:
        made.free()


def _module(name: str) -> Any:
    """MuJoCo's module of a backend, which has none where it was imported without OpenGL."""
    if name in ("osmesa", "egl", "glfw", "cgl"):
        return import_module(f"mujoco.{name}")
    module = import_module("mujoco.gl_context")
    return module if hasattr(module, "GLContext") else reload(module)
