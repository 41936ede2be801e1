"""The sweep command: what it does, reuses, sets aside and says."""

import errno
import json
import os
from pathlib import Path

import h5py
import pytest
from here import Here, without_processes
from sweep_cli import logs, published

from rotctl.config.identity import run_id
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import SCHEMA, RunLog, collect, encode_run
from rotctl.results.code import code_version
from rotctl.results.manifest import read
from rotctl.runs import scenario
from rotctl.runs.folder import publish
from rotctl.runs.run import make
from rotctl.sweep.launch import launch, tally
from rotctl.sweep.lock import locked
from rotctl.sweep.plan import plan, planned
from rotctl.sweep.points import points
from rotctl.sweep.task import carry_out, ordered

BRIEF = "duration=2"
CHAIN = (
    *("behaviour=chain", "behaviour.parts=[stand,stand]", "behaviour.between=null"),
    *("behaviour.rest.seconds=0.1", "controller=standing", "duration=0.5"),
)
FINISH = (
    *("+finish=stand", "behaviour.finish.after=0.3"),
    *("behaviour.finish.reach=1", "behaviour.finish.turning=1"),
)


def runs_of(*grid):
    return planned(points([[BRIEF, *grid]]))


def sweep(out, *grid, fails=None, strict=False):
    out.mkdir(exist_ok=True)
    runs, engine = runs_of(*grid), Here(fails)
    there = plan(runs, out, strict)
    return launch(there, runs, out, engine, 0), there, engine


# ---------------------------------------------------------------- the command


def test_a_sweep_and_the_same_again(cli, tmp_path):
    out = tmp_path / "my sweep"
    arguments = ["sweep", BRIEF, "seed=range(0,3)", "--out", out, "--jobs", "2"]
    code, stdout, stderr = cli(*arguments)
    assert code == 0
    first, *progress = stderr.splitlines()  # a slow machine tells how far it is
    assert first == f"3 runs to do in {out}; on 2 local processes"
    assert all("/3 runs, " in line for line in progress)
    assert stdout == (
        f"3 runs: 3 succeeded, 0 did not, 0 failed to run\nnext       rotctl summarise '{out}'\n"
    )
    for log in logs(out):
        RunLog.open(log).verify()
        row = json.loads(log.with_name("summary.json").read_text())
        assert row["run_id"] == log.parent.name
    before = published(out)
    code, stdout, stderr = cli(*arguments)
    assert (code, stderr) == (
        0,
        f"0 runs to do in {out}, 3 are there already; on 2 local processes\n",
    )
    assert stdout.startswith(
        "3 runs: 3 succeeded, 0 did not, 0 failed to run, 3 of them were there"
    )
    assert published(out) == before


def test_points_that_are_one_run_are_told(cli, tmp_path):
    arguments = ["sweep", BRIEF, "seed=range(0,3)", "seed=7,7", "--out", tmp_path, "--jobs", "1"]
    code, stdout, stderr = cli(*arguments)
    assert code == 0
    first, second, *_ = stderr.splitlines()
    assert first == (
        "6 points are 1 run: some are the same, or set a key that a later one sets again"
    )
    assert second == f"1 run to do in {tmp_path}; on 1 local process"
    told, *_ = cli(*arguments, "--dry-run")[1].splitlines()
    assert told == first
    assert stdout.startswith("1 run: 1 succeeded, 0 did not, 0 failed to run\n")


def test_a_run_of_the_sweep_is_the_run_of_run(cli, tmp_path):
    cli("run", BRIEF, "seed=1", "--out", tmp_path / "run", "--quiet")
    sweep(tmp_path / "sweep", "seed=1")
    (one,), (other,) = logs(tmp_path / "run"), logs(tmp_path / "sweep")
    assert one.parent.name == other.parent.name
    for name in ("trajectory/qpos", "trajectory/ctrl", "contacts/force_realised"):
        assert RunLog.open(one)[name].tobytes() == RunLog.open(other)[name].tobytes()


def test_dry_run_writes_nothing(cli, tmp_path):
    out = tmp_path / "out"
    code, stdout, stderr = cli("sweep", BRIEF, "seed=range(0,8)", "--out", out, "--dry-run")
    lines = stdout.splitlines()
    assert (code, stderr) == (0, "")
    assert lines[0] == f"8 runs, 8 of them not yet in {out}"
    assert lines[1].endswith("  behaviour=forward_roll_1 seed=0 duration=2.0")
    assert lines[6] == "  ... and 3 more"
    assert lines[7].startswith("about ")
    assert not out.exists()


def test_a_dry_run_of_pushes_that_come_later_than_its_trial_ends(cli, tmp_path):
    pushed = ("disturbance=push", "disturbance.time=2", "duration=2.5", "seed=range(0,3)")
    code, stdout, stderr = cli("sweep", *pushed, "--out", tmp_path / "out", "--dry-run")
    assert (code, stderr) == (0, "")
    assert "\nabout " in stdout


@pytest.mark.parametrize(
    ("keep", "runs", "before"),
    [("all", 8, "about "), ("failures", 8, "up to about "), ("sample:3", 3, "about ")],
)
def test_a_dry_run_tells_the_disk_that_logs_take(cli, tmp_path, keep, runs, before):
    log = make(load([BRIEF, "seed=0"])).log
    grid = ("sweep", BRIEF, "seed=range(0,8)", "--keep", keep, "--dry-run", "--out", tmp_path)
    *_, told = cli(*grid)[1].splitlines()
    assert told == f"{before}{runs * len(log) / 1e6:.0f} MB of logs, if all are as the first"
    rows = tuple("rows" if each == keep else each for each in grid)
    assert cli(*rows)[1].splitlines()[-1] == "no logs are kept"


def test_bad_input_is_one_line_and_nothing_is_written(cli, tmp_path):
    out = tmp_path / "out"
    for arguments, message in [
        (["seed=1,-2"], "seed=-2: must be greater than or equal to 0"),
        (["seed=1", "--retries", "-1"], "--retries=-1: must be at least 0"),
        (["seed=1", "--keep", "sample:x"], "--keep=sample:x: valid: all, failures, rows, sample:N"),
        (["seed=1", "--jobs", "0"], "--jobs=0: valid: 1 to 1024"),
        (["+experiment=no"], "+experiment=no: no such experiment; valid: ablations, "),
    ]:
        code, stdout, stderr = cli("sweep", *arguments, "--out", out)
        assert (code, stdout) == (2, "")
        assert stderr.startswith(f"rotctl: {message}")
        assert stderr.count("\n") == 1
        assert not out.exists()


def test_an_experiment_has_a_folder_of_its_name_and_other_sweeps_want_one(
    cli, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    quick = ("seed=1", "duration=0.1", "--dry-run")
    code, stdout, _ = cli("sweep", "+experiment=table1", *quick)
    assert (code, stdout.splitlines()[0]) == (0, "10 runs, 10 of them not yet in sweeps/table1")
    assert cli("sweep", "+experiment=table1", *quick, "--out", "x")[1].startswith(
        "10 runs, 10 of them not yet in x\n"
    )
    said = "rotctl: no folder for the runs; give --out DIR, such as --out sweeps/mine\n"
    assert cli("sweep", *quick) == (2, "", said)
    assert not list(tmp_path.iterdir())


def test_hills_are_compiled_once_a_seed_to_name_the_runs(monkeypatch):
    """Whatever else varies, and however many seeds: a grid took as long to plan as to simulate."""
    built, build = [], scenario.model_from
    made = "rotctl.sweep.plan.model_from"
    monkeypatch.setattr(made, lambda *parts: built.append(parts) or build(*parts))
    grid = ["controller.pose.weight=1,2,3", "terrain=uneven", "seed=range(0,10)", "duration=0.1"]
    found = planned(points([grid]))
    assert (len(found), len(built)) == (30, 10)
    for run in (found[0], found[29]):
        config = load([f"{key}={value}" for key, value in run.values.items()])
        assert run.run_id == run_id(config, scenario.model_of(config))


def test_runs_of_other_sweeps_that_claims_would_be_judged_over_are_told(cli, tmp_path):
    sweep = ("sweep", "duration=0.1", "--jobs", "1", "--keep", "rows", "--out", tmp_path)
    experiment = (*sweep, "+experiment=forward_roll_1", "seed=1")
    assert "of other sweeps" not in cli(*sweep, "seed=1,2")[2]
    assert f"\n1 run of other sweeps is in {tmp_path}: the claims" in f"\n{cli(*experiment)[2]}"
    assert cli(*experiment, "--quiet")[2] == ""
    assert "of other sweeps" not in cli(*experiment[:-1], "seed=1,2")[2]


def test_a_file_in_the_way_of_the_folder(cli, tmp_path):
    (tmp_path / "file").touch()
    code, _, stderr = cli("sweep", BRIEF, "--out", tmp_path / "file")
    assert (code, stderr) == (2, f"rotctl: cannot write {tmp_path / 'file'}: File exists\n")


def test_a_second_sweep_is_refused_while_the_first_lives(cli, tmp_path):
    with locked(tmp_path):
        code, stdout, stderr = cli("sweep", BRIEF, "--out", tmp_path)
        assert (code, stdout) == (2, "")
        assert stderr == (
            f"rotctl: {tmp_path}: another sweep is at work there; wait for it, or choose another "
            "--out\n"
        )
    with locked(tmp_path):  # free again
        pass


def test_a_disk_without_locks_is_said_and_used(cli, tmp_path, monkeypatch):
    def none(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", none)
    code, _, stderr = cli("sweep", BRIEF, "--out", tmp_path, "--jobs", "1", "--quiet")
    assert code == 0
    assert stderr == (
        f"rotctl: {tmp_path}: its disk knows no locks; start no second sweep or search there\n"
    )


# ---------------------------------------------------------------- reuse


def test_overlapping_sweeps_share_their_runs(tmp_path):
    sweep(tmp_path, "seed=range(0,4)")
    now, there, engine = sweep(tmp_path, "seed=range(2,6)")
    assert (now.count, len(there.done), engine.asked) == (4, 2, 2)
    assert len(logs(tmp_path)) == len(read(tmp_path)) == 6


def test_points_with_one_config_are_one_run(tmp_path):
    assert len(runs_of("seed=1,1,2")) == 2
    assert len(runs_of("duration=0.5,0.50,1")) == 2


def test_a_finished_run_without_its_summary_gets_it_back(tmp_path):
    sweep(tmp_path, "seed=1")
    (summary,) = tmp_path.glob("*/summary.json")
    before = summary.read_text()
    summary.unlink()
    assert sweep(tmp_path, "seed=1")[2].asked == 0
    assert summary.read_text() == before


@pytest.mark.parametrize("harm", ["truncated", "flipped", "empty"])
def test_a_damaged_log_is_set_aside_and_done_again(tmp_path, harm):
    sweep(tmp_path, "seed=1,2")
    victim = logs(tmp_path)[0]
    content = bytearray(victim.read_bytes())
    if harm == "flipped":
        with h5py.File(victim) as file:
            chunk = file["trajectory/qpos"].id.get_chunk_info(0)
        content[chunk.byte_offset + chunk.size // 2] ^= 0x10
    damaged = bytes(content if harm == "flipped" else content[: len(content) // 2])
    victim.write_bytes(b"" if harm == "empty" else damaged)
    _, there, engine = sweep(tmp_path, "seed=1,2")
    assert engine.asked == 1
    (reason,) = there.replaced
    assert reason.startswith(f"{victim}: ")
    assert reason.endswith("; kept as run.h5.corrupt")
    assert Path(f"{victim}.corrupt").exists()
    RunLog.open(victim).verify()


def other_code(log):
    """The same run, as if an older commit had made it."""
    whole = RunLog.open(log)
    names = ("config", "run_id", "seed", "wall_time", "outcome", "versions", "machine")
    kept = {name: whole.attributes[name] for name in names}
    kept |= {"git_commit": "0123456789", "git_dirty": False}
    arrays = {name: whole[name] for name in SCHEMA}
    mjcf = whole.model_xml
    del arrays["model/mjcf"]
    log.write_bytes(encode_run(arrays, model_xml=mjcf, attributes=kept))


def test_other_code_is_reported_and_redone_only_if_strict(tmp_path):
    sweep(tmp_path, "seed=1,2")
    log = logs(tmp_path)[0]
    other_code(log)
    _, there, engine = sweep(tmp_path, "seed=1,2")
    assert engine.asked == 0
    ((code, count),) = there.other_code.items()
    assert ("(0123456), mujoco" in code, count) == (True, 1)
    _, there, engine = sweep(tmp_path, "seed=1,2", strict=True)
    assert engine.asked == 1
    assert there.replaced == [f"{log}: made by {code}"]
    assert code_version(RunLog.open(log).attributes) == code_version(collect())


# ---------------------------------------------------------------- failures


def test_a_failed_run_is_a_row_until_it_is_done(tmp_path):
    now, _, _ = sweep(tmp_path, "seed=1,2,3", fails={1: "no luck"})
    failed = runs_of("seed=2")[0].run_id
    assert now.broken == {failed: "no luck"}
    assert {e.run_id: e.failure for e in read(tmp_path).values() if e.failure} == now.broken
    assert len(logs(tmp_path)) == 2
    now, _, engine = sweep(tmp_path, "seed=1,2,3")
    assert (now.broken, engine.asked) == ({}, 1)
    assert not any(entry.failure for entry in read(tmp_path).values())


def test_a_breakdown_of_the_physics_fails_each_time_it_is_asked_for(cli, tmp_path, monkeypatch):
    without_processes(monkeypatch)
    arguments = ["sweep", "duration=1", "start.speed_x=[1e12,1e12],[1,2]", "--out", tmp_path]
    for _ in range(2):
        code, stdout, stderr = cli(*arguments, "--quiet")
        assert (code, stdout) == (1, "")
        assert stderr.startswith("1 run failed to run:\n")
        assert "start.speed_x=[1000000000000.0, 1000000000000.0]: physics broke down" in stderr


def test_a_roll_that_stalls_is_a_result():
    fallen = {"failure_reason": "stalled", "solver_failures": 0, "success": False}
    now = tally([("a", fallen), ("b", {**fallen, "success": True})])
    assert (now.succeeded, now.fell, now.broken) == (1, 1, {})


def test_a_full_disk_is_one_line_and_what_was_done_stays(tmp_path, monkeypatch):
    count = 0

    def full(made, folder):
        nonlocal count
        count += 1
        if count == 2:
            raise InputError(f"cannot write {folder}: No space left on device")
        publish(made, folder)

    monkeypatch.setattr("rotctl.sweep.launch.publish", full)
    with pytest.raises(InputError, match="No space left on device"):
        sweep(tmp_path, "seed=1,2,3")
    assert len(logs(tmp_path)) == 1
    assert len(read(tmp_path)) == 3


def test_a_manifest_of_somebody_else_is_refused(cli, tmp_path):
    (tmp_path / "sweep.jsonl").write_text('{"run_id": "x"}\n')
    code, _, stderr = cli("sweep", BRIEF, "--out", tmp_path, "--quiet")
    assert (code, stderr) == (
        2,
        f"rotctl: {tmp_path / 'sweep.jsonl'}: line 1 is not a row of a sweep\n",
    )


@pytest.mark.parametrize(
    "grid",
    [
        *(["behaviour=stand", "duration=0.5"], ["plant=randomised", "duration=0.5"]),
        ["behaviour=back_flip", "duration=2.5"],  # has landed, and not all feet are set down
        CHAIN,  # is in its second part
        ["behaviour=forward_roll", *FINISH, "duration=1.5"],  # stands up
        ["physics=lockstep", "duration=0.5"],
        ["duration=0.5"],
    ],
)
def test_a_worker_that_has_simulated_other_runs_gives_the_same_bits(grid):
    """Its controller and its behaviour serve one run after the other."""
    first, second = runs_of("seed=2000,2001", *grid)
    here = carry_out([ordered(run.config, "never") for run in (first, second, first)])
    assert [made.trajectory for made in here] == [
        make(run.config).trajectory for run in (first, second, first)
    ]
    assert not any(made.log for made in here)


def test_make_gives_the_bytes_and_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = make(load([BRIEF]))
    assert os.listdir() == []
    publish(made, tmp_path / "run")
    RunLog.open(tmp_path / "run" / "run.h5").verify()
