"""Starts in a known state: where an earlier run was (`rotctl new start`), and beside it."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest
import yaml
from logs import changed as with_arrays
from scipy.spatial.transform import Rotation

from rotctl.choices import config_folders
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.runs.recorded_start import make
from rotctl.runs.scenario import build
from rotctl.settings.writing import to_dict
from rotctl.simulation.clearance import clearance
from rotctl.simulation.episode import Episode
from rotctl.simulation.known import Known, StateSettings, pitch
from rotctl.simulation.placing import beginning

ROW = 30
STATE = StateSettings(
    place=(0.5, -0.2),
    gap=0.1,
    orientation=(1.8, 0.2, 0.4, -0.6),
    velocity=(0.3, 0.1, -0.2),
    angular_velocity=(0.5, 2.0, -0.4),
    pose={"hip_y": 0.9, "knee_l": 2.6, "elbow": 0.4},
    speeds={"knee": 1.0},
)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Half a second of a roll over hills, as a log on disk."""
    folder = tmp_path_factory.mktemp("recorded")
    code = main(
        ["run", "behaviour=uneven_terrain", "terrain.run_in=0", "seed=3", "duration=0.6"]
        + ["--out", str(folder)]
    )
    assert code == 0
    return RunLog.open(next(folder.glob("*/run.h5")))


def started(*overrides, folder=None):
    """Behaviour, start and MuJoCo's data of a run that begins."""
    with config_folders.own(folder / "conf" if folder else None):
        scenario = build(load(list(overrides)))
    return scenario, Episode(scenario).data


def beside(state=STATE, **given):
    """A start in a state, and what is said beside it."""
    config = load(["behaviour=get_up", "duration=0.1", "seed=1"])
    fixed = {key: (0.0, 0.0) for key in vars(config.start) if key.startswith(("pitch", "speed"))}
    fixed |= {"scatter": 0.0, "tilt": 0.0, "postures": {}, "state": state}
    start = replace(config.start, **(fixed | given))
    scenario = build(replace(config, start=start))
    return scenario, Episode(scenario).data


def test_a_run_begins_where_another_one_was(recorded, here):
    """To rounding: every angle and every speed, over the same hills."""
    path = make("there", recorded, 0.5)
    assert path.read_text().startswith(
        f'# From the run "{recorded.attributes["run_id"]}", character=adult_free_head, '
        "on terrain=uneven, seed 3, at 0.50 s"
    )
    same_hills = ("terrain=uneven", "terrain.run_in=0", "seed=3")
    _, data = started("behaviour=get_up", "start=there", *same_hills, folder=here)
    assert data.qpos == pytest.approx(recorded["trajectory/qpos"][ROW], abs=1e-12)
    assert data.qvel == pytest.approx(recorded["trajectory/qvel"][ROW], abs=1e-12)


def test_the_last_row_is_taken_if_no_time_is_said(recorded, here):
    make("last", recorded, None)
    state = yaml.safe_load((here / "conf" / "start" / "last.yaml").read_text())["state"]
    assert state["place"] == recorded["trajectory/qpos"][-1, :2].tolist()
    assert state["speeds"]["knee_l"] in recorded["trajectory/qvel"][-1].tolist()


def test_a_roll_goes_on_from_its_own_state(recorded, here):
    """At the phase that it had, to a tenth: the trunk's, of which the pelvis is behind."""
    make("there", recorded, 0.5)
    overrides = ("behaviour=uneven_terrain", "start=there", "terrain.run_in=0", "seed=3")
    scenario, _ = started(*overrides, folder=here)
    turned = beginning(scenario.start, scenario.behaviour) - recorded["trajectory/phase"][ROW]
    assert abs(turned + np.pi) % (2.0 * np.pi) - np.pi == pytest.approx(0.0, abs=0.9)


def test_what_runs_is_in_the_log(recorded, here):
    """So that it is verified elsewhere, without the file that it was chosen from."""
    assert main(["new", "start", "there", "--from", str(recorded.path), "--at", "0.5"]) == 0
    assert main(["run", "behaviour=get_up", "start=there", "duration=0.1"]) == 0
    (log,) = (here / "runs").glob("*/run.h5")
    (here / "conf" / "start" / "there.yaml").unlink()
    assert main(["verify", str(log)]) == 0


@pytest.mark.parametrize(
    ("overrides", "stage"),
    [
        (["behaviour=handstand"], "stand"),
        (["behaviour=chain", "behaviour.parts=[stand,back_flip]"], "stand"),
        (["behaviour=get_up"], ""),  # takes the way that suits
        (["behaviour=forward_roll_2"], ""),  # begins at the phase
        (["behaviour=handstand", "start=raised"], ""),  # no state of a run
    ],
)
def test_what_has_stages_says_that_it_begins_with_the_first(
    recorded, here, capsys, overrides, stage
):
    make("there", recorded, None)
    assert main(["run", "start=there", "duration=0.05", *overrides]) == 0
    name = overrides[0].removeprefix("behaviour=")
    first = f"{name} begins with its first stage, {stage}, however the body is then\n"
    said = first if stage else ""
    assert capsys.readouterr().err.rpartition("\r")[2] == said


def test_the_lowest_point_is_at_the_gap():
    """By MuJoCo's own distances, whatever the body."""
    scenario, data = beside()
    mj = scenario.model.mj
    ground = mj.geom("ground").id
    gaps = [
        mujoco.mj_geomDistance(mj, data, ground, geom, 10.0, None)
        for geom in range(mj.ngeom)
        if mj.geom_bodyid[geom] > 0 and mj.geom_contype[geom] > 0
    ]
    assert min(gaps) == pytest.approx(0.1, abs=1e-6)
    assert data.qpos[:2].tolist() == [0.5, -0.2]


def test_a_gap_of_nothing_is_kept():
    """It was so in a run: it is not sunk in by what other starts sink in."""
    scenario, data = beside(replace(STATE, gap=0.0))
    assert clearance(scenario.model, data) == pytest.approx(0.0, abs=1e-12)


def test_joints_are_as_they_are_said_to_be_beyond_their_stops_too():
    scenario, data = beside()
    model = scenario.model
    angles = dict(zip(model.joint_names, data.qpos[model.angles].tolist(), strict=True))
    speeds = dict(zip(model.joint_names, data.qvel[model.joints].tolist(), strict=True))
    assert (angles["knee_l"], angles["knee_r"], angles["hip_y_r"]) == (2.6, 0.0, 0.9)
    assert (speeds["knee_l"], speeds["knee_r"], speeds["hip_y_l"]) == (1.0, 1.0, 0.0)


def test_a_start_is_turned_and_pushed_from_there():
    """By independent rotations; the whole body moves as one piece beside what it did."""
    _, plain = beside()
    axes = build(load(["behaviour=get_up", "duration=0.1"])).behaviour.axes
    more = {"pitch": (0.3, 0.3), "speed_x": (0.7, 0.7), "angular_velocity_z": (1.5, 1.5)}
    scenario, data = beside(**more)
    turn = Rotation.from_rotvec(0.3 * axes[1])
    expected = turn * Rotation.from_quat(STATE.orientation, scalar_first=True)
    assert abs(expected.as_quat(scalar_first=True) @ data.qpos[3:7]) == pytest.approx(1.0)
    mujoco.mj_comPos(scenario.model.mj, data)
    offset = data.xpos[1] - data.subtree_com[1]
    spin = 1.5 * axes[2]
    expected = np.array(STATE.velocity) + 0.7 * axes[0] + np.cross(spin, offset)
    assert data.qvel[:3] == pytest.approx(expected)
    own = data.xmat[1].reshape(3, 3).T @ spin
    assert data.qvel[3:6] == pytest.approx(np.array(STATE.angular_velocity) + own)
    assert plain.qvel[:3].tolist() == list(STATE.velocity)


def test_a_state_is_of_a_body_as_heavy():
    """An adult's is no baby's, whose joints have the same names; unless somebody wants it so."""
    with pytest.raises(InputError) as error:
        beside(replace(STATE, mass=9.0))
    assert str(error.value) == (
        "start=prone is a state of a character of 9 kg, and this one has 70 kg; give the character "
        "of the run that it is from, or start.state.mass=null to start so all the same"
    )
    _, given = beside(replace(STATE, mass=70.0))
    _, plain = beside()
    assert given.qpos.tolist() == plain.qpos.tolist()


def test_scatter_is_another_state_each_seed():
    _, one = beside(scatter=0.05)
    _, plain = beside()
    apart = np.abs(one.qpos[7:] - plain.qpos[7:])
    assert 0.01 < apart.max() <= 0.05


@pytest.mark.parametrize("behaviour", ["backward_roll_1", "sideways_roll", "incline"])
def test_the_pitch_of_a_state_is_the_one_that_a_start_would_have(behaviour):
    made = build(load([f"behaviour={behaviour}", "duration=0.1"])).behaviour
    for said in (-2.5, 0.0, 1.0):
        orientation = tuple((-2.0 * made.start(said).orientation).tolist())
        known = Known(replace(STATE, orientation=orientation), np.zeros(1))
        assert pitch(known, made) == pytest.approx(said)


def refused(capsys, *arguments):
    """What `rotctl new` says of what it does not do."""
    assert main(["new", *arguments]) == 2
    return capsys.readouterr().err.removeprefix("rotctl: ").strip()


@pytest.mark.parametrize("at", ["30", "nan", "-1"])
def test_a_time_that_the_run_has_not(recorded, here, capsys, at):
    said = refused(capsys, "start", "there", "--from", str(recorded.path), "--at", at)
    assert said == f"--at={at}: the run has states from 0 to 0.58 s"
    assert not list(here.iterdir())


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (
            ("behaviour", "mine", "--from", "forward_roll", "--at", "1"),
            "--at=1: is a time of a run, and --from=forward_roll is none",
        ),
        (
            ("start", "mine", "--from", "rest", "--at", "1"),
            "--at=1: is a time of a run, and --from=rest is none",
        ),
        (
            ("start", "mine", "--from", "nothing"),
            "--from=nothing: no such start or run; valid: aloft, ",
        ),
        (("start", "rest", "--from", "."), ".: is a folder without run.h5; name a run, "),
    ],
)
def test_what_is_no_run(here, capsys, arguments, complaint):
    assert refused(capsys, *arguments).startswith(complaint)
    assert not list(here.iterdir())


def test_a_name_that_there_is_is_not_taken(recorded, here, capsys):
    said = refused(capsys, "start", "rest", "--from", str(recorded.path))
    assert said.startswith("rest: there is a start of that name: ")


def test_a_run_that_broke_down_says_so(recorded, here, tmp_path):
    qpos = recorded["trajectory/qpos"].copy()
    qpos[-1, 9] = np.nan
    broken = with_arrays(recorded, tmp_path, {"trajectory/qpos": qpos})
    with pytest.raises(LogError, match="its state there is not finite"):
        make("there", broken, None)
    make("before", broken, 0.5)


def test_a_state_under_water_is_no_start(here, tmp_path):
    folder = tmp_path / "dive"
    assert main(["run", "behaviour=dive_forward", "duration=4.3", "--out", str(folder)]) in (0, 1)
    dived = RunLog.open(next(folder.glob("*/run.h5")))
    with pytest.raises(
        InputError, match=r"^--at=4\.\d\d: the run is \d\.\d\d m below the ground then, "
    ):
        make("wet", dived, None)
    assert not (here / "conf").exists()
    make("dry", dived, 0.5)


def test_a_strangers_name_of_a_run_stays_in_its_comment(recorded, here, tmp_path):
    strange = with_arrays(recorded, tmp_path, run_id="x\npitch: [1.0, 1.0]")
    path = make("there", strange, None)
    assert yaml.safe_load(path.read_text())["pitch"] == [0.0, 0.0]
    assert path.read_text().startswith(
        '# From the run "x\\npitch: [1.0, 1.0]", character=adult_free_head, on '
    )


def test_a_log_whose_states_are_of_another_body_is_refused(recorded, here, tmp_path):
    other = yaml.safe_load(recorded.config_yaml)
    boxes = load(["behaviour=hazards"]).terrain
    other |= {"terrain": json.loads(json.dumps(to_dict(boxes))), "duration": 10.0}
    lying = with_arrays(recorded, tmp_path, config=yaml.safe_dump(other))
    with pytest.raises(LogError, match="its states are not those of its config's character"):
        make("there", lying, None)


NO_LENGTH = "orientation: must be at least 0.001 long, as 1, 0, 0, 0 is, which is upright"


@pytest.mark.parametrize(
    ("name", "column", "value", "complaint"),
    [
        ("qpos", slice(3, 7), 0.0, f"start.state.{NO_LENGTH}"),
        ("qpos", 0, 1e15, "start.state.place.0=1000000000000000.0: must be at most 1e+13 in size"),
        ("qpos", 9, 1e300, "start.state.pose.waist_z=1e+300: must be at most 1e+13 in size"),
        ("qvel", 1, -1e20, "start.state.velocity.1=-1e+20: must be at most 1e+13 in size"),
    ],
)
def test_a_strangers_state_that_would_not_load_is_not_written(
    recorded, here, tmp_path, name, column, value, complaint
):
    rows = recorded[f"trajectory/{name}"].copy()
    rows[-1, column] = value
    strange = with_arrays(recorded, tmp_path, {f"trajectory/{name}": rows})
    with pytest.raises(LogError) as caught:
        make("there", strange, None)
    assert str(caught.value) == f"{strange.path}: its state there makes no start: {complaint}"
    assert not (here / "conf").exists()


@pytest.mark.parametrize("at", [None, 0.5])
def test_times_that_are_none_choose_no_row(recorded, here, tmp_path, at):
    times = recorded["trajectory/time"].copy()
    times[3] = np.nan
    strange = with_arrays(recorded, tmp_path, {"trajectory/time": times})
    with pytest.raises(LogError) as caught:
        make("there", strange, at)
    assert str(caught.value) == f"{strange.path}: has times that are not finite"
    assert not (here / "conf").exists()


def test_a_time_of_three_hundred_digits_is_told_in_short(recorded, here, tmp_path):
    times = recorded["trajectory/time"].copy()
    times[-1] = 1e300
    strange = with_arrays(recorded, tmp_path, {"trajectory/time": times})
    assert ", at 1e+300 s; see" in make("there", strange, None).read_text()
    with pytest.raises(InputError, match=r"^--at=-1: the run has states from 0 to 1e\+300 s$"):
        make("other", strange, -1.0)


@pytest.mark.parametrize("w", [0, 0.0009])
def test_a_quaternion_of_no_length_is_refused(w):
    said = ",".join(
        ["place:[0,0]", "gap:0", f"orientation:[{w},0,0,0]", "velocity:[0,0,0]"]
        + ["angular_velocity:[0,0,0]", "pose:{}", "speeds:{}"]
    )
    with pytest.raises(InputError, match=rf"start\.state\.{NO_LENGTH}"):
        load(["start=rest", f"+start.state={{{said}}}"])


def test_an_unknown_joint_is_told_with_its_place():
    with pytest.raises(InputError, match=r"start\.state\.speeds names the unknown joint 'tail'"):
        beside(replace(STATE, speeds={"tail": 1.0}))
