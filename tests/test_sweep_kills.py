"""Whatever is killed, the same command again does the rest: nothing lost, nothing done twice."""

import os
import random
import signal
import sys

import pytest
from sweep_cli import (
    ENDLESS,
    PATIENCE,
    finish,
    held_after,
    kill,
    logs,
    start,
    until,
    workers,
)
from sweep_cli import published as published_logs

from rotctl.log import RunLog
from rotctl.results import index
from rotctl.results.manifest import read

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")

WORKER_STARTED = "rotctl.sweep.worker.Worker.start"


def grid(count, duration="duration=3"):
    return [duration, f"seed=range(0,{count})"]


def whole(out, count):
    assert len(logs(out)) == count
    for log in logs(out):
        RunLog.open(log).verify()
    assert not list(out.glob("**/*.part"))
    assert not list(out.glob("**/*.corrupt"))
    assert sorted(read(out)) == sorted(log.parent.name for log in logs(out))


def rows(out):
    """Run id -> row of the runs that are done, as their index has them."""
    return index.read(out).rows


def progress(driver, out, count):
    until(lambda: len(rows(out)) >= count or driver.poll() is not None)


def torture(out, count, kills, chance, keep="all"):
    """Kill the driver or a worker at random times, until all is done."""
    arguments = ["sweep", *grid(count), "--out", out, "--jobs", "2", "--quiet", "--keep", keep]
    published = published_logs if keep == "all" else rows
    seen = {}
    for turn in range(kills):
        driver = start(*arguments)
        target = min(len(rows(out)) + chance.randint(1, max(1, count // kills)), count - 1)
        progress(driver, out, target)
        if turn % 2:
            for pid in workers(driver.pid)[:1]:
                kill(pid)
            progress(driver, out, target + 1)
        kill(driver.pid)
        driver.communicate()
        now = published(out)
        assert {name: now[name] for name in seen} == seen
        seen = now
    assert finish(*arguments)[0] == 0
    now = published(out)
    assert {name: now[name] for name in seen} == seen
    assert sorted(rows(out)) == sorted(read(out))
    assert len(rows(out)) == count
    # Of each run one line: none was done twice.
    assert (out / index.INDEX_NAME).read_text().count('"outcome"') == count
    if keep == "all":
        whole(out, count)


@pytest.mark.parametrize("keep", ["all", "rows"])
def test_killed_again_and_again(tmp_path, keep):
    torture(tmp_path, 6, 2, random.Random(0), keep)


@pytest.mark.slow
@pytest.mark.parametrize("keep", ["all", "rows"])
def test_two_hundred_runs_killed_ten_times(tmp_path, keep):
    torture(tmp_path, 200, 10, random.Random(1), keep)


def test_a_killed_worker_is_replaced_and_its_run_retried(tmp_path):
    arguments = ["sweep", *grid(2), "--out", tmp_path, "--jobs", "2", "--quiet"]
    with held_after(WORKER_STARTED, *arguments) as driver:
        driver.reached()
        (first,) = until(lambda: workers(driver.pid))
        kill(first)
        code, _, stderr = driver.finish()
    assert (code, stderr) == (0, "")
    whole(tmp_path, 2)


def test_without_retries_it_is_a_failed_row_and_the_others_go_on(tmp_path):
    arguments = ["sweep", *grid(3), "--out", tmp_path, "--jobs", "1", "--quiet"]
    with held_after(WORKER_STARTED, *arguments, "--retries", "0") as driver:
        driver.reached()
        (only,) = until(lambda: workers(driver.pid))
        kill(only)
        code, _, stderr = driver.finish()
    assert code == 1
    (failed,) = [entry for entry in read(tmp_path).values() if entry.failure]
    assert failed.failure == "its worker died: killed by SIGKILL"
    assert stderr == (
        "1 run failed to run:\n"
        f"  {failed.run_id}  behaviour=forward_roll_1 seed=0 duration=3.0: {failed.failure}\n"
    )
    assert len(logs(tmp_path)) == 2
    assert finish(*arguments)[0] == 0
    whole(tmp_path, 3)
    assert not any(entry.failure for entry in read(tmp_path).values())


@pytest.mark.parametrize(
    "number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)]
)
def test_an_interrupt_leaves_a_sweep_that_can_go_on(tmp_path, number):
    """While two runs are in their midst, three are done, and one is waiting."""
    short, seeds = "duration=0.5", "seed=range(0,3)"
    both = f"{short},{ENDLESS.partition('=')[2]}"
    driver = start("sweep", both, seeds, "--out", tmp_path, "--jobs", "2")
    until(lambda: len([*tmp_path.glob("*/summary.json")]) == 3 or driver.poll() is not None)
    children = workers(driver.pid)
    os.kill(driver.pid, number)
    _, stderr = driver.communicate(timeout=PATIENCE)
    assert driver.returncode == 130
    assert "Traceback" not in stderr
    assert stderr.splitlines()[-1] == ("rotctl: interrupted; the same command does what is left")
    assert len(children) == 2
    assert not [pid for pid in children if os.path.exists(f"/proc/{pid}")]
    before = published_logs(tmp_path)
    assert len(before) == 3
    assert not list(tmp_path.glob("**/*.part"))
    assert finish("sweep", short, "seed=range(0,4)", "--out", tmp_path, "--quiet")[0] == 0
    assert len(logs(tmp_path)) == 4
    assert before.items() <= published_logs(tmp_path).items()
