"""`@mine.yaml` on a command line: the same as its lines there, and what is wrong with its line."""

import pytest
import yaml
from test_adopt import text

from rotctl import api
from rotctl.choices.override_files import _text, blamed, expanded
from rotctl.choices.overrides import parsed
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.settings.writing import to_dict

pytestmark = pytest.mark.usefixtures("here")


def written(here, content, name="mine.yaml"):
    (here / name).write_text(content)
    return f"@{name}"


NESTED = """
behaviour: forward_roll
seed: 3                 # a comment
behaviour.speed: 1.5
controller: {pose: {weight: 0.5}}
character:
  exclude_from_control: [head]
+finish: stand
"""
FLAT = """
- behaviour=forward_roll
- seed=3
- behaviour.speed=1.5
- controller.pose.weight=0.5
- character.exclude_from_control=[head]
- +finish=stand
"""


@pytest.mark.parametrize("content", [NESTED, FLAT])
def test_a_file_is_what_its_lines_are_on_a_command_line(here, content):
    overrides = [line.removeprefix("- ") for line in FLAT.split("\n") if line]
    assert expanded([written(here, content)]) == overrides
    assert api.load([written(here, content)]) == load(overrides)


def test_the_later_word_counts(here, capsys):
    file = written(here, "{seed: 3, duration: 5.0}")
    assert main(["show", "seed=4", file, "duration=6"]) == 0
    shown = yaml.safe_load(capsys.readouterr().out)
    assert (shown["seed"], shown["duration"]) == (3, 6.0)


def test_a_file_for_a_sweep_is_for_a_run_that_says_which(here, capsys):
    file = written(here, "{seed: 'range(0,20)', start: 'rest,tucked', duration: 2.0}")
    assert api.load([file, "seed=3", "start=rest"]) == load(["seed=3", "start=rest", "duration=2"])
    for words in ([file, "seed=3"], ["seed=3", "start=rest", file]):
        assert main(["show", *words]) == 2
        assert "run takes one value for" in capsys.readouterr().err


def test_a_text_is_as_on_the_command_line(here, capsys):
    file = written(here, 'seed: range(0,3)\n"~finish":\nterrain: flat,incline\n')
    assert expanded([file]) == ["seed=range(0,3)", "~finish", "terrain=flat,incline"]
    file = written(here, "seed: range(0,3)\nterrain: flat,incline\n")
    assert main(["sweep", file, "duration=0.1", "--out", "s", "--jobs", "1", "--dry-run"]) == 0
    assert capsys.readouterr().out.startswith("6 runs, ")


@pytest.mark.parametrize(
    "value",
    [True, None, -3, 1e-9, "word", "true", "1", "", "it's", "a b", "\\", "a\\'", "'\\\\'", "{x}",
     ["a,b", [1.5, {"key": "x: y"}]]],
)  # fmt: skip
def test_hydra_reads_a_value_as_it_was(value):
    assert parsed(f"key=[{_text(value)}]").value() == [value]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("character: {kind: mjcf}", "character: file: missing, it cannot be left out"),
        ("character: {kind: mjcf, file: 3}", "character: file=3: must be a valid string"),
    ],
)
def test_a_model_without_a_file_is_told_as_one(here, content, said):
    with pytest.raises(InputError) as error:
        api.load([written(here, content)])
    assert str(error.value).endswith(said)


@pytest.mark.parametrize(
    "content",
    [
        "character: {kind: mjcf, file: robot.xml, strength: 2.0}",
        '- "character={kind: mjcf, file: robot.xml, strength: 2.0}"',
        "character: '{kind: mjcf, file: robot.xml, strength: 2.0}'",
    ],
)
def test_a_model_lies_beside_the_file_that_names_it(here, content):
    (here / "robots").mkdir()
    (here / "robots/robot.xml").write_text(text())
    file = written(here, content, "robots/a.yaml")
    assert to_dict(api.load([file]))["character"]["strength"] == 2.0


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("seed: 3\n\nhight: 2\n", "mine.yaml:3: unknown key 'hight'; "),
        ("duration: -3\n", "mine.yaml:1: duration=-3: must be greater than 0"),
        ("seed: 1\nbehaviour:\n  heading: 3\n  speed: x\n", "mine.yaml:4: behaviour.speed="),
        (
            "# none\nbehaviour: forward_rol\n",
            'mine.yaml:2: behaviour="forward_rol": no such choice',
        ),
        ("- seed=1\n- controller.pose.weight=[\n", "mine.yaml:2: override 'controller.pose.weight"),
        ("- seed=1\n- 7\n", "mine.yaml:2: must be a text, such as seed=3"),
        ("- '@other.yaml'\n", "mine.yaml:1: a file names no other one"),
        ("seed: 1\nseed: 2\n", "mine.yaml:2: a key comes twice"),
        ("seed: !!python/name:os.system\n", "mine.yaml:1: has a tag; write plain values"),
        ("seed: ${oc.env:HOME}\n", "mine.yaml:1: override 'seed=${oc.env:HOME}': interpolations"),
        ("- hydra.run.dir=/tmp/x\n", "mine.yaml:1: override 'hydra.run.dir=/tmp/x': Hydra's own "),
        ("hydra: {run: {dir: x}}\n", "mine.yaml:1: override 'hydra.run.dir=x': Hydra's own "),
        ("- 'character={file: a'\n", "mine.yaml:1: override 'character={file: a': cannot be read"),
        ("seed=3\n", "mine.yaml: must be a mapping of keys, or a list of overrides"),
        (
            "name: a\nroll_about: left\nsource: roll.bvh, 0.067 to 1.150 s\njoints: {}\n",
            "mine.yaml: is a choice by itself, not a file of overrides; give "
            "behaviour.reference.clip=mine.yaml of a behaviour that follows one\n",
        ),
        (
            "name: a\nkind: push\ndescription: One push, from any side.\n",
            "mine.yaml: is a choice by itself, not a file of overrides; give GROUP=NAME, ",
        ),
    ],
)
def test_what_is_wrong_is_told_with_its_line(here, capsys, content, said):
    file = written(here, content)
    assert main(["run", file]) == 2
    assert capsys.readouterr().err.startswith(f"rotctl: {said}")


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("@none.yaml", "none.yaml: no such file"),
        ("@", "@.: must be the name of a .yaml file of overrides"),
        ("@/etc/passwd", "@/etc/passwd: must be the name of a .yaml file of overrides"),
    ],
)
def test_a_word_that_names_no_file(word, said):
    with pytest.raises(InputError) as caught:
        expanded([word])
    assert str(caught.value) == said


def test_what_is_not_of_the_file_blames_it_not(here):
    lines = expanded([written(here, "seed: 3\nbehaviour.speed: 1.0\n"), "hight=2"])
    for complaint in ("unknown key 'hight'; valid: seed", "speeds=3: x", "a.seed.b=3: x"):
        assert blamed(lines, complaint) == complaint


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["@mine.yaml", "seed=-1"], "seed=-1: "),
        (["seed=-1", "@mine.yaml", "speed=3"], "unknown key 'speed'; "),
        (["@mine.yaml", "behaviour.speed=x"], 'behaviour.speed="x": '),
        (["@mine.yaml", "seed=-1", "@worse.yaml"], "worse.yaml:2: seed=-2: "),
    ],
)
def test_the_word_that_counts_is_to_blame(here, capsys, words, said):
    written(here, "behaviour.speed: 1.0\nseed: 3\n")
    written(here, "# worse\nseed: -2\n", "worse.yaml")
    assert main(["show", *words]) == 2
    assert capsys.readouterr().err.startswith(f"rotctl: {said}")


def test_an_empty_file_changes_nothing(here):
    assert expanded([written(here, "# nothing\n")]) == []
