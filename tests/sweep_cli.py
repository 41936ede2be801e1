"""Commands as processes that tests can watch, hold, stop and kill.

A test never hopes that a process is quick or slow enough: it waits for something to be seen, or
holds the process at a place until it has done what it wants to do.
"""

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from threading import Timer

PATIENCE = 600.0  # [s] guards against hangs alone: on the busiest machine nothing takes so long
ENDLESS = "duration=3600"  # minutes of computing: whatever is done to it, is done in its midst

_HELD = """
import sys
from pkgutil import resolve_name

from rotctl.cli.main import main

owner, name = sys.argv[1].rsplit(".", 1)
owner = resolve_name(owner)
real = getattr(owner, name)

def held(*arguments):
    result = real(*arguments)
    print("held", flush=True)
    sys.stdin.readline()
    return result

setattr(owner, name, held)
sys.exit(main(sys.argv[2:]))
"""


def command(*arguments):
    return [sys.executable, "-m", "rotctl", *map(str, arguments)]


def finish(*arguments, **settings):
    """Run to the end: (exit code, stdout, stderr)."""
    done = subprocess.run(
        command(*arguments), capture_output=True, text=True, timeout=PATIENCE, **settings
    )
    return done.returncode, done.stdout, done.stderr


def python(text):
    """A script in a process of its own: (exit code, stdout, stderr)."""
    done = subprocess.run(
        [sys.executable, "-c", text], capture_output=True, text=True, timeout=PATIENCE
    )
    return done.returncode, done.stdout, done.stderr


def start(*arguments, **settings):
    """A command in a process of its own, which Ctrl-C reaches even where we ignore it."""
    return subprocess.Popen(
        command(*arguments),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell may have started us with SIGINT ignored, which children inherit.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        **settings,
    )


class Held:
    """A command that stops after each call of a function, until it is let go."""

    def __init__(self, process):
        self.process, self.pid = process, process.pid

    def reached(self):
        """Wait until it has stopped there."""
        if self.process.stdout.readline() != "held\n":
            raise AssertionError(f"it ended instead: {self.process.communicate()}")

    def go_on(self):
        """Let it go as far as the next call."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()

    def finish(self):
        """Let it go for good: (exit code, stdout, stderr)."""
        output = self.process.communicate()
        return (self.process.returncode, *output)


@contextmanager
def held_after(place, *arguments):
    """A command that stops after each call of the function at that place, such as `os.fsync`."""
    process = subprocess.Popen(
        [sys.executable, "-c", _HELD, place, *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    guard = Timer(PATIENCE, process.kill)
    guard.start()
    try:
        yield Held(process)
    finally:
        guard.cancel()
        process.kill()
        process.communicate()


def until(condition):
    """Wait for a condition; what it returned."""
    end = time.monotonic() + PATIENCE
    while not (found := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {PATIENCE:g} s")
        time.sleep(0.02)
    return found


def logs(out):
    return sorted(Path(out).glob("*/run.h5"))


def published(out):
    """Run id -> which file it is: another one if the run was published again."""
    return {log.parent.name: (log.stat().st_ino, log.stat().st_mtime_ns) for log in logs(out)}


def workers(driver):
    """The worker processes of a driver: forked ones have its command line."""
    try:
        own = Path(f"/proc/{driver}/cmdline").read_bytes()
        pids = Path(f"/proc/{driver}/task/{driver}/children").read_text().split()
        lines = {int(pid): Path(f"/proc/{pid}/cmdline").read_bytes() for pid in pids}
    except FileNotFoundError:  # one of them is gone
        return []
    return [pid for pid, line in lines.items() if line == own or b"spawn_main" in line]


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True
