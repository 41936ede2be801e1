"""One input, given to a command in a child process: what it may take, and what counts as a fault.

A fault is an exception that reaches us, a signal, an exit code or a refusal other than those the
help tells of, more than 20 s of CPU or a minute of waiting, a gigabyte more than it began with, a
file that is written or removed elsewhere than in the folder given, and a process that is no helper
of ours.
"""

import io
import os
import resource
import signal
import sys
import time
import traceback
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

CPU = 20  # [s]
WALL = 90.0  # [s]; a busy machine gives a third of its CPU
MEMORY = 2**30  # [bytes] resident, beyond what a child holds as it begins
SPACE = 2**33  # [bytes] of addresses: libraries set some aside that they never use
HELPERS = ("git", "ffmpeg", "fc", Path(sys.executable).name)  # programs that rotctl runs
LONGEST = 2500  # characters of what is said on stderr, with all valid choices
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_CHANGES = {"os.remove": 1, "os.mkdir": 1, "os.rmdir": 1, "os.truncate": 1, "os.rename": 2,
            "os.link": 2, "os.symlink": 2, "sqlite3.connect": 1}  # fmt: skip


@dataclass(frozen=True)
class Found:
    """What became of an input: a word and the details of its fault, both empty without one."""

    fault: str
    details: str
    code: int | None
    cpu: float
    memory: int


def give(command, folder, allowed):
    """Call `command()` in a child whose current folder is `folder`.

    Args:
        command: returns the exit code.
        allowed: folders that may be written into.
    """
    report = Path(folder).parent / "report"
    report.unlink(missing_ok=True)
    begins, tells = os.pipe()  # a child's peak begins at what its parent holds, a gigabyte at times
    pid = os.fork()
    if pid == 0:
        os.write(tells, str(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss).encode())
        _live(command, folder, [os.path.realpath(path) for path in allowed], report)
    begin, status, usage = time.monotonic(), 0, None
    while usage is None:
        done, status, spent = os.wait4(pid, os.WNOHANG)
        if done:
            usage = spent
        elif time.monotonic() - begin > WALL:
            os.killpg(pid, signal.SIGKILL)
            _, status, usage = os.wait4(pid, 0)
        else:
            time.sleep(0.002)
    held = int(os.read(begins, 32))
    os.close(begins)
    os.close(tells)
    said = report.read_text(errors="replace").split("\0") if report.exists() else ["", "", ""]
    return _judged(os.waitstatus_to_exitcode(status), said, usage, held)


def _judged(code, said, usage, held):
    trouble, stdout, stderr = said
    cpu, memory = usage.ru_utime + usage.ru_stime, (usage.ru_maxrss - held) * 1024
    lines = stderr.splitlines()
    fault = ""
    if code in (-signal.SIGXCPU, -signal.SIGKILL) or cpu > CPU:
        fault = "hang"
    elif code < 0:
        fault = f"killed by {signal.Signals(-code).name}"
    elif trouble:
        fault = trouble.split("\n", 1)[0]
    elif memory > MEMORY:
        fault = "memory"
    elif "Traceback" in stderr or "Warning" in stderr or len(stderr) > LONGEST:
        fault = "noise"
    elif code == 2 and (not lines or not lines[-1].startswith("rotctl")):
        fault = "no reason"
    elif code == 2 and sum(line.startswith("rotctl") for line in lines) > 1:
        fault = "several reasons"
    elif "canary" in stdout + stderr:
        fault = "canary"
    return Found(fault, f"{trouble}\n{stdout[-500:]}\n{stderr[-1500:]}", code, cpu, memory)


def _live(command, folder, allowed, report):
    """The life of the child; never returns."""
    code, trouble, out, err = 70, "", io.StringIO(), io.StringIO()
    try:
        os.setsid()
        signal.signal(signal.SIGXCPU, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CPU, (CPU + 1, CPU + 5))
        resource.setrlimit(resource.RLIMIT_AS, (SPACE, SPACE))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.chdir(folder)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        watch = _Watch(allowed)
        sys.addaudithook(watch)
        with redirect_stdout(out), redirect_stderr(err):
            code = command()
        watch.on = False
        trouble = "\n".join(watch.seen)
        if code not in (0, 1, 2, 130):
            trouble = trouble or f"exit code {code}"
    except SystemExit as stop:  # argparse's way
        code = stop.code if isinstance(stop.code, int) else 70
        watch.on = False
        trouble = "\n".join(watch.seen)
    except BaseException as error:
        watch.on = False
        trouble = f"{type(error).__name__}\n{traceback.format_exc(limit=-8)}"
    finally:
        texts = (trouble, out.getvalue(), err.getvalue())
        said = "\0".join(text.replace("\0", "?") for text in texts)
        report.write_bytes(said.encode("utf-8", "replace"))
        os._exit(code)


class _Watch:
    """An audit hook: what Python opens for writing, removes and starts."""

    def __init__(self, allowed):
        self.allowed, self.seen, self.on = allowed, [], True

    def __call__(self, event, arguments):
        if not self.on:
            return
        if event == "open" and arguments[2] & _WRITING:
            self._look(event, arguments[:1], linked=not arguments[2] & os.O_NOFOLLOW)
        elif event in _CHANGES:
            linked = event in ("sqlite3.connect", "os.truncate")
            self._look(event, arguments[: _CHANGES[event]], linked)
        elif event in ("subprocess.Popen", "os.exec", "os.system", "os.posix_spawn"):
            program = os.fsdecode(arguments[0])
            if Path(program).name.split("-")[0] not in HELPERS:
                self.seen.append(f"starts {program}")

    def _look(self, event, paths, linked):
        self.on = False
        try:
            for path in paths:
                if isinstance(path, int) or os.fsdecode(path) in ("/dev/null", ":memory:"):
                    continue
                place = os.path.abspath(os.fsdecode(path))
                if linked:
                    place = os.path.realpath(place)
                else:  # of a link itself, not of what it leads to
                    folder, name = os.path.split(place)
                    place = os.path.join(os.path.realpath(folder), name)
                if not any(os.path.commonpath([place, root]) == root for root in self.allowed):
                    self.seen.append(f"{event} outside: {place}")
        except ValueError:  # a name that no file can have
            pass
        finally:
            self.on = True
