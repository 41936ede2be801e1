"""Overrides to a typed config, or to one line that names the value and what would be valid."""

import copy
import json
import math
import shutil
from dataclasses import FrozenInstanceError, asdict

import mujoco
import pytest
import yaml

from rotctl.choices import composing, config_folders
from rotctl.choices.composing import simple
from rotctl.choices.config_folders import conf_dir
from rotctl.choices.describing import groups
from rotctl.choices.overrides import single
from rotctl.config.loading import _by_hydra as by_hydra
from rotctl.config.loading import composed, load
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.runs.scenario import build
from rotctl.settings.writing import to_dict, to_yaml

GROUPS = (
    "behaviour, character, controller, criteria, disturbance, excursion, physics, plant, start, "
    "terrain, seed, duration"
)
NOT_READ = (
    "cannot be read; write key=value, and quote a text with special characters: \"key='a text'\""
)

STARTS = (
    "aloft, armstand, falling, long, poised, prone, raised, rest, running, side, standing, still, "
    "supine, symmetric, tucked, tucked_back"
)


def complaint(*overrides):
    with pytest.raises(InputError) as caught:
        load(list(overrides))
    assert caught.value.exit_code == 2
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_the_defaults_are_those_of_the_issue():
    config = load([])
    assert (config.seed, config.duration) == (0, 20.0)
    assert config.behaviour.name == "forward_roll_1"
    assert (config.behaviour.angular_velocity, config.behaviour.speed) == (1.3, 1.2)
    assert (config.controller.solver, config.controller.form) == ("boxqp", "condensed")
    assert config.controller.rate == 60.0
    assert config.physics.jacobian == "dense"
    assert config.start.name == "tucked"
    assert config.start.pitch == (-0.6, 0.0)


@pytest.mark.parametrize(
    ("override", "path", "value"),
    [
        ("seed=3", "seed", 3),
        ("++seed=3", "seed", 3),
        ("duration=5", "duration", 5.0),
        ("duration=1e1", "duration", 10.0),
        ("start=rest", "start.name", "rest"),
        ("controller.solver=qpsolvers:daqp", "controller.solver", "qpsolvers:daqp"),
        ("controller.tasks.linear.damping=[1,2,3]", "controller.tasks.linear.damping", (1, 2, 3)),
        ("controller.pose={damping: 7}", "controller.pose.damping", 7.0),
        ("behaviour.poses.a.knee=[1,2,3]", "behaviour.poses.a.knee", (1, 2, 3)),
        ("+behaviour.poses.a.hip_z=0.1", "behaviour.poses.a.hip_z", 0.1),
        ("physics.disable=[]", "physics.disable", ()),
    ],
)
def test_overrides_reach_the_config(override, path, value):
    found = to_dict(load([override]))
    for part in path.split("."):
        found = found[part]
    assert found == value


def test_a_key_that_may_be_missing_can_be_removed():
    assert "hip_x" in load([]).behaviour.poses.a
    assert "hip_x" not in load(["~behaviour.poses.a.hip_x"]).behaviour.poses.a


@pytest.mark.parametrize(
    ("override", "message"),
    [
        # Keys.
        ("sed=1", f"unknown key 'sed'; did you mean seed? valid keys: {GROUPS}"),
        ("+x=1", f"unknown key 'x'; valid keys: {GROUPS}"),
        ("++x.y=1", f"unknown key 'x'; valid keys: {GROUPS}"),
        ("~x", f"unknown key 'x'; valid keys: {GROUPS}"),
        ("controler.rate=60", "unknown key 'controler.rate'; did you mean controller? "
                              f"valid keys: {GROUPS}"),
        ("controllr=rolling", "unknown key 'controllr'; did you mean controller? "
         f"valid keys: {GROUPS}"),
        ("behaviour@x=forward_roll_1", "unknown key 'behaviour@x'; did you mean behaviour? "
         f"valid keys: {GROUPS}"),
        (
            "controller.pose.dampin=1",
            "unknown key 'controller.pose.dampin'; did you mean damping? "
            "valid keys under controller.pose: "
            "stiffness, damping, horizon, weight, blend, explicit",
        ),
        (
            "behaviour.reference.clip=x",
            "unknown key 'behaviour.reference.clip'; valid keys under behaviour.reference: "
            "none, it is null",
        ),
        ("+seed=1", "seed is there already; write seed=VALUE"),
        ("+start=rest", "start is there already; write start=VALUE"),
        ("~seed=1", "override '~seed=1': to remove a key, write ~seed"),
        ("~start=rest", "override '~start=rest': to remove a key, write ~start"),
        (
            "behaviour.poses.a={hips: 1.0}",
            'behaviour.poses.a={"hips": 1.0}: has keys that are not there yet; '
            "write +behaviour.poses.a=VALUE",
        ),
        ("behaviour.reference={clip: x}",
         "behaviour.reference.window: missing, it cannot be left out"),
        (
            "controller.tasks.linear.damping={a: 1}",
            'controller.tasks.linear.damping={"a": 1}: must be a list, in brackets',
        ),
        ("a." * 100 + "a=1",
         f"override '{'a.' * 28}a...': its key is longer than 200 characters"),
        (
            "controller.tasks.linear.damping.x=3",
            "unknown key 'controller.tasks.linear.damping.x'; valid keys under "
            "controller.tasks.linear.damping: 0 to 2",
        ),
        ("~seed", "seed: missing, it cannot be left out"),
        ("seed=???", "seed: missing, give it as seed=VALUE"),
        (
            "reference=humanoid3d_roll",
            "reference is no part of a config, its choices are added to one: "
            "write +reference=CHOICE",
        ),
        (
            "finish=stand",
            "finish is no part of a config, its choices are added to one: write +finish=CHOICE",
        ),
        ("~finish", "finish is no part of a config, and here it has added nothing to remove"),
        ("~behaviour.finish", "~behaviour.finish: nothing is there to leave out"),
        (
            "start.postures.left=1",
            "unknown key 'start.postures.left'; valid keys under start.postures: none, it is empty",
        ),
        ("+reference=nope", 'reference="nope": no such choice; valid: humanoid3d_roll'),
        ("~physics", "physics: missing, it cannot be left out"),
        # Choices.
        ("start=foo", 'start="foo": no such choice; valid: ' + STARTS),
        ("start=", 'start="": no such choice; valid: ' + STARTS),
        ("start=null", "start=null: no such choice; valid: " + STARTS),
        ("start=[rest]", 'start=["rest"]: no such choice; valid: ' + STARTS),
        ("start=../start/rest", 'start="../start/rest": no such choice; valid: ' + STARTS),
        # Values: one of each kind here, more below.
        ("seed=a", 'seed="a": must be a valid integer'),
        ("duration=inf", "duration=inf: must be a finite number"),
        ("physics.substeps=0", "physics.substeps=0: must be greater than or equal to 1"),
        (
            "controller.tasks.linear.damping=[1,2]",
            "controller.tasks.linear.damping=[1, 2]: must have 3 values",
        ),
        ("controller.form=foo", "controller.form=\"foo\": must be 'condensed' or 'literal'"),
        # Syntax.
        ("seed", "override 'seed' has no '='; write key=value, such as seed=3"),
        ("", "override '' has no '='; write key=value, such as seed=3"),
        ("=1", "override '=1' has no key; write key=value, such as seed=3"),
        ("séed=1", f"override 'séed=1': {NOT_READ}"),
        ('seed="a', f"override 'seed=\"a': {NOT_READ}"),
        ("seed=1\n2", f"override 'seed=1\\n2': {NOT_READ}"),
        ("seed=\0", f"override 'seed=\\x00': {NOT_READ}"),
        ("seed=1,2", "override 'seed=1,2': run takes one value for seed; rotctl sweep takes many"),
        (
            "physics=mujoco,x",
            "override 'physics=mujoco,x': run takes one value for physics; rotctl sweep takes many",
        ),
        (
            "seed=range(1,3)",
            "override 'seed=range(1,3)': run takes one value for seed; rotctl sweep takes many",
        ),
        (
            "behaviour={}",
            "override 'behaviour={}' changes nothing; give a value, or remove a key with ~key",
        ),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_that_helps(override, message):
    assert complaint(override) == message


def test_a_key_that_is_left_out_is_told_to_be_added():
    """Where settings have it and the value is one for it; else it is not known."""
    assert complaint("behaviour=chain", "behaviour.again=0.3") == (
        "behaviour.again is not there yet; write +behaviour.again=VALUE"
    )
    unknown = "unknown key 'behaviour.again'; valid keys under behaviour: name, kind, parts, "
    assert complaint("behaviour=chain", "behaviour.again=-1").startswith(unknown)
    assert complaint("behaviour.poses.a.nose=1").startswith(
        "unknown key 'behaviour.poses.a.nose'; valid keys under behaviour.poses.a: waist_y, "
    )


@pytest.fixture(scope="module")
def plain():
    """The default config as plain data, as Hydra composes it."""
    return json.loads(json.dumps(to_dict(load([]))))


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        # Choices.
        (
            "controller.supervisor",
            "no",
            "\"no\": must be 'as_written', 'modified', 'minimal', 'convex_hull', 'simulated', "
            "'simulated_free' or 'none'",
        ),
        ("physics.jacobian", "sparse", "\"sparse\": must be 'dense'"),
        # Types.
        ("seed", "", '"": must be a valid integer'),
        ("seed", 1.5, "1.5: must be a valid integer"),
        ("seed", True, "true: must be a valid integer"),
        ("seed", None, "null: must be a valid integer"),
        ("seed", [1, 2], "[1, 2]: must be a valid integer"),
        ("duration", "1", '"1": must be a valid number'),
        ("duration", True, "true: must be a valid number"),
        ("controller.pose", 3, "3: must be keys with values"),
        ("controller.solver", 3, "3: must be a valid string"),
        ("behaviour.poses.a.knee", "x", '"x": must be a valid number'),
        ("physics.disable", "autoreset", '"autoreset": must be a list, in brackets'),
        # Numbers.
        ("seed", -1, "-1: must be greater than or equal to 0"),
        ("seed", 2**63, f"{2**63}: must be less than {2**63}"),
        ("duration", 0, "0: must be greater than 0"),
        ("duration", -1.0, "-1.0: must be greater than 0"),
        ("duration", -math.inf, "-inf: must be a finite number"),
        ("duration", math.nan, "nan: must be a finite number"),
        ("duration", 1e9, "1000000000.0: must be less than or equal to 3600"),
        ("controller.pose.weight", -1, "-1: must be greater than or equal to 0"),
        ("terrain.friction", 0, "0: must be greater than 0"),
        ("character.root_height", 1e9, "1000000000.0: must be less than or equal to 10"),
        ("behaviour.poses.a.knee", 1e9, "1000000000.0: must be less than or equal to 10"),
        ("behaviour.speed", 1e308, "1e+308: must be at most 1e+13 in size"),
        ("character.mass", 1e-300, "1e-300: must be 0 or at least 1e-30 in size"),
        ("behaviour.speed", -5e-324, "-5e-324: must be 0 or at least 1e-30 in size"),
        # Texts.
        ("behaviour.name", "", '"": must not be empty'),
        (
            "behaviour.name",
            "a\x1b[31m",
            '"a\\u001b[31m": must be printable, on one line of at most 200 characters',
        ),
        ("start.name", "a\nb", '"a\\nb": must be printable, on one line of at most 200 characters'),
        ("behaviour.description", "a\0", '"a\\u0000": must have no control characters'),
        ("controller.rate", math.inf, "inf: must be a finite number"),
        # Lists.
        ("physics.gravity", [], "[]: must have 3 values"),
        ("physics.contact_solref", [1, 2, 3], "[1, 2, 3]: too many values, at most 2"),
        ("character.bodies", [], "[]: too few values, at least 1"),
    ],
)
def test_bad_values_are_named_with_what_would_be_valid(plain, key, value, message):
    data = copy.deepcopy(plain)
    inner = data
    *path, last = key.split(".")
    for part in path:
        inner = inner[part]
    inner[last] = value
    with pytest.raises(InputError) as caught:
        check(data)
    assert str(caught.value) == f"{key}={message}"


def test_a_choice_is_not_blamed_for_another_key():
    assert complaint("behaviour=stand", "~controller.tasks.jump").startswith(
        "unknown key 'controller.tasks.jump'; valid keys under controller.tasks: linear, "
    )


def test_a_value_that_a_check_of_our_own_names_is_not_repeated(plain):
    data = copy.deepcopy(plain)
    data["start"]["pitch"] = [1, 0]
    with pytest.raises(InputError) as caught:
        check(data)
    assert str(caught.value) == ("start.pitch: the range [1, 0] is empty: low must not exceed high")


def test_a_bad_value_in_a_list_is_named_by_its_place(plain):
    data = copy.deepcopy(plain)
    data["controller"]["tasks"]["linear"]["damping"][2] = math.nan
    with pytest.raises(InputError) as caught:
        check(data)
    assert str(caught.value) == "controller.tasks.linear.damping.2=nan: must be a finite number"


@pytest.mark.parametrize(
    "override",
    ["behaviour._target_=os.system", "+behaviour={_target_: os.system}", "start=${oc.env:HOME}"],
)
def test_nothing_in_a_config_is_executed_or_looked_up(override):
    assert complaint(override) == (
        f"override {override!r}: interpolations and _target_ are not honoured; give a value"
    )


@pytest.mark.parametrize("override", ["hydra.run.dir=x", "+hydra.x=1", "hydra/launcher=basic"])
def test_hydra_itself_cannot_be_configured(override):
    assert complaint(override) == (
        f"override {override!r}: Hydra's own settings cannot be changed here"
    )


@pytest.mark.parametrize("value", ["1" * 10**7, "x" * 10**7, "[" * 10**6])
def test_a_huge_override_is_refused_at_once_and_not_repeated(value):
    message = complaint(f"seed={value}")
    assert message.startswith(f"override 'seed={value[:50]}")
    assert message.endswith("...': longer than 10000 characters")
    assert len(message) < 120


def test_deep_nesting_is_refused():
    for value in ("[" * 3000, "{a:" * 100 + "1" + "}" * 100, "[" * 13 + "]" * 13):
        message = complaint(f"seed={value}")
        shown = f"seed={value}" if len(value) < 50 else f"{f'seed={value}':.57}..."
        assert message == f"override {shown!r}: nested more than 12 deep"


def test_a_long_value_is_not_repeated():
    joints = ",".join(f"joint_{i}: 1" for i in range(700))
    assert complaint(f"behaviour.poses.a={{{joints}}}") == (
        'behaviour.poses.a={"joint_0": 1, "joint_1": 1, "joint_2": 1, "joint_3": 1, ...: '
        "has keys that are not there yet; write +behaviour.poses.a=VALUE"
    )


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("~behaviour.pace", "~behaviour.pace: nothing is there to leave out"),
        ("seed@x=1", "unknown key 'seed@x'; did you mean seed? valid keys: "),
        ("~finish", "finish is no part of a config, and here it has added nothing to remove"),
        ("~physics.gravity.0", "~physics.gravity.0: of a list none can be left out; give the "),
    ],
)
def test_what_is_told_is_the_override_that_is_wrong(override, message):
    assert complaint("duration=5.0", override, "seed=3").startswith(message)


def test_the_last_of_equal_overrides_wins():
    assert load(["seed=1", "seed=2"]).seed == 2


def test_yaml_holds_the_whole_config():
    config = load(["seed=3", "start=rest"])
    assert check(yaml.safe_load(to_yaml(config))) == config
    assert list(yaml.safe_load(to_yaml(config))) == GROUPS.split(", ")
    whole = asdict(config)
    for body in whole["character"]["bodies"]:
        for joint in body["joints"]:  # of what a joint may have and has not, nothing is said
            assert {joint.pop(name) for name in ("damping", "armature", "spring")} == {None}
        assert {geom.pop("hull") for geom in body["geoms"]} == {None}
    assert whole["start"].pop("state") is None
    assert to_dict(config) == whole


def test_a_config_does_not_change():
    with pytest.raises(FrozenInstanceError):
        load([]).seed = 1


def test_plain_data_is_checked_the_same_way(plain):
    data = copy.deepcopy(plain)
    data["physics"]["substep"] = 1
    with pytest.raises(
        InputError,
        match=r"^unknown key 'physics\.substep'; did you mean substeps\? valid keys under ",
    ):
        check(data)
    data["character"]["bodies"][0]["geoms"][0]["sizes"] = data["physics"].pop("substep")
    with pytest.raises(
        InputError,
        match=r"^unknown key 'character\.bodies\.0\.geoms\.0\.sizes'; did you mean size\? "
        r"valid keys under character\.bodies\.0\.geoms\.0: "
        r"name, size, start, mass, end, hull, colour$",
    ):
        check(data)


def test_a_reference_is_added_to_a_behaviour():
    plain = load(["behaviour=reference_roll"]).behaviour.reference
    bent = load(["behaviour=reference_roll", "+reference=humanoid3d_roll"]).behaviour.reference
    assert plain.clip == bent.clip == "forward_roll_2"
    assert not plain.offsets
    assert bent.offsets["neck_y"][0] > 1.0
    assert bent.lead != plain.lead


@pytest.mark.parametrize(
    ("offsets", "said"),
    [
        ("{knee: 0.2}", "behaviour.reference.offsets.knee=0.2: must be a list, in brackets"),
        ("{knee: []}", "behaviour.reference.offsets.knee=[]: too few values, at least 1"),
    ],
)
def test_bad_offsets_are_one_line(offsets, said):
    with pytest.raises(InputError) as caught:
        load(["behaviour=forward_roll_2", f"+behaviour.reference.offsets={offsets}"])
    assert str(caught.value) == said


# ---------------------------------------------------------------- composed once, set many times


@pytest.mark.parametrize(
    "overrides",
    [
        [],
        ["seed=3"],
        ["behaviour=decline", "duration=5", "terrain.angle=4"],
        ["duration=5", "behaviour=back_flip", "plant=varied", "plant.mass=0.05"],
        ["start.speed_x=[0,1]", "start=rest"],
        ["start=rest", "start.speed_x=[0,1]", "seed=1", "seed=2"],
        ["controller.tasks.spin.stiffness.1=300"],
        ["behaviour.poses.b=null", "terrain.name='a, b'"],
        ["+behaviour.poses.a.hip_z=0.1", "seed=2"],
        ["disturbance=push", "disturbance.direction=30", "++disturbance.phase=90"],
    ],
)
def test_a_config_is_what_hydra_makes_of_all_its_overrides(overrides):
    found = [single(override) for override in overrides]
    for _ in "12":  # the second time the choices are composed already
        assert composed(overrides) == by_hydra(overrides, found)


def test_a_composed_config_may_be_changed_and_the_next_is_as_it_was():
    data = composed(["seed=1"])
    data["behaviour"]["name"] = "other"
    data["behaviour"].pop("speed")
    assert composed(["seed=1"]) == by_hydra(["seed=1"], [single("seed=1")])


def test_a_file_that_changed_is_read_again(tmp_path, monkeypatch):
    shutil.copytree(conf_dir(), tmp_path / "conf")
    (tmp_path / "package").mkdir()
    monkeypatch.setattr(config_folders, "__file__", str(tmp_path / "package/choices/here.py"))
    assert composed(["start=rest"])["start"]["pitch"] == [-0.3, 0.0]
    file = tmp_path / "conf" / "start" / "rest.yaml"
    file.write_text(file.read_text().replace("pitch: [-0.3, 0.0]", "pitch: [-0.2, 0.0]"))
    assert composed(["start=rest"])["start"]["pitch"] == [-0.2, 0.0]


# ---------------------------------------------------------------- without Hydra


def one_of_each():
    """Choices of all groups, each at least once; behaviours alone, as they bring others."""
    others = {group: [*names] for group, names in groups().items() if group not in BROUGHT}
    most = max(map(len, others.values()))
    mixed = [{g: names[i % len(names)] for g, names in others.items()} for i in range(most)]
    return [*({"behaviour": name} for name in groups()["behaviour"]), *mixed]


ADDED = [group for group in groups() if group not in composed([])]  # with a plus
BROUGHT = ("behaviour", *ADDED)
CHOICES = [
    *([f"{group}={name}" for group, name in some.items()] for some in one_of_each()),
    *(["behaviour=forward_roll", f"+{key}={name}"] for key in ADDED for name in groups()[key]),
    ["+finish=stand", "+course=slalom", "behaviour=forward_roll"],  # who is last asks first
    ["+course=slalom", "+finish=stand", "criteria=rolling"],
]


@pytest.mark.parametrize("overrides", CHOICES, ids=" ".join)
def test_what_choices_make_is_what_hydra_makes_of_them(overrides):
    made = composing.composed(map(simple, overrides))
    wanted = by_hydra(overrides, [single(text) for text in overrides])
    assert json.dumps(made) == json.dumps(wanted)  # the order too


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a=1", 1),
        ("a.b=-2", -2),
        ("a=1.50", 1.5),
        ("a=1.0e-3", 1e-3),
        ("a_1.b=some_word", "some_word"),
    ],
)
def test_a_simple_override_is_what_hydra_reads_in_it(text, value):
    found, assigned = simple(text), single(text)
    assert found == (str(assigned.key_or_group), assigned.value()) == (text.split("=")[0], value)
    assert type(found.value) is type(assigned.value()) is type(value)


@pytest.mark.parametrize(
    "text",
    ["a", "+a=1", "~a", "a=", "a=01", "a=1_0", "a=1e3", "a=.5", "a=true", "a=Null", "a=nan",
     "a=[1]",
     "a='x'", "a=x y", "a=1,2", "a@b=c", "a/b=c", "a[0]=1", "a.0=1", "a=x-y", "a=${b}", "hydra.a=1",
     "a=" + "9" * 30, "a=x:y", " a=1"],
)  # fmt: skip
def test_what_is_not_simple_is_left_to_hydra(text):
    assert simple(text) is None


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("start/rest.yaml", "pitch: 1e-1\n"),
        ("start/rest.yaml", "# @package _global_\n"),
        ("start/rest.yaml", "pitch: ???\n"),
        ("start/rest.yaml", "defaults: [tucked]\n"),
        ("start/rest.yaml", "defaults: [_self_, {start: tucked}]\n"),
        ("config.yaml", "defaults: [_self_, {start: rest}]\n"),
        ("finish/stand.yaml", "# @package _global_\n"),
        ("finish/stand.yaml", "# @package behaviour.finish\n# @package start\n"),
        ("finish/stand.yaml", "\n# @package behaviour.finish\nafter: 1.0\n"),
        ("finish/stand.yaml", "defaults: [{override /course@_global_.course: turn}]\n"),
        ("finish/other.yaml", "after: 1.0\n"),
    ],
)
def test_files_that_say_more_are_left_to_hydra(tmp_path, monkeypatch, file, text):
    shutil.copytree(conf_dir(), tmp_path / "conf")
    (tmp_path / "conf" / file).write_text(text)
    if file == "finish/other.yaml":  # is about another key than the one that builds on it
        stand = "# @package behaviour.finish\ndefaults: [other, _self_]\n"
        (tmp_path / "conf" / "finish" / "stand.yaml").write_text(stand)
    monkeypatch.setattr(config_folders, "__file__", str(tmp_path / "package/choices/here.py"))
    (tmp_path / "package").mkdir()
    assert composing.composed([simple("start=rest"), simple("+finish=stand")]) is None


@pytest.mark.parametrize(
    "overrides",
    [
        ["+finish=stand", "behaviour.finish.after=3", "seed=2"],
        ["behaviour.finish.after=3", "+finish=stand"],  # choices come first wherever they stand
        ["+course=circle", "behaviour.course.legs=[[1,20]]", "+behaviour.poses.a.hip_z=0.1"],
    ],
)
def test_values_are_set_on_what_is_added_as_hydra_does(overrides):
    assert composed(overrides) == by_hydra(overrides, [single(text) for text in overrides])


def test_an_own_choice_that_only_hydra_reads_can_be_added(tmp_path):
    (tmp_path / "course").mkdir()
    file = tmp_path / "course" / "mine.yaml"
    text = "# @package behaviour.course\ndefaults: [turn, _self_]\nschedule: [[1e0, 5]]\n"
    file.write_text(text)
    with config_folders.own(tmp_path):
        assert simple("+course=mine") == ("+course", "mine")
        assert composing.composed([simple("+course=mine")]) is None
        assert load(["+course=mine"]).behaviour.course.schedule == ((1.0, 5.0),)


@pytest.mark.parametrize(
    "text", ["+course=nope", "+seed=1", "+nobody=a", "++course=turn", "+a.b=c"]
)
def test_nothing_else_that_is_added_is_simple(text):
    assert simple(text) is None


@pytest.mark.parametrize(
    ("angle", "said"),
    [
        ("[0.1,0.2]", "behaviour.poses.a.knee=[0.1, 0.2]: too few values, at least 3"),
        ("[0,0,0,0]", "must be a mean with pairs of cosine and sine, not 4 numbers"),
        ("[0,20,0]", "behaviour.poses.a.knee.1=20: must be less than or equal to 10"),
        ("high", 'behaviour.poses.a.knee="high": must be a valid number'),
    ],
)
def test_what_is_wrong_with_an_angle_is_told(angle, said):
    with pytest.raises(InputError) as caught:
        load(["behaviour=forward_roll_1", f"behaviour.poses.a.knee={angle}"])
    assert said in str(caught.value)


def test_an_order_names_bodies_that_are_there():
    for order, said in (("[[nose]]", "unknown body 'nose'"), ("[]", "too few values")):
        with pytest.raises(InputError, match=said):
            build(load(["behaviour=back_handspring", f"criteria.order={order}"]))


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["behaviour=stand_step", "+behaviour.tasks.swing.aim.aside=0.1"],
            "behaviour.tasks.swing.aim.aside=0.1: acts on nothing, the foot is chosen by away; "
            "give aside=0 or away=0",
        ),
        (
            ["behaviour=stand_step", "+behaviour.tasks.swing.aim.narrow=0.5"],
            "behaviour.tasks.swing.aim.narrow=0.5: acts on nothing, the foot is chosen by away; "
            "give narrow=0 or away=0",
        ),
        (
            ["behaviour=stand_step", "behaviour.tasks.swing.aim.gather=0.1"],
            "behaviour.tasks.swing.aim.gather=0.1: must be 0 or more than width=0.16, which it "
            "comes to",
        ),
        (
            ["behaviour=cartwheel", "behaviour.stages.6.tasks.step_down.aim.room=0"],
            "behaviour.stages.6.tasks.step_down.aim.short=0.08: acts on nothing without room; "
            "give short=0",
        ),
    ],
)
def test_a_setting_that_would_act_on_nothing_is_refused(overrides, message):
    with pytest.raises(InputError) as error:
        load(overrides)
    assert str(error.value) == message


@pytest.mark.parametrize("sign", ["", "+"])
def test_keys_of_what_may_be_null_are_listed(sign):
    with pytest.raises(InputError) as error:
        load(["behaviour=decline", f"{sign}behaviour.pace.halt=1"])
    assert "valid keys under behaviour.pace: keep, travel, own, " in str(error.value)


def test_of_two_choices_that_are_added_the_later_one_counts():
    roll, seat, rest = "behaviour=forward_roll", "+finish=seat", ["+course=circle", "+finish=stand"]
    assert load([roll, seat, *rest]) == load([roll, *rest])
    assert load([roll, seat, "finish=stand"]) == load([roll, "+finish=stand"])


@pytest.mark.parametrize(
    ("key", "one", "other"),
    [
        ("character.flesh.bodies", "[chest,thigh]", "[thigh,chest]"),
        ("character.exclude_from_control", "[head,foot_l,foot_r]", "[foot_r,head,foot_l]"),
        ("physics.disable", "[autoreset,warmstart]", "[warmstart,autoreset]"),
    ],
)
def test_an_order_that_acts_on_nothing_makes_no_other_config(key, one, other):
    assert load([f"{key}={one}"]) == load([f"{key}={other}"])


def test_a_flag_of_the_engine_is_one_however_it_is_written():
    """Flags are added up: the first, told twice, would be another one."""
    flags = build(load(["physics.disable=[warmstart,autoreset]"])).model.mj.opt.disableflags
    kinds = mujoco.mjtDisableBit
    assert flags == int(kinds.mjDSBL_AUTORESET) | int(kinds.mjDSBL_WARMSTART)
