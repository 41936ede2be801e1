"""Tasks for the engines' tests, in a module that worker processes can import."""

import os
import signal
import time
from pathlib import Path


def square(x):
    return x * x


def trouble(x):
    if x == "raise":
        raise ValueError("two\nlines")
    if x == "unpicklable":
        return lambda: x
    if x == "exit":
        os._exit(7)
    if x == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    return x, os.environ["OPENBLAS_NUM_THREADS"]


def die_once(marker):
    if not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "alive"


def pid_after(seconds):
    time.sleep(seconds)
    return os.getpid()
