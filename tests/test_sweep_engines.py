"""The engines: every task gives one result, whatever happens to the worker that has it."""

import json
import os
import signal
from contextlib import closing
from multiprocessing import active_children

import pytest
import sweep_cli
import sweep_tasks
from sweep_cli import until

from rotctl.cli.interrupting import interruptible
from rotctl.errors import InputError
from rotctl.sweep import worker
from rotctl.sweep.engine_choice import make_engine
from rotctl.sweep.engines import Failure


@pytest.fixture(scope="module")
def engine():
    with closing(make_engine(2, None)) as engine:
        yield engine


def test_every_item_gives_its_result(engine):
    results = dict(engine.map(sweep_tasks.square, range(50), retries=0))
    assert results == {i: i * i for i in range(50)}


def test_a_forked_worker_takes_no_signal_as_the_command_does(monkeypatch):
    monkeypatch.setattr(worker, "_alone", lambda: True)
    with interruptible(), closing(make_engine(1, None)) as forked:
        told = dict(forked.map(signal.getsignal, [signal.SIGTERM, signal.SIGALRM], retries=0))
    assert told == {0: signal.SIG_DFL, 1: signal.SIG_DFL}


def test_nothing_to_do(engine):
    assert list(engine.map(sweep_tasks.square, [], retries=0)) == []


def test_trouble_stays_with_its_task(engine):
    items = ["a", "raise", "b", "exit", "c", "kill", "d", "unpicklable", "e"]
    results = dict(engine.map(sweep_tasks.trouble, items, retries=1))
    assert len(results) == len(items)
    assert results[1] == Failure("ValueError: two lines")
    assert results[3] == Failure("its worker died: exit code 7, the last of 2 times")
    assert results[5] == Failure("its worker died: killed by SIGKILL, the last of 2 times")
    assert "pickle" in results[7].reason
    for i in (0, 2, 4, 6, 8):
        assert results[i] == (items[i], "1")


def test_a_death_without_retries(engine):
    assert list(engine.map(sweep_tasks.trouble, ["exit"], retries=0)) == [
        (0, Failure("its worker died: exit code 7"))
    ]


def test_a_worker_that_died_once_is_retried(engine, tmp_path):
    results = list(engine.map(sweep_tasks.die_once, [str(tmp_path / "marker")], retries=1))
    assert results == [(0, "alive")]


def test_workers_are_kept_for_the_next_map(engine, tmp_path):
    def met(name):
        folder = tmp_path / name
        folder.mkdir()
        return {pid for _, pid in engine.map(sweep_tasks.meet, [folder] * 2, retries=0)}

    first = met("first")
    assert met("second") == first
    assert len(first) == 2
    assert os.getpid() not in first


def test_closing_the_results_drops_what_runs(tmp_path):
    begun, others = [tmp_path / "one", tmp_path / "other"], set(active_children())
    with closing(make_engine(2, None)) as engine:
        results = engine.map(sweep_tasks.endless, [None, *begun], retries=0)
        assert next(results) == (0, None)
        until(lambda: all(path.exists() for path in begun))
        results.close()
        assert set(active_children()) == others
        assert list(engine.map(sweep_tasks.square, [3], retries=0)) == [(0, 9)]


def test_a_process_with_one_thread_forks_its_workers_and_leaves_them_nothing_open():
    code, stdout, stderr = sweep_cli.python(FORKED)
    assert (code, stderr) == (0, "")
    ours, of_workers = map(set, json.loads(stdout))
    assert "lock" in ours
    assert not ours & of_workers


# Names of files and sockets that a driver has open, and those of its workers. (A pipe that tells of
# a worker's end has one name at both ends.)
FORKED = """
import json, os, tempfile
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"
os.chdir(tempfile.mkdtemp())
lock = open("lock", "w")
from rotctl.sweep.local import LocalEngine

def files(pid):
    found = [place.resolve().name for place in Path(f"/proc/{pid}/fd").iterdir()]
    return [name for name in found if name == "lock" or name.startswith("socket:")]

def named(task):
    return task

engine = LocalEngine(2)
list(engine.map(named, range(2), retries=0))  # at home in no module: spawned ones could not
pids = [worker.process.pid for worker in engine._idle]
print(json.dumps([files("self"), sum(map(files, pids), [])]))
engine.close()
"""


def test_one_process_is_one_process():
    with closing(make_engine(1, None)) as engine:
        assert engine.where == "1 local process"
        pids = {pid for _, pid in engine.map(sweep_tasks.pid, [None] * 3, retries=0)}
    assert len(pids) == 1


@pytest.mark.parametrize(
    ("jobs", "scheduler", "message"),
    [
        (0, None, "--jobs=0: valid: 1 to 1024"),
        (
            2,
            "tcp://127.0.0.1:1",
            "--jobs=2: is for local processes; with --scheduler, start as many workers",
        ),
        (
            None,
            "localhost:8786",
            "--scheduler=localhost:8786: must be tcp://HOST:PORT or tls://HOST:PORT, "
            "such as tcp://127.0.0.1:8786",
        ),
    ],
)
def test_bad_choices_are_named(jobs, scheduler, message):
    with pytest.raises(InputError) as error:
        make_engine(jobs, scheduler)
    assert str(error.value) == message


def test_what_was_open_and_is_closed_is_let_go_too():
    """A descriptor that somebody closed after the count: the next one that is opened is that."""
    kept, closed = os.open(os.devnull, os.O_RDONLY), os.open(os.devnull, os.O_RDONLY)
    os.close(kept)
    os.close(closed)  # the lowest that are free
    worker._let_go({kept, closed})
    for descriptor in (kept, closed):
        assert os.fstat(descriptor).st_rdev == os.stat(os.devnull).st_rdev
        os.close(descriptor)
