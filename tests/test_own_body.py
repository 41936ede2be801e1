"""`character: {kind: mjcf, file: robot.xml}`: somebody's model as a choice of a config."""

from xml.etree import ElementTree

import pytest
import yaml
from captures import adult
from test_adopt import text

from rotctl.choices import config_folders
from rotctl.choices.config_folders import own
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.run import make, run
from rotctl.runs.scenario import build
from rotctl.settings.writing import to_dict

INLINE = "character={kind: mjcf, file: robot.xml}"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A folder with a model, and one of configs with the same."""
    characters = tmp_path / "conf/character"
    characters.mkdir(parents=True)
    (tmp_path / "conf/rotctl.yaml").touch()
    for folder in (tmp_path, characters):
        (folder / "robot.xml").write_text(text())
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(config_folders.OWN, raising=False)
    return tmp_path


def complaint(*overrides):
    with pytest.raises(InputError) as caught:
        load(list(overrides))
    return str(caught.value)


def test_a_log_is_all_that_is_needed(here):
    config = load([INLINE, "seed=3", "character.strength=2", "duration=0.2"])
    assert (config.character.name, config.seed, config.character.strength) == ("robot", 3, 2.0)
    log = run(config, here / "runs").folder / "run.h5"
    (here / "robot.xml").unlink()
    assert main(["verify", str(log)]) == 0


def test_it_is_not_called_as_one_that_comes_with_rotctl(here):
    (here / "robot.xml").rename(here / "adult.xml")
    message = "character.name=adult: is a character that comes with rotctl; give adult.xml a name"
    assert complaint("character={kind: mjcf, file: adult.xml}").startswith(message)
    assert load(["character={kind: mjcf, file: adult.xml, name: mine}"]).character.name == "mine"


def test_it_is_the_character_that_inspect_model_writes(here):
    assert main(["inspect-model", "robot.xml", "--out", "robot.yaml"]) == 0
    written = yaml.safe_load((here / "robot.yaml").read_text())
    found = yaml.safe_load(yaml.safe_dump(to_dict(load([INLINE]))["character"]))
    assert "\nno torque limit in the file for elbow, " in found.pop("description")
    for body in found["bodies"]:  # of what is usual nothing is written
        for key in ("parent", "position", "mirror", "joints"):
            if body[key] in (None, [0.0, 0.0, 0.0], False, []):
                del body[key]
        for geom in body["geoms"]:
            assert geom.pop("colour") is None
            if geom["end"] is None:
                del geom["end"]
    assert found == written


def test_a_choice_of_ones_own_names_a_model(here, capsys):
    (here / "conf/character/mine.yaml").write_text(
        "{kind: mjcf, file: robot.xml, strength: 3.0, mass: 40.0}"
    )
    (here / "robot.xml").unlink()  # the one beside the choice is meant
    assert main(["show", "character=mine", "character.mass=50"]) == 0
    shown = yaml.safe_load(capsys.readouterr().out)["character"]
    assert (shown["strength"], shown["mass"]) == (3.0, 50)


def test_a_choice_is_called_by_its_own_name(here, capsys):
    """And not by the model's, of which there may be several choices."""
    folder = here / "conf/character"
    (folder / "first.yaml").write_text("{kind: mjcf, file: robot.xml}")
    (folder / "second.yaml").write_text("{kind: mjcf, file: robot.xml, name: other}")
    (folder / "third.yaml").write_text("# Mine.\n{kind: mjcf, file: robot.xml, strength: 2}")
    with own(None):
        assert load(["character=first"]).character.name == "first"
        assert load(["character=second"]).character.name == "other"
    assert main(["list", "character"]) == 0
    told = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line}
    assert told["first"].split("  [")[0] == "  first            robot.xml"
    assert " robot.xml (its runs say other)  [" in told["second"]
    assert " Mine.  [" in told["third"]


def test_a_sweep_over_bodies(here, capsys):
    (here / "conf/character/mine.yaml").write_text("{kind: mjcf, file: robot.xml}")
    sweep = ["sweep", "character=mine,adult", "duration=0.1", "--out", "sweeps", "--jobs", "1"]
    assert main(sweep) == 0
    assert "2 runs: " in capsys.readouterr().out


def test_roles_can_be_told(here):
    nameless = text(left_thigh="a", left_shin="b", left_foot="c")
    (here / "robot.xml").write_text(nameless)
    assert complaint(INLINE).startswith(
        "robot.xml: no body for the left hip, such as leftupleg; "
        "name it with +character.roles.left_hip=NAME; its bodies: torso, "
    )
    assert build(load([INLINE, "+character.roles.left_hip=a"])).model.mass > 40
    assert complaint(INLINE, "+character.roles.left_hip=z").startswith(
        "robot.xml: +character.roles.left_hip=z: no such body; its bodies: torso, "
    )


@pytest.mark.parametrize(
    ("roles", "said"),
    [
        ("{nose: x}", "+character.roles.nose=x: no such role; valid: hips, chest, neck, head, "),
        ("{left_hips: torso}", "left_hips=torso: no such role; did you mean left_hip? valid: hips"),
        ("{right_knee: x}", "+character.roles.right_knee=x: no such body; its bodies: torso, "),
        ("{head: pelvis}", "robot.xml: +character.roles.head=pelvis: is of the trunk"),
    ],
)
def test_a_role_that_cannot_be_is_told_by_its_key(roles, said):
    assert said in complaint(f"{INLINE[:-1]}, roles: {roles}}}")


def test_a_file_without_its_kind_is_told_of_it(here):
    said = "character: a file goes with its kind; write kind: mjcf"
    assert complaint("character={file: robot.xml}") == said
    (here / "conf/character/mine.yaml").write_text("{file: robot.xml}")
    with own(None):
        assert complaint("character=mine") == said
    assert load(["character={file: robot.xml}", "+character.kind=mjcf"]).character.name == "robot"


@pytest.mark.parametrize(
    ("overrides", "expected"),
    [
        (["character={kind: mjcf}"], "character: file: missing, it cannot be left out"),
        (["character={kind: mjcf, file: ''}"], "character: file='': is empty; name the model"),
        (
            [INLINE, "character.collision=hulls"],
            "robot.xml: character.collision=hulls: acts on nothing, as none of its shapes is a "
            "mesh here",
        ),
        (["character={kind: urdf, file: robot.xml}"], "character: kind=\"urdf\": must be 'mjcf'"),
        (["character={kind: mjcf, file: none.xml}"], "none.xml: no such file"),
        ([INLINE, "~character.roles"], "~character.roles: a model's keys are given, not removed"),
    ],
)
def test_what_makes_none_is_told(overrides, expected):
    assert complaint(*overrides) == expected


def test_an_unknown_key_is_told():
    assert complaint(INLINE, "character.hight=2").startswith(
        "unknown key 'character.hight'; did you mean height? valid keys under character: "
        "kind, file, roles, meshes, collision, proxies, name, height,"
    )


def test_it_may_have_flesh_as_any_character(here):
    flesh = "{bodies: [pelvis], depth: 0.02, onset: 0.3}"
    inside = INLINE.replace("{", f"{{flesh: {flesh}, ", 1)
    for overrides in ([inside], [INLINE, f"+character.flesh={flesh}"]):
        found = load(overrides).character.flesh
        assert (found.bodies, found.depth, found.onset) == (("pelvis",), 0.02, 0.3)
    assert load([inside, "character.flesh.onset=0.4"]).character.flesh.onset == 0.4
    assert load([INLINE]).character.flesh is None


def test_a_key_that_only_begins_so_is_none_of_the_models():
    for key in ("character_x", "characters.mass"):
        said = complaint(INLINE, f"{key}=1")
        assert said.startswith(f"unknown key {key!r}; ")
        assert "valid keys: behaviour, character, " in said


def test_a_body_without_a_neck_rolls_over_its_head(here):
    """As a model from elsewhere: our adult's text, less the joints of its neck."""
    root = ElementTree.fromstring(adult().mjcf)
    for parent in list(root.iter()):
        for child in list(parent):
            if child.get("name", "").startswith("neck_") and child.tag in ("joint", "general"):
                parent.remove(child)
    (here / "robot.xml").write_bytes(ElementTree.tostring(root))
    roll = [INLINE, "behaviour=forward_roll_push", "duration=4"]
    config = load([*roll, "seed=2000"])
    assert "neck_y" in config.character.absent
    runs = [make(load([*roll, f"seed={seed}"])).summary for seed in (2000, 2001, 2002)]
    assert sum(run["revolutions"] > 1.5 for run in runs) >= 2


COLLARED = text().replace(
    '<geom type="sphere" size="0.1" pos="0 0 0.1" mass="4"/>',
    '<geom name="skull" type="sphere" size="0.1" pos="0 0 0.1" mass="4"/>'
    '<geom name="helmet" class="shell" type="sphere" size="0.12" pos="0 0 0.1" mass="0"/>',
).replace("<worldbody>", '<default><default class="shell"><geom group="3" contype="0" '
          'conaffinity="0"/></default></default><worldbody>')  # fmt: skip


@pytest.mark.parametrize("proxy", ["helmet", "class:shell", "group:3", "hel*"])
def test_the_shapes_that_touch_may_be_named(here, proxy):
    (here / "robot.xml").write_text(COLLARED)

    def head(*more):
        model = build(load([INLINE, *more])).model.mj
        return sorted(model.geom_size[model.geom_bodyid == model.body("head").id, 0])

    assert head() == [0.1]
    assert head(f"character.proxies=['{proxy}']") == [0.12]
    character = load([INLINE, f"character.proxies=['{proxy}']"]).character
    assert "1 shape that is named touches; as in the file: torso, " in character.description
    (skull,) = (b for b in character.bodies if b.name == "head")
    assert [geom.mass > 0 for geom in skull.geoms] == [True, False]  # the other is looked at


def test_a_proxy_that_there_is_not_is_told(here, capsys):
    (here / "robot.xml").write_text(COLLARED)
    valid = "no such shape; its shapes: class:main, class:shell, group:0, group:3, helmet, skull"
    said = complaint(INLINE, "character.proxies=[skul]")
    assert said == f"robot.xml: character.proxies=skul: {valid}"
    assert main(["inspect-model", "robot.xml", "--proxies", "group:4"]) == 2
    assert capsys.readouterr().err == f"rotctl: robot.xml: --proxies group:4: {valid}\n"
