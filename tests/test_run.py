"""One config to one folder: a whole log and a summary, once, the same every time, or nothing."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import SCHEMA, RunLog
from rotctl.runs.folder import SUMMARY_NAME
from rotctl.runs.run import LOG_NAME, run
from rotctl.runs.scenario import build

LOOKS = [
    "head_share",
    "head_peak",
    "hands_bear",
    "across",
    "force_p99",
    "force_peak",
    "force_sustained",
    "tuck_hip",
    "tuck_knee",
    "knees_apart",
    "limb_overlap",
    "rate_error",
    "speed_error",
    "revolution_error",
    "travel_mean",
]
MEASURED = [
    "revolutions",
    "angular_velocity_mean",
    "speed_mean",
    "heading_error_end",
    "lateral_drift",
    "lateral_rms",
    "longest_stall",
    "slowest_revolution",
    "setback",
    "height_least",
    "height_most",
    "penetration",
    "flight_turn",
    "trunk_turn",
    "axis_error",
    "travel_least",
    "travel_most",
    "ground_force_p99",
    "ground_force_peak",
    "airborne",
    "jerk",
    "chatter",
    "sticking",
    "recovery",
    "recovered",
]
ZERO_AT_FIRST = ("revolutions", "lateral_drift", "lateral_rms", "longest_stall")
SUMMARY_KEYS = [
    "run_id",
    "behaviour",
    "criteria",
    "seed",
    "success",
    "failure_reason",
    "duration",
    "torque_p99_fraction",
    *MEASURED,
    "solver_failures",
    *LOOKS,
    "angular_velocity_commanded",
    "speed_commanded",
    "real_time_factor",
]
SHORT = ["duration=0.5", "controller.solver=boxqp", "controller.form=condensed"]
# Springs this stiff, on joints without inertia, blow up after a while, and MuJoCo warns.
EXPLOSIVE = [
    "duration=2",
    "character.joint_damping=0",
    "character.joint_armature=0",
    "physics.substeps=1",
    "controller.pose.stiffness=1e7",
    "controller.pose.damping=1e5",
]
NEVER_STARTS = ["duration=0.5", "start.speed_x=[1e12,1e12]"]


@pytest.fixture(scope="module")
def config():
    return load(SHORT)


@pytest.fixture(scope="module")
def finished(config, tmp_path_factory):
    """One short run, to be looked at only."""
    return run(config, tmp_path_factory.mktemp("finished"))


def strict_json(text):
    """JSON as the standard has it: no NaN, no Infinity."""

    def refuse(constant):
        raise AssertionError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def test_a_run_is_a_log_and_a_summary(config, finished):
    assert finished.folder.name == build(config).run_id == finished.summary["run_id"]
    assert sorted(os.listdir(finished.folder)) == ["config.yaml", LOG_NAME, SUMMARY_NAME]
    assert not finished.already_there
    assert not finished.replaced
    assert not finished.broke_down


def test_the_summary_has_its_keys_in_their_order(finished):
    assert list(finished.summary) == SUMMARY_KEYS
    written = strict_json((finished.folder / SUMMARY_NAME).read_text())
    assert list(written) == SUMMARY_KEYS
    assert written == finished.summary
    assert RunLog.open(finished.folder / LOG_NAME).outcome == finished.summary


def test_the_summary_is_about_this_run(config, finished):
    summary = finished.summary
    assert summary["behaviour"] == "forward_roll_1"
    assert summary["seed"] == config.seed
    assert summary["duration"] == pytest.approx(0.5)
    assert summary["angular_velocity_commanded"] == 1.3
    assert summary["speed_commanded"] == 1.2
    assert summary["solver_failures"] == 0
    assert 0 < summary["torque_p99_fraction"] <= 1
    assert summary["real_time_factor"] > 0


def test_the_log_says_where_it_comes_from(config, finished):
    log = RunLog.open(finished.folder / LOG_NAME)
    log.verify()
    assert log.steps == 30
    assert log.attributes["run_id"] == finished.summary["run_id"]
    assert log.attributes["seed"] == config.seed
    assert log.attributes["wall_time"] > 0
    assert "duration: 0.5" in log.config_yaml
    assert np.allclose(log["trajectory/time"], np.arange(30) / 60)
    assert log.model_xml.startswith("<mujoco")


def test_a_run_that_is_there_is_not_redone(config, tmp_path):
    first = run(config, tmp_path)
    stamp = (first.folder / LOG_NAME).stat().st_mtime_ns
    second = run(config, tmp_path, progress=lambda: pytest.fail("simulated again"))
    assert second.already_there
    assert second.summary == first.summary
    assert (first.folder / LOG_NAME).stat().st_mtime_ns == stamp
    forced = run(config, tmp_path, force=True)
    assert not forced.already_there
    assert not forced.replaced
    assert (first.folder / LOG_NAME).stat().st_mtime_ns > stamp


def test_the_same_seed_twice_is_the_same_run_to_the_last_bit(config, finished, tmp_path):
    again = run(config, tmp_path)
    one, two = (RunLog.open(r.folder / LOG_NAME) for r in (finished, again))
    for name in SCHEMA:
        assert one[name].tobytes() == two[name].tobytes(), name
    assert {**one.outcome, "real_time_factor": 0} == {**two.outcome, "real_time_factor": 0}


def test_another_seed_is_another_run_beside_it(config, tmp_path):
    one, two = run(config, tmp_path), run(replace(config, seed=1), tmp_path)
    assert one.folder.parent == two.folder.parent == tmp_path
    assert one.folder != two.folder
    qpos = [RunLog.open(r.folder / LOG_NAME)["trajectory/qpos"] for r in (one, two)]
    assert not np.array_equal(*qpos)


def test_a_symmetric_start_stays_in_plane_for_three_seconds(tmp_path):
    result = run(load(["start=symmetric", "duration=3"]), tmp_path)
    log = RunLog.open(result.folder / LOG_NAME)
    assert log.steps == 180
    assert np.abs(log["trajectory/com"][:, 1]).max() <= 1e-4  # [m]


@pytest.mark.parametrize(
    ("solver", "form", "duration"),
    [
        ("boxqp", "condensed", 3),
        ("osqp", "condensed", 3),
        ("qpsolvers:daqp", "condensed", 3),
        ("qpsolvers:piqp", "condensed", 3),
        ("osqp", "literal", 0.5),
        ("qpsolvers:daqp", "literal", 0.5),
    ],
)
def test_every_solver_rolls(solver, form, duration, tmp_path):
    if solver.startswith("qpsolvers:"):
        pytest.importorskip("qpsolvers")
    config = load(
        [f"controller.solver={solver}", f"controller.form={form}", f"duration={duration}"]
    )
    summary = run(config, tmp_path).summary
    turned = summary["revolutions"]
    ends = f"the run ends at {duration:.2f} s"
    short = f"{ends}, before a whole revolution: it turned {turned:.2f} rev"
    assert summary["failure_reason"] == ("" if turned >= 1.0 else short)
    assert summary["solver_failures"] == 0
    assert summary["duration"] == pytest.approx(duration)
    assert turned > 0.4 * duration


# ---------------------------------------------------------------- what lies there already


def test_a_truncated_log_is_simulated_again_and_said(config, tmp_path):
    first = run(config, tmp_path)
    path = first.folder / LOG_NAME
    os.truncate(path, path.stat().st_size // 2)
    again = run(config, tmp_path)
    assert not again.already_there
    assert again.replaced == f"{path}: truncated or damaged HDF5 file"
    RunLog.open(path).verify()


def test_something_else_under_the_logs_name_is_replaced_and_said(config, tmp_path):
    path = tmp_path / build(config).run_id / LOG_NAME
    path.parent.mkdir()
    path.write_text("hello")
    assert run(config, tmp_path).replaced == f"{path}: not an HDF5 file"
    RunLog.open(path).verify()


def test_the_log_of_another_run_is_not_taken_for_this_one(config, tmp_path):
    other = run(replace(config, seed=1), tmp_path)
    path = tmp_path / build(config).run_id / LOG_NAME
    path.parent.mkdir()
    path.write_bytes((other.folder / LOG_NAME).read_bytes())
    result = run(config, tmp_path)
    assert result.replaced == (
        f"{path}: is run {other.summary['run_id']}, expected {path.parent.name}"
    )
    assert result.summary["seed"] == 0


def test_a_log_whose_content_was_changed_is_not_trusted(config, tmp_path):
    import h5py

    path = run(config, tmp_path).folder / LOG_NAME
    with h5py.File(path, "r+") as file:
        file["trajectory/qpos"][3, 3] += 1e-9
    result = run(config, tmp_path)
    assert result.replaced == f"{path}: damaged, its content does not match its SHA-256"


def test_a_summary_that_a_kill_prevented_is_put_back(config, tmp_path):
    first = run(config, tmp_path)
    (first.folder / SUMMARY_NAME).unlink()
    assert run(config, tmp_path).already_there
    assert strict_json((first.folder / SUMMARY_NAME).read_text()) == first.summary


# ---------------------------------------------------------------- nothing half-written


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_a_run_cut_short_leaves_nothing(config, tmp_path, error):
    steps = []

    def progress():
        steps.append(None)
        if len(steps) == 10:
            raise error

    with pytest.raises(error):
        run(config, tmp_path, progress=progress)
    assert os.listdir(tmp_path) == []


def test_a_redo_cut_short_leaves_the_run_that_was_there(config, tmp_path):
    def progress():
        raise KeyboardInterrupt

    first = run(config, tmp_path)
    with pytest.raises(KeyboardInterrupt):
        run(config, tmp_path, force=True, progress=progress)
    assert sorted(os.listdir(first.folder)) == ["config.yaml", LOG_NAME, SUMMARY_NAME]
    assert run(config, tmp_path).already_there


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["duration=0.51"], "duration=0.51 s is no whole number of control steps of 1/60 s; "),
        (["duration=1e-9"], "duration=1e-09 s is no whole number of control steps of 1/60 s; "),
        (
            ["duration=3600", "controller.rate=10000"],
            "36000000 steps with room for 64 contacts need ",
        ),
    ],
)
def test_a_run_that_cannot_be_is_refused_before_it_starts(overrides, message, tmp_path):
    with pytest.raises(InputError) as caught:
        run(load(overrides), tmp_path, progress=lambda: pytest.fail("simulated"))
    assert str(caught.value).startswith(message)
    assert os.listdir(tmp_path) == []


def test_a_file_in_the_way_of_the_folder(config, tmp_path):
    (tmp_path / "out").write_text("")
    folder = tmp_path / "out" / build(config).run_id
    with pytest.raises(InputError) as caught:
        run(config, tmp_path / "out", progress=lambda: pytest.fail("simulated"))
    assert str(caught.value) == f"cannot write {folder}: Not a directory"


def test_a_folder_in_the_way_of_the_log(config, tmp_path):
    path = tmp_path / build(config).run_id / LOG_NAME
    path.mkdir(parents=True)
    with pytest.raises(InputError) as caught:
        run(config, tmp_path)
    assert str(caught.value) == f"cannot write {path}: Is a directory"
    assert os.listdir(path.parent) == [LOG_NAME]


def test_a_folder_that_is_not_writable_is_refused_before_it_starts(config, tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(InputError) as caught:
        run(config, tmp_path, progress=lambda: pytest.fail("simulated"))
    folder = tmp_path / build(config).run_id
    assert str(caught.value) == f"cannot write {folder}: no permission, or read-only"
    assert os.listdir(tmp_path) == []


def test_a_name_that_is_too_long(config, tmp_path):
    with pytest.raises(InputError, match=r"^cannot write /.*: File name too long$"):
        run(config, tmp_path / ("x" * 300))


def test_names_with_spaces_and_unicode(config, tmp_path):
    assert (run(config, tmp_path / "a b" / "ü 滚").folder / LOG_NAME).is_file()


# ---------------------------------------------------------------- runs that break down


def test_a_run_that_blows_up_is_a_failed_row_with_its_good_states(tmp_path):
    result = run(load(EXPLOSIVE), tmp_path)
    summary = result.summary
    assert result.broke_down
    assert summary["success"] is False
    assert summary["failure_reason"].startswith("physics broke down at t = 0.")
    assert ": MuJoCo warns: " in summary["failure_reason"]
    log = RunLog.open(result.folder / LOG_NAME)
    log.verify()
    assert 0 < log.steps < 120
    assert summary["duration"] == pytest.approx(log.steps / 60)
    for name in ("trajectory/qpos", "trajectory/qvel", "trajectory/ctrl"):
        assert np.isfinite(log[name]).all(), name
    (time, text) = log.events[-1]
    assert time == pytest.approx(summary["duration"])
    assert text.startswith("MuJoCo warns: ")


@pytest.mark.parametrize(("behaviour", "at"), [("forward_roll_1", "0.00"), ("stand", "0.03")])
def test_a_run_with_more_contacts_than_there_is_room_for_is_no_success(behaviour, at, tmp_path):
    """What bears, touches and sticks is read from the slots: it would be told of some contacts."""
    asked = [f"behaviour={behaviour}", "duration=2.5", "seed=2001"]
    assert run(load(asked), tmp_path).summary["success"]
    few = run(load([*asked, "physics.contact_capacity=2"]), tmp_path).summary
    assert few["failure_reason"] == (
        f"contacts fill all 2 slots at t = {at} s: what else touched is not known; "
        "physics.contact_capacity makes room"
    )


def test_a_run_without_a_single_good_state_has_nulls(tmp_path):
    result = run(load(NEVER_STARTS), tmp_path)
    text = (result.folder / SUMMARY_NAME).read_text()
    summary = strict_json(text)
    assert result.broke_down
    assert summary["failure_reason"] == (
        "physics broke down at t = 0.00 s: MuJoCo warns: velocity not finite or too large"
    )
    none = {key for key, value in summary.items() if value is None}
    assert none == {"torque_p99_fraction", *MEASURED, *LOOKS} - {*ZERO_AT_FIRST}
    assert RunLog.open(result.folder / LOG_NAME).steps == 0
    assert run(load(NEVER_STARTS), tmp_path).broke_down, "also when it is only reported"


def test_mujoco_neither_prints_nor_leaves_a_file(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    assert run(load(NEVER_STARTS), tmp_path / "out").broke_down
    assert capfd.readouterr() == ("", "")
    assert os.listdir(tmp_path) == ["out"]


def test_numpy_does_not_warn_of_what_the_log_tells(tmp_path, capfd):
    result = run(load(["duration=0.5", "physics.gravity=[0,0,-1e13]"]), tmp_path)
    assert result.broke_down
    assert capfd.readouterr() == ("", "")


def test_a_run_imports_no_more_than_it_needs(tmp_path):
    """Each of these takes from a twentieth to a half of a second of every start."""
    heavy = ("hydra", "omegaconf", "scipy", "pandas", "matplotlib", "PIL", "glfw", "osqp", "jinja2")
    code = (
        "import sys\n"
        "from rotctl.cli.main import main\n"
        f"main(['run', 'duration=0.1', 'behaviour=stand', '--quiet', '--out', {str(tmp_path)!r}])\n"
        f"print([name for name in {heavy} if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
