"""The command line: errors and interrupts become one line and an exit code."""

import argparse
import atexit
import gc
import io
import os
import sys
import warnings
from collections.abc import Sequence

from rotctl.cli.interrupting import interruptible
from rotctl.cli.parser import parse
from rotctl.cli.unread import drop, left_unread
from rotctl.cli.wording import one_line
from rotctl.engine import mujoco_without_opengl
from rotctl.errors import RotctlError
from rotctl.report import gl


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    # One BLAS thread, whatever the user's shell says: matrices are small, runs in parallel are
    # worth more, and more threads add up in another order.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    # To look through all that is imported for garbage, again and again and once more at the end,
    # takes a fifth of a short run.
    gc.set_threshold(200_000)
    atexit.register(gc.freeze)
    # What other packages hook into the checks of settings is searched for, and acts on none here.
    os.environ["PYDANTIC_DISABLE_PLUGINS"] = "__all__"
    if not sys.warnoptions:  # of libraries, with lines of their sources
        warnings.simplefilter("ignore")
        os.environ.setdefault("PYTHONWARNINGS", "ignore")  # of workers
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # any path can be printed
    with left_unread():
        return _told(parse(argv))


def _told(arguments: argparse.Namespace) -> int:
    """Do what a command line says, and tell what is wrong; its exit code."""
    try:
        with interruptible():
            return _commanded(arguments)
    except RotctlError as error:
        from rotctl.choices.override_files import blamed

        complaint = blamed(getattr(arguments, "overrides", ()), str(error))
        print(f"rotctl: {one_line(complaint)}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"rotctl: interrupted; {arguments.interrupted}", file=sys.stderr)
        return 130
    except OSError as error:
        drop(sys.stdout)
        what = f"{error.filename or 'output'}: {error.strerror or error}"
        print(f"rotctl: {one_line(what)}", file=sys.stderr)
        return 2


def _commanded(arguments: argparse.Namespace) -> int:
    """Do what a command line says; its exit code."""
    from rotctl.choices.config_folders import own
    from rotctl.choices.override_files import expanded  # reads YAML, for which help need not wait

    if "overrides" in arguments:
        arguments.overrides = expanded(arguments.overrides)
    gl.chosen()  # where it makes no sense MuJoCo raises, whatever it is needed for
    if arguments.with_mujoco:
        mujoco_without_opengl()  # by itself it raises where the one that is chosen does not work
    with own(arguments.config_dir):
        code = int(arguments.command(arguments))
        if sys.stdout:  # None where the shell has closed it
            sys.stdout.flush()
        return code
