"""Settings that can be read and mean nothing: one line that names the value and what is valid."""

import copy
from typing import get_args, get_type_hints

import pytest

from rotctl.behaviours.staged.aims import Aim
from rotctl.config.loading import composed
from rotctl.config.schema import check
from rotctl.control.kinds import KINDS
from rotctl.errors import LONGEST, InputError, LogError
from rotctl.log import RunLog
from rotctl.runs.run import run
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

STAND = ["behaviour=stand", "duration=1"]
LAWS = ", ".join(
    repr(get_args(get_type_hints(law)["law"])[0]) for law in get_args(get_args(Aim)[0])
)
CHAIN = ["behaviour=chain", "start=poised"]
PUSHED = [*STAND, "disturbance=push"]
BODIES = (
    "pelvis, waist, chest, head, upper_arm_l, forearm_l, upper_arm_r, forearm_r, thigh_l, shin_l, "
    "foot_l, thigh_r, shin_r, foot_r"
)


def complaint(chosen, changes):
    """What is said of a config with changes at some places; the run is begun."""
    data = composed(chosen)
    for key, value in changes.items():
        *path, last = key.split(".")
        inner = data
        for part in path:
            inner = inner[int(part)] if isinstance(inner, list) else inner[part]
        inner[last] = copy.deepcopy(value)
    with pytest.raises(InputError) as caught:
        next(iter(Episode(build(check(data)))))
    return str(caught.value)


@pytest.mark.parametrize(
    ("chosen", "changes", "message"),
    [
        (STAND, {"behaviour.tasks.balance.kind": "jump"},
         f"behaviour.tasks.balance: no kind 'jump'; valid: {', '.join(KINDS)}"),
        (STAND, {"behaviour.target_excursion": 90.0},
         "behaviour.target_excursion=90: stand is a motion of 0 deg"),
        (STAND, {"behaviour.tasks.pelvis.point": [0.1, 0.0, 0.0]},
         "behaviour.tasks.pelvis: a task of kind attitude has no point"),
        (STAND, {"behaviour.tasks.limits.point": [0.036, 0.1, 0.0]},
         "behaviour.tasks.limits: of the point of a task of kind limits the first acts alone"),
        (STAND, {"behaviour.tasks.pelvis.aim": {"law": "ground", "height": 0.1}},
         "behaviour.tasks.pelvis: the aim ground is for tasks of kind point, not attitude"),
        (STAND, {"behaviour.tasks.pelvis.body": "tail"},
         f"behaviour.tasks.pelvis.body names the unknown body 'tail'; bodies: {BODIES}"),
        (STAND, {"behaviour.tasks.balance.aim.law": "jump"},
         f"behaviour.tasks.balance.aim.law=\"jump\": no such law; valid: {LAWS}"),
        (STAND, {"behaviour.tasks.balance.aim.bodies": []},
         "behaviour.tasks.balance.aim.bodies=[]: too few values, at least 1"),
        (["behaviour=forward_roll", "+finish=stand"],
         {"behaviour.finish.tasks.balance.aim.bodies": []},
         "behaviour.finish.tasks.balance.aim.bodies=[]: too few values, at least 1"),
        (STAND[:1], {"behaviour.stages.0.until": {"kind": "touches", "bodies": []}},
         "behaviour.stages.0.until.bodies=[]: too few values, at least 1"),
        (["behaviour=cartwheel"], {"behaviour.stages.5.tasks.carry.aim.hands": []},
         "behaviour.stages.5.tasks.carry.aim.bodies=[]: too few values, as there are no hands "
         "either"),
        (["behaviour=stand_step"], {"behaviour.tasks.swing.aim.bodies": ["foot_l", "foot_l"]},
         "behaviour.tasks.swing.aim.bodies: names foot_l twice"),
        (["behaviour=forward_roll"], {"behaviour.reference.offsets.knee": [30.0]},
         "behaviour.reference.offsets.knee.0=30.0: must be less than or equal to 10"),
        (["behaviour=forward_roll", "+catch=arm"], {"behaviour.catch.out.elbow": -20.0},
         "behaviour.catch.out.elbow=-20.0: must be greater than or equal to -10"),
        (["behaviour=hazards"], {"terrain.box_aside": 7.0},
         "terrain.box_aside=7.0: must be less than or equal to 6"),
        (STAND, {"behaviour.tasks.spin.aim.task": "spin"},
         'behaviour.tasks.spin.aim.task="spin": no task of its stage with the aim capture; valid: '
         "balance"),
        (["behaviour=back_flip"],
         {"behaviour.stages.5.tasks.spin.aim": {"law": "lunge", "task": "ballance", "fade": 0.1}},
         'behaviour.stages.5.tasks.spin.aim.task="ballance": no task of its stage with the aim '
         "capture; valid: balance"),
        (["behaviour=back_flip"], {"behaviour.stages.3.tasks.whirl.aim.flight": "tuck"},
         'behaviour.stages.3.tasks.whirl.aim.flight="tuck": no stage that flies; valid: flight'),
        (["behaviour=back_flip"], {"behaviour.stages.3.tasks.whirl.aim.task": "plane"},
         'behaviour.stages.3.tasks.whirl.aim.task="plane": no task of its stage with the aim '
         "launch; valid: launch"),
        (["behaviour=pirouette"], {"behaviour.stages.2.until.turning": "spin"},
         'behaviour.stages.2.until.turning="spin": no task of its stage with the aim whirl; valid: '
         "whirl"),
        (["behaviour=back_flip"],
         {"behaviour.stages.5.otherwise": {"stage": "stand", "when": {
             "kind": "launched", "up": 1.0, "height": 1.0, "knee": 0.1, "turning": "spin"}}},
         'behaviour.stages.5.otherwise.when.turning="spin": no task of its stage with the aim '
         "whirl; valid: none"),
        (["behaviour=cartwheel"], {"behaviour.stages.2.tasks.carry.aim.hands": ["tail"]},
         "behaviour.stages.2.tasks.carry.aim.hands names the unknown body 'tail'; "
         f"bodies: {BODIES}"),
        (STAND, {"behaviour.tasks.balance.aim.bodies": ["tail"]},
         f"behaviour.tasks.balance.aim.bodies names the unknown body 'tail'; bodies: {BODIES}"),
        (["behaviour=baby_roll_over"], {"behaviour.stages.2.lead": 0.0},
         "behaviour.stages.2.beyond: the stage 'lie' must have poses and a lead, which is how far "
         "ahead they go"),
        (["behaviour=handstand"],
         {"behaviour.stages.1.beyond": {"gain": 0.5, "time": 1.0}, "behaviour.stages.1.lead": 0.1},
         "behaviour.stages.1.beyond: the stage 'bow' must have poses and a lead, which is how far "
         "ahead they go"),
        (STAND, {"behaviour.stages.0.lead": 1.0},
         "behaviour.stages.0.lead=1: the stage 'stand' has no poses that vary over the phase"),
        (["behaviour=back_flip"], {"behaviour.stages.3.lead": 0.5},
         "behaviour.stages.3.lead=0.5: the stage 'launch' has no poses that vary over the phase"),
        (STAND, {"behaviour.stages": []}, "behaviour.stages=[]: too few values, at least 1"),
        (["behaviour=chain", 'behaviour.parts=[stand,"stand_step criteria=rolling"]'], {},
         "behaviour.parts: 'stand_step criteria=rolling': criteria=rolling does not judge "
         "behaviour=stand_step, a behaviour of kind staged; choose criteria of kind standing, "
         "landing, getting_up, flip, dive, acrobatic, one_foot or orientation, such as "
         "criteria=cartwheel"),
        (PUSHED, {"disturbance.time": [5.0, 2.0]},
         "disturbance.time: the range [5, 2] is empty: low must not exceed high"),
        (PUSHED, {"disturbance.time": [1.0, 2.0, 3.0]},
         "disturbance.time=[1.0, 2.0, 3.0]: too many values, at most 2"),
        (PUSHED, {"disturbance.time": [1.0]}, "disturbance.time=[1.0]: must have 2 values"),
        (PUSHED, {"disturbance.direction": ["left", 2.0]},
         'disturbance.direction.0="left": must be a valid number'),
        (PUSHED, {"disturbance.direction": "left"},
         'disturbance.direction="left": must be a number or a range, [low, high]'),
        (["behaviour=forward_roll"], {"behaviour.pace.easing": 0.3},
         "behaviour.pace.easing=0.3: acts on nothing, as nothing tells it to halt, which is a 0 in "
         "pace.schedule; leave it at 0.5"),
        (["behaviour=chain", "behaviour.parts=[stand,tip_over,forward_roll]"],
         {"behaviour.parts.3.behaviour.pace.easing": 0.3},
         "behaviour.parts: 'forward_roll': behaviour.pace.easing=0.3: acts on nothing, as nothing "
         "tells it to halt, which is a 0 in pace.schedule; leave it at 0.5"),
        (["behaviour=back_flip"], {"behaviour.stages.4.tasks.air_plane.body": "tail"},
         "behaviour.stages.4.tasks.air_plane.body names the unknown body 'tail'; "
         f"bodies: {BODIES}"),
        (["behaviour=forward_roll", "+finish=stand"], {"behaviour.finish.tasks.sole.body": "tail"},
         f"behaviour.finish.tasks.sole.body names the unknown body 'tail'; bodies: {BODIES}"),
        (["behaviour=back_flip"], {"behaviour.stages.4.flight.shapes": {"tuck": {"hip_y": 1.0}}},
         "behaviour.stages.4.flight.shapes: tuck is flown by the pose of that name, beside them"),
        (["behaviour=back_flip"], {"criteria.landing.feet": ["tail"]},
         f"criteria.landing.feet names the unknown body 'tail'; bodies: {BODIES}"),
        (["behaviour=forward_roll", "+finish=stand"], {"criteria.stand.feet": ["tail"]},
         f"criteria.stand.feet names the unknown body 'tail'; bodies: {BODIES}"),
        (STAND, {"criteria.feet": ["foot"]},
         f"criteria.feet names the unknown body 'foot'; did you mean foot_r? bodies: {BODIES}"),
        (PUSHED, {"disturbance.duration": 1e-300},
         "disturbance.duration=1e-300: must be greater than or equal to 0.001"),
        (PUSHED, {"disturbance.time": [-1.0, 1.0]},
         "disturbance.time: must not begin before the run does, at 0 s"),
        (PUSHED, {"disturbance.time": [1.0, 2.0]}, "disturbance.time: the push begins at 1 s at "
         "the earliest, when the run of 1 s is over"),
        ([*STAND, "disturbance=load"], {"disturbance.mass": -60.0, "disturbance.time": 0.0},
         "disturbance.mass=-60: chest has 15.1 kg"),
        ([*STAND, "disturbance=slippery"], {"disturbance.friction": [0.0, 1.0]},
         "disturbance.friction=[0.0, 1.0]: must be a factor above 0 and at most 100"),
        ([*STAND, "disturbance=slippery"],
         {"disturbance.friction": [0.5, 4.0], "disturbance.time": 0.0,
          "plant.friction": [1.0, 3.0]},
         "disturbance.friction=[0.5, 4.0]: with terrain.friction=1 and plant.friction=[1.0, 3.0] "
         "the ground has 0.5 to 12, valid: 1e-05, the least that MuJoCo has, to 10"),
        (STAND, {"plant.friction": [0.0, 1.0]},
         "plant.friction=[0.0, 1.0]: must be factors above 0 and at most 100"),
        (STAND, {"physics.contact_solimp": [0.9, 1.0, 0.001, 0.5, 2.0]},
         "physics.contact_solimp.1=1: MuJoCo takes the nearest of 0.0001 to 0.9999; give one of "
         "them"),
        (STAND, {"physics.contact_solimp": [0.9, 0.95, 0.001, 0.5, 0.5]},
         "physics.contact_solimp.4=0.5: MuJoCo takes 1; give that or more"),
        (STAND, {"physics.contact_solref": [0.001, 1.0]},
         "physics.contact_solref.0=0.001: MuJoCo takes two physics steps, 0.008333 s; give that "
         "or more"),
        (STAND, {"character.limit_solref": [0.001, 1.0]},
         "character.limit_solref.0=0.001: MuJoCo takes two physics steps, 0.008333 s; give that "
         "or more"),
        (STAND, {"character.trunk": ["chest", "waist", "chest"]},
         "character.trunk: names chest twice"),
        (STAND, {"character.exclude_from_control": ["head", "head"]},
         "character.exclude_from_control: names head twice"),
        ([*STAND, "plant=varied"], {"terrain.friction": 10.0},
         "plant.friction=[0.9, 1.1]: with terrain.friction=10 the ground has 9 to 11, valid: "
         "1e-05, the least that MuJoCo has, to 10"),
        (STAND, {"plant.friction": [1.0, 50.0]},
         "plant.friction=[1.0, 50.0]: with terrain.friction=1 the ground has 1 to 50, valid: "
         "1e-05, the least that MuJoCo has, to 10"),
        (STAND, {"terrain.friction": 9e-6},
         "terrain.friction=9e-06: valid: 1e-05, the least that MuJoCo has, to 10"),
        ([*STAND, "disturbance=slippery"],
         {"disturbance.friction": 1e-6, "disturbance.time": 0.0},
         "disturbance.friction=1e-06: with terrain.friction=1 the ground has 1e-06 to 1e-06, "
         "valid: 1e-05, the least that MuJoCo has, to 10"),
        (STAND, {"physics.disable": ["autoreset", "autoreset"]},
         "physics.disable: names autoreset twice"),
        (STAND, {"behaviour.tasks.balance.aim.bodies": ["foot", "foot"]},
         "behaviour.tasks.balance.aim.bodies: names foot twice"),
        ([*STAND, "disturbance=load"], {"disturbance.mass": 1e9},
         "disturbance.mass=1000000000.0: must be at most 1000 kg"),
        ([*STAND, "disturbance=load"],
         {"controller.sees_disturbance": True, "disturbance.time": 0.0},
         "controller.sees_disturbance is about forces, and disturbance=load has none: control "
         "goes on with the model that it knows"),
        ([*STAND, "disturbance=load"], {"disturbance.time": 2.0}, "disturbance.time: the load "
         "begins at 2 s at the earliest, when the run of 1 s is over"),
        ([*PUSHED, "terrain=obstacles"], {"disturbance.body": "box_0"},
         f"disturbance.body names the unknown body 'box_0'; bodies: {BODIES}"),
        (STAND, {"criteria.feet": []}, "criteria.feet=[]: too few values, at least 1"),
        (["behaviour=handstand"], {"criteria.held.bodies": ["forearm_l", "forarm_r"]},
         "criteria.held.bodies names the unknown body 'forarm_r'; did you mean forearm_r? "
         f"bodies: {BODIES}"),
        (["behaviour=handstand"], {"criteria.order": [["forearm_l", "forearm_l"]]},
         "criteria.order.0: names forearm_l twice"),
        (["behaviour=dive_forward"], {"criteria.straight": {}},
         "criteria.straight={}: too few values, at least 1"),
        (["behaviour=dive_forward"], {"criteria.straight": {"tail": 0.0}},
         "criteria.straight names the unknown joint 'tail'; valid: ankle_x, ankle_y, chest_x, "
         "chest_y, chest_z, elbow, hip_x, hip_y, hip_z, knee, neck_x, neck_y, neck_z, shoulder_x, "
         "shoulder_y, shoulder_z, waist_x, waist_y, waist_z, limb joints also with _l or _r"),
        (["behaviour=dive_forward"], {"criteria.straight.shoulder_y": 180.0},
         "criteria.straight.shoulder_y=180: this joint goes from -1 to 3.1 rad"),
        (["behaviour=dive_forward"], {"behaviour.heading": 90.0},
         "behaviour.heading=90: never comes over the edge of terrain=pool, which is towards +x; "
         "give less than 90 to either side of 0"),
        (["behaviour=dive_armstand_backward"], {"behaviour.heading": 0.0},
         "behaviour.heading=0: never comes over the edge of terrain=pool_hands, which is towards "
         "+x; give less than 90 to either side of 180"),
        ([*CHAIN, "behaviour.parts=['dive_forward behaviour.heading=120']", "terrain=pool"], {},
         "behaviour.parts: 'dive_forward behaviour.heading=120': behaviour.heading=120: never "
         "comes over the edge of terrain=pool, which is towards +x; give less than 90 to either "
         "side of 0"),
        ([*CHAIN, "behaviour.parts=[dive_forward]", "terrain=pool"],
         {"behaviour.parts.0.behaviour.heading": 90.0, "behaviour.parts.0.said": ""},
         "behaviour.parts.0.behaviour.heading=90: never comes over the edge of terrain=pool, which "
         "is towards +x; give less than 90 to either side of 0"),
        (STAND, {"start.postures.left.pose.knee": 90.0},
         "start.postures.left.pose.knee=90: this joint goes from -0.02 to 2.7 rad"),
        (["behaviour=flight"], {"start.aloft.pose.elbow": -1.0},
         "start.aloft.pose.elbow=-1: this joint goes from -0.02 to 2.5 rad"),
        (["behaviour=land"], {"start.falling.landing.pose.knee": 3.0},
         "start.falling.landing.pose.knee=3: this joint goes from -0.02 to 2.7 rad"),
        (["behaviour=land"], {"start.falling.landing.bodies": []},
         "start.falling.landing.bodies=[]: too few values, at least 1"),
        (STAND, {"start.tilt": 30.0},
         "start.tilt=30.0: must be less than or equal to 3.15"),
        (["behaviour=hazards"], {"terrain.bar_height": [-0.01, 0.06]},
         "terrain.bar_height=[-0.01, 0.06]: must not be negative"),
        (["behaviour=hazards"], {"terrain.bar_depth": [0.0, 0.3]},
         "terrain.bar_depth=[0, 0.3]: must be more than 0"),
        (["behaviour=hazards"], {"terrain.box_edge": [-0.1, 0.3]},
         "terrain.box_edge=[-0.1, 0.3]: must be more than 0"),
        (STAND, {"behaviour.tasks.\x1b[31m": {"kind": "limits"}},
         'behaviour.tasks.\x1b[31m.kind="limits": a key must be printable and have at most 200 '
         "characters"),
    ],
)  # fmt: skip
def test_it_is_refused(chosen, changes, message):
    assert complaint(chosen, changes) == message


def test_names_may_have_any_letters(tmp_path):
    data = composed(STAND)
    for body in data["character"]["bodies"]:
        for joint in body["joints"] if body["name"] == "head" else ():
            joint["name"] = joint["name"].replace("neck_z", "cou_à_gauche")
    made = run(check(data), tmp_path).folder
    assert "cou_à_gauche".encode() in RunLog.open(made / "run.h5")["model/joint"].tolist()


def test_a_long_name_is_cut_at_a_whole_letter(tmp_path):
    """A log has room for 64 bytes of each."""
    data, long = composed(STAND), "x" + 50 * "é"
    for body in data["character"]["bodies"]:
        for joint in body["joints"] if body["name"] == "head" else ():
            joint["name"] = joint["name"].replace("neck_z", long)
    made = run(check(data), tmp_path).folder
    assert long[:32].encode() in RunLog.open(made / "run.h5")["model/joint"].tolist()


def test_a_shape_that_is_not_flown_has_joints_too():
    changes = {"behaviour.stages.4.flight.shapes.pike.tail": 1.0}
    said = complaint(["behaviour=dive_forward"], changes)
    assert said.startswith(
        "behaviour.stages.4.flight.shapes.pike names the unknown joint 'tail'; valid: "
    )


@pytest.mark.parametrize(
    "key",
    ["behaviour.tasks.balance.kind", "behaviour.tasks.balance.aim.law", "criteria.kind",
     "behaviour.stages.0.name", "behaviour.tasks.spin.aim.task", "controller.solver"],
)  # fmt: skip
def test_a_message_does_not_repeat_a_megabyte(key):
    said = complaint(STAND, {key: "a" * 10**6})
    assert said == (
        f'{key}="{"a" * 56}...: must be printable, on one line of at most 200 characters'
    )


@pytest.mark.parametrize("key", [1.5, True, None, 3])
def test_a_key_that_is_no_text(key):
    """Hydra takes them from a file."""
    data = composed(STAND)
    data["behaviour"][key] = 1
    with pytest.raises(InputError, match="keys should be strings"):
        check(data)


def test_nor_does_one_of_keys():
    said = complaint(STAND, {"behaviour.tasks." + "a" * 10**6: {"kind": "limits"}})
    assert said == (
        f'behaviour.tasks.{"a" * 57}....kind="limits": a key must be printable and have at most '
        "200 characters"
    )


@pytest.mark.parametrize("kind", [InputError, LogError])
def test_no_error_is_longer_than_a_screen(kind):
    assert str(kind("a" * 10**6)) == "a" * (LONGEST - 3) + "..."
    assert str(kind("a" * LONGEST)) == "a" * LONGEST


def test_a_stop_that_a_choice_brings_along_may_be_shorter_than_steps_that_are_told():
    scenario = build(check(composed(["physics.substeps=1", "duration=0.5"])))
    assert scenario.config.physics.contact_solref[0] < 2.0 * scenario.model.mj.opt.timestep


def test_things_that_are_not_there_have_any_size():
    data = composed(["behaviour=hazards"])
    data["terrain"] |= {"bars": 0, "bar_depth": [0.0, 0.0]}
    check(data)
    data["terrain"] |= {"bars": 3, "bar_depth": [0.2, 0.3], "boxes": 0, "box_edge": [0.0, 0.0]}
    check(data)


def test_half_a_turn_may_be_rounded():
    data = composed(STAND)
    data["start"]["tilt"] = 3.1416
    check(data)


def test_a_start_that_comes_along_lands_as_a_body_of_other_joints_can():
    data = composed(["behaviour=land"])
    for body in data["character"]["bodies"]:
        for joint in body["joints"] if body["name"].startswith("forearm") else ():
            joint["range"] = [0.0, 0.3]
    Episode(build(check(data)))
