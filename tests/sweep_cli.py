"""The sweep command as a process that tests can watch, stop and kill."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path


def command(*arguments):
    return [sys.executable, "-m", "rotctl", *map(str, arguments)]


def finish(*arguments, **settings):
    """Run to the end: (exit code, stdout, stderr)."""
    done = subprocess.run(
        command(*arguments), capture_output=True, text=True, timeout=120, **settings
    )
    return done.returncode, done.stdout, done.stderr


def start(*arguments):
    return subprocess.Popen(
        command(*arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def until(condition, seconds=60.0):
    """Wait for a condition; what it returned."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError(f"not within {seconds:g} s")


def logs(out):
    return sorted(Path(out).glob("*/run.h5"))


def published(out):
    """Run id -> which file it is: another one if the run was published again."""
    return {log.parent.name: (log.stat().st_ino, log.stat().st_mtime_ns) for log in logs(out)}


def workers(driver):
    """The worker processes of a driver."""
    try:
        pids = Path(f"/proc/{driver}/task/{driver}/children").read_text().split()
        lines = {int(pid): Path(f"/proc/{pid}/cmdline").read_bytes() for pid in pids}
    except FileNotFoundError:  # one of them is gone
        return []
    return [pid for pid, line in lines.items() if b"spawn_main" in line]


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True
