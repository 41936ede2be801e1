"""Dask: a scheduler and two workers, each a process of its own, on the loopback device."""

import os
import pickle
import signal
import socket
import subprocess
import sys
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from threading import Thread

import pytest
import sweep_tasks
from here import swept
from sweep_cli import PATIENCE, finish, kill, logs, published, start, until

from rotctl.cli.main import main
from rotctl.errors import InputError, RotctlError
from rotctl.log import RunLog
from rotctl.sweep import cluster as cluster_module
from rotctl.sweep.apart import Death, apart
from rotctl.sweep.engine_choice import make_engine
from rotctl.sweep.engines import Failure
from rotctl.sweep.task_size import Pace

pytest.importorskip("distributed", reason="Dask is not installed: pip install 'rotctl[cluster]'")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextmanager
def process(log, *arguments, **environment):
    """A Dask process that ends with the test."""
    settings = {"PYTHONPATH": str(Path(__file__).parent), **environment}
    with log.open("w") as output:
        child = subprocess.Popen(
            [sys.executable, "-m", *arguments],
            stdout=output,
            stderr=output,
            env=os.environ | settings,
            start_new_session=True,  # its nanny's child ends with it
        )
    try:
        yield child
    finally:
        child.terminate()
        try:
            child.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.wait()


def scheduler(folder, port):
    return process(
        folder / "scheduler.log",
        "distributed.cli.dask_scheduler",
        *("--host", "127.0.0.1", "--port", str(port), "--no-dashboard"),
        # One death is one death, so that --retries counts.
        DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0",
    )


def worker(folder, address, name):
    return process(
        folder / f"{name}.log",
        "distributed.cli.dask_worker",
        address,
        *("--host", "127.0.0.1", "--nthreads", "1", "--nworkers", "1", "--no-dashboard"),
        *("--local-directory", str(folder / name)),
    )


@pytest.fixture(scope="module", autouse=True)
def _patience():
    """On a busy machine a scheduler is longer in coming than people would wait."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cluster_module, "PATIENCE", PATIENCE)
        yield


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """The address of a scheduler with two workers."""
    folder, port = tmp_path_factory.mktemp("dask"), free_port()
    address = f"tcp://127.0.0.1:{port}"
    with ExitStack() as stack:
        stack.enter_context(scheduler(folder, port))
        for name in ("first", "second"):
            stack.enter_context(worker(folder, address, name))
        with closing(make_engine(None, address)) as engine:
            until(lambda: engine.workers == 2)
        yield address


@pytest.fixture
def engine(cluster):
    with closing(make_engine(None, cluster)) as engine:
        until(lambda: engine.workers == 2)
        yield engine


def test_every_item_gives_its_result(engine, cluster):
    assert engine.where == f"{cluster} with 2 workers so far"
    results = dict(engine.map(sweep_tasks.square, range(20), retries=0))
    assert results == {i: i * i for i in range(20)}


def test_trouble_stays_with_its_task(engine, tmp_path):
    items = ["a", "raise", "b"]
    results = dict(engine.map(sweep_tasks.trouble, items, retries=0))
    assert results == {0: ("a", "1"), 1: Failure("ValueError: two lines"), 2: ("b", "1")}


def test_a_worker_that_died_is_replaced_and_its_task_retried(engine, tmp_path):
    assert list(engine.map(sweep_tasks.die_once, [str(tmp_path / "marker")], retries=1)) == [
        (0, "alive")
    ]


def test_a_task_that_always_kills_is_a_failure(engine):
    results = list(engine.map(sweep_tasks.trouble, ["kill"], retries=0))
    assert results == [
        (0, Failure("its worker died: killed by SIGKILL, the last of at least 2 times"))
    ]


def test_what_waits_behind_those_that_kill_is_not_blamed(engine):
    """Each of the two workers has one task at work and one that waits, and dies with both."""
    items = ["kill", "a"] * 4
    results = dict(engine.map(sweep_tasks.trouble, items, retries=1))
    killed = Failure("its worker died: killed by SIGKILL, the last of at least 2 times")
    assert results == {i: killed if item == "kill" else (item, "1") for i, item in enumerate(items)}


def test_a_process_of_its_own_leaves_its_worker_alive():
    assert apart(sweep_tasks.trouble, "exit") == Death("exit code 7")
    assert apart(sweep_tasks.trouble, "kill") == Death("killed by SIGKILL")
    assert apart(sweep_tasks.trouble, "raise") == Failure("ValueError: two lines")
    assert apart(sweep_tasks.square, 3) == 9


def test_what_cannot_travel_to_a_process_of_its_own_is_told():
    with pytest.raises((AttributeError, pickle.PicklingError)):
        apart(lambda x: x, 3)
    assert apart(sweep_tasks.trouble, "unpicklable").reason.startswith(
        ("AttributeError: ", "PicklingError: ")
    )


def test_nothing_of_the_folder_that_a_worker_is_in_is_executed(tmp_path, monkeypatch):
    marker = tmp_path / "executed"
    (tmp_path / "mujoco.py").write_text(f"open({str(marker)!r}, 'w')\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [path for path in sys.path if path])  # "" is that folder
    assert apart(sweep_tasks.square, 3) == 9
    assert not marker.exists()


def test_short_items_go_together_and_one_that_kills_takes_no_other_with_it(engine):
    """After the first ones, ten milliseconds are known to be short."""
    items = [*["a"] * 300, "kill", *["b"] * 100]
    results = dict(engine.map(sweep_tasks.trouble, items, retries=6))
    assert (
        results.pop(300).reason
        == "its worker died: killed by SIGKILL, the last of at least 7 times"
    )
    assert {index: items[index] for index in results} == {i: r[0] for i, r in results.items()}
    assert len(results) == 400


@pytest.mark.parametrize(
    ("done", "seconds", "left", "size"),
    [
        (0, 0.0, 1000, 1),  # nothing is known
        (32, 0.32, 10_000, 100),  # ten milliseconds each
        (32, 0.0, 10_000, 128),
        (32, 0.32, 64, 2),  # some is left for the others
        (32, 320.0, 1000, 1),
    ],
)
def test_how_many_items_make_a_task(done, seconds, left, size):
    assert Pace(done, seconds).size(left) == size


def test_the_runs_are_the_same_as_they_are_here(cluster, tmp_path):
    grid = ["duration=1", "seed=range(0,3)"]
    local, dask = swept(tmp_path / "local", *grid), tmp_path / "dask"
    assert main(["sweep", *grid, "--out", str(dask), "--scheduler", cluster, "--quiet"]) == 0
    names = [log.parent.name for log in logs(local)]
    assert names == [log.parent.name for log in logs(dask)]
    for one, other in zip(logs(local), logs(dask), strict=True):
        one, other = RunLog.open(one), RunLog.open(other)
        for name in ("trajectory/qpos", "trajectory/qvel", "trajectory/ctrl"):
            assert one[name].tobytes() == other[name].tobytes()


@pytest.mark.slow
def test_a_killed_driver_leaves_the_rest_to_the_same_command(cluster, tmp_path):
    arguments = ["sweep", "duration=3", "seed=range(0,12)", "--out", tmp_path]
    arguments += ["--scheduler", cluster, "--quiet"]
    driver = start(*arguments)
    until(lambda: len(logs(tmp_path)) >= 2)
    kill(driver.pid)
    driver.communicate()
    before = published(tmp_path)
    assert finish(*arguments)[0] == 0
    after = published(tmp_path)
    assert len(after) == 12
    assert before.items() <= after.items()


def test_a_scheduler_that_is_not_there_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster_module, "PATIENCE", 1.0)
    address = f"tcp://127.0.0.1:{free_port()}"
    with pytest.raises(InputError) as error:
        make_engine(None, address)
    assert str(error.value).startswith(f"--scheduler={address}: no Dask scheduler there: ")


def test_who_answers_and_is_no_scheduler_is_told_in_one_line(tmp_path):
    def answer(place, kept):
        while True:
            talk, _ = place.accept()
            talk.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            kept.append(talk)

    with socket.create_server(("127.0.0.1", 0)) as place:
        Thread(target=answer, args=(place, []), daemon=True).start()
        address = f"tcp://127.0.0.1:{place.getsockname()[1]}"
        code, _, stderr = finish("sweep", "seed=0", "--out", tmp_path, "--scheduler", address)
    assert code == 2
    assert stderr.startswith(f"rotctl: --scheduler={address}: no Dask scheduler there: ")
    assert stderr.count("\n") == 1  # and no traceback of a client that is closed as it goes


@pytest.mark.slow
def test_a_scheduler_that_goes_away_is_said(tmp_path, capfd):
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    with (
        scheduler(tmp_path, port) as child,
        worker(tmp_path, address, "only"),
        closing(make_engine(None, address)) as engine,
    ):
        results = engine.map(sweep_tasks.endless, [None, tmp_path / "begun"], retries=0)
        next(results)
        until((tmp_path / "begun").exists)
        kill(child.pid)
        with pytest.raises(RotctlError) as error:
            next(results)
    assert str(error.value) == (
        f"{address}: the scheduler is gone; start it again and repeat the command"
    )
    assert capfd.readouterr() == ("", "")  # no traceback of Dask's either


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError) as error:
        make_engine(None, "tcp://127.0.0.1:1")
    assert str(error.value) == (
        "--scheduler needs Dask, which is not installed: pip install 'rotctl[cluster]'"
    )
