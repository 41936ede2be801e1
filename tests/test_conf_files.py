"""Files in conf/ that somebody else has written: plain data, and one line where they are wrong."""

import os
import shutil

import pytest

from rotctl.choices import config_folders
from rotctl.choices.config_folders import conf_dir
from rotctl.choices.describing import groups
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError


@pytest.fixture
def conf(tmp_path, monkeypatch):
    """A copy of conf/ of our own."""
    shutil.copytree(conf_dir(), tmp_path / "conf")
    (tmp_path / "package").mkdir()
    monkeypatch.setattr(config_folders, "__file__", str(tmp_path / "package/choices/here.py"))
    return tmp_path / "conf"


@pytest.fixture
def mine(conf):
    """Writes a behaviour of our own, on top of Forward Roll 1."""

    def write(text):
        path = conf / "behaviour" / "mine.yaml"
        path.write_text(f"defaults: [forward_roll_1, _self_]\n{text}\n")
        return path

    return write


def complaint(*overrides):
    with pytest.raises(InputError) as caught:
        load(list(overrides))
    return str(caught.value)


def test_a_behaviour_of_ones_own(mine):
    mine("name: mine\nspeed: 1.5")
    assert load(["behaviour=mine"]).behaviour.speed == 1.5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("source: ${oc.env:HOME}", ": source: interpolations are not honoured; give a value"),
        ("poses: {a: {knee: 'x${seed}'}}", ": poses.a.knee: interpolations are not honoured; "
         "give a value"),
        ("${oc.env:HOME}: 1", ": ${oc.env:HOME}: interpolations are not honoured; give a value"),
        ("poses: {a: {'${seed}': {}}}", ": poses.a.${seed}: interpolations are not honoured; "
         "give a value"),
        ("speed: [1.2", ":3: is no YAML: while parsing a flow sequence, did not find expected "
         "',' or ']'"),
        ("speed: " + "9" * 5000, ":2: a number has more than 40 digits"),
        ("speed: *x", ":2: has an alias of what it is in, or of nothing"),
        (f"speed: [{'1, ' * 20_000}]", ":2: has more than 20000 values"),
    ],
)  # fmt: skip
def test_what_a_file_may_not_say(mine, text, message, monkeypatch):
    monkeypatch.setenv("HOME", "secret")
    path = mine(text)
    assert complaint("behaviour=mine") == f"{path}{message}"
    assert complaint("seed=1", "+behaviour=mine").startswith(str(path))  # it is not read before
    assert load([]).behaviour.name == "forward_roll_1"


@pytest.mark.parametrize("behaviour", ["behaviour=mine", "+behaviour=mine"])
def test_a_file_is_checked_also_beside_one_that_only_hydra_reads(mine, conf, behaviour):
    mine("speed: 1e0")
    path = conf / "start" / "rest.yaml"
    path.write_text("name: ${oc.env:HOME}\n")
    assert complaint(behaviour, "start=rest") == (
        f"{path}: name: interpolations are not honoured; give a value"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- a", ": must be keys with values"),
        ("a", ": must be keys with values"),
        ("defaults: x", ": defaults: must be a list, in brackets"),
        ("defaults: [nope]", ": defaults: behaviour: nope: no such choice of a group"),
        ("defaults: [1]", ": defaults: behaviour: 1: no such choice of a group"),
        ("defaults: [{start: ../start/rest}]", ": defaults: start: ../start/rest: no such choice "
         "of a group"),
        ("defaults: [{override /hydra/launcher: basic}]", ": defaults: override /hydra/launcher: "
         "basic: no such choice of a group"),
        ("defaults: [{start: [rest]}]", ": defaults: start: ['rest']: no such choice of a group"),
        ("defaults: [{start: ''}, _self_]", ": defaults: start: : no such choice of a group"),
    ],
)  # fmt: skip
def test_a_file_must_be_keys_and_its_defaults_choices(conf, text, message):
    path = conf / "behaviour" / "mine.yaml"
    path.write_text(text)
    assert complaint("behaviour=mine") == f"{path}{message}"


def test_what_a_file_brings_is_looked_at_too(conf, mine):
    (conf / "start" / "other.yaml").write_text("name: ${oc.env:HOME}\n")
    (conf / "terrain" / "other.yaml").write_text("defaults: [flat, {override /start: other}]\n")
    mine("defaults_: 1")
    (conf / "behaviour" / "mine.yaml").write_text("defaults:\n- /terrain@_global_.terrain: other\n")
    assert complaint("behaviour=mine") == (
        f"{conf / 'start' / 'other.yaml'}: name: interpolations are not honoured; give a value"
    )


def test_a_typo_in_one_file_leaves_the_others_alone(conf, capsys):
    whole = groups()
    torn, pipe, listed = (conf / "behaviour" / f"{name}.yaml" for name in ("zy", "zz", "zx"))
    torn.write_text("speed: [1.2\n")
    listed.write_text("- a\n")
    os.mkfifo(pipe)
    found = groups()
    assert found["behaviour"] == whole["behaviour"] | {
        "zx": f"cannot be used: {listed}: must be keys with values",
        "zy": f"cannot be used: {torn}:2: is no YAML: while parsing a flow sequence, did not find "
        "expected ',' or ']'",
        "zz": f"cannot be used: {pipe}: is no plain file",
    }
    assert {g: c for g, c in found.items() if g != "behaviour"} == {
        g: c for g, c in whole.items() if g != "behaviour"
    }
    assert main(["list"]) == 0
    assert capsys.readouterr().out.count("cannot be used") == 3
    for path in (torn, listed, pipe):
        assert complaint(f"behaviour={path.stem}").startswith(str(path))
