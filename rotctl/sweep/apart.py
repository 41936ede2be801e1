"""A task in a process of its own, for one that may be the death of the process it is in.

A worker that dies takes with it whatever else waits there, and nobody can tell whose fault it was.
Here it can be told, and the worker lives. Not `multiprocessing`: the workers of a scheduler are
daemons, which may have no children of that kind.
"""

import os
import pickle
import sys
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from subprocess import Popen
from typing import Any, TypeVar

from rotctl.sweep.engines import Failure, ending
from rotctl.sweep.worker import serve

T = TypeVar("T")
R = TypeVar("R")


@dataclass(frozen=True)
class Death:
    """A task whose process died of it.

    Attributes:
        ending: how, in words.
    """

    ending: str


def apart(task: Callable[[T], R], item: T) -> R | Failure | Death:
    """The result of a task that is carried out in another process.

    Args:
        task, item: picklable, as an engine wants them; what pickle says of others is raised.
    """
    ours, theirs = Pipe()
    here = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    # -P: else a module of the folder that the worker is in would go before ours.
    command = [sys.executable, "-P", "-m", __spec__.name, str(theirs.fileno())]
    with Popen(command, pass_fds=[theirs.fileno()], env=here) as child, ours:
        theirs.close()  # else the pipe would not end with the child
        answer: Any
        try:
            ours.send_bytes(pickle.dumps((task, item)))
            answer = pickle.loads(ours.recv_bytes())
        except (EOFError, OSError):
            answer = Death(ending(child.wait()))
    return answer


if __name__ == "__main__":
    serve(Connection(int(sys.argv[1])), set())
