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


def pid(_):
    return os.getpid()


def meet(folder):
    """The pid, as soon as two processes are in this at once."""
    (Path(folder) / str(os.getpid())).touch()
    while len(os.listdir(folder)) < 2:
        time.sleep(0.01)
    return os.getpid()


def endless(marker):
    """Says that it has begun, and does not end; nothing to say: done at once."""
    if marker is None:
        return
    Path(marker).touch()
    while True:
        time.sleep(60.0)
