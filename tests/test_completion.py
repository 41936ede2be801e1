"""What the tab key completes."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from rotctl.choices.listing import choices, named_files
from rotctl.cli.main import main
from rotctl.cli.parser import COMMANDS

ROLLS = [name for name in choices("behaviour") if name.startswith("forward_roll")]


def words(line, capsys):
    assert main(["completion", "words", line]) == 0
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("rotctl summ", ["summarise"]),
        ("rotctl --ver", ["--version"]),
        ("rotctl run --filmstrip --fo", ["--force"]),
        ("rotctl run behaviour=forward_roll", [f"behaviour={name}" for name in ROLLS]),
        ("rotctl run start=re", ["start=rest"]),
        ("rotctl --config-dir nowhere run start=re", []),
        ("rotctl --config-dir ", []),  # a folder: the shell's own business
        ("rotctl run --config-dir s", []),
        ("rotctl run con", ["controller.", "controller="]),
        ("rotctl run controller.po", ["controller.pose.", "controller.poses."]),
        ("rotctl show controller.pose.w", ["controller.pose.weight="]),
        ("rotctl show --part controller.pose.w", ["controller.pose.weight"]),
        ("rotctl run behaviour=back_flip behaviour.shap", ["behaviour.shape="]),
        ("rotctl run behaviour.shap", []),
        ("rotctl run +fi", ["+finish="]),
        ("rotctl run +finish=", ["+finish=seat", "+finish=stand"]),
        ("rotctl run +finish=stand behaviour.finish.af", ["behaviour.finish.after="]),
        ("rotctl run +exp", []),
        ("rotctl sweep +exp", ["+experiment="]),
        ("rotctl sweep +experiment=tab", ["+experiment=table1"]),
        ("rotctl run behaviour.reference.clip=back", ["behaviour.reference.clip=backward_roll"]),
        ("rotctl export runs/a/run.h5 --to g", ["gltf"]),
        ("rotctl new beh", ["behaviour"]),
        ("rotctl new behaviour mine --from back_", ["back_flip", "back_handspring"]),
        ("rotctl tune clip_t", ["clip_terrain"]),
        ("rotctl completion f", ["fish"]),
        ("rotctl render ", []),  # a file: the shell's own business
        ("rotctl sweep 'seed=range(0,", []),
        ("rotctl run nobody.knows.", []),
        ("rotctl run behaviour=nobody behaviour.", []),
        ("rotctl nobody ", None),  # any command
    ],
)
def test_words_that_can_follow(line, wanted, capsys):
    found = words(line, capsys)
    assert found == wanted if wanted is not None else len(found) == len(COMMANDS)


def test_a_script_completes_no_line(capsys):
    assert main(["completion", "fish", "rotctl ru"]) == 2
    said = "rotctl: LINE is for rotctl completion words, not for fish\n"
    assert capsys.readouterr().err == said


def test_every_command_and_every_choice_can_follow(capsys):
    assert len(words("rotctl ", capsys)) == len(words("", capsys)) == len(COMMANDS)
    found = words("rotctl sweep +experiment=", capsys)
    assert found == [f"+experiment={name}" for name in sorted(named_files("experiments"))]


def test_a_file_of_ones_own_is_among_them_and_a_wrong_one_spoils_nothing(
    capsys, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "behaviour", "mine", "--from", "stand"]) == 0
    capsys.readouterr()
    assert words("rotctl run behaviour=mi", capsys) == ["behaviour=mine"]
    (tmp_path / "conf" / "behaviour" / "mine.yaml").write_text("a: [")
    assert words("rotctl run behaviour=mine behaviour.", capsys) == []
    assert words("rotctl run behaviour=mi", capsys) == ["behaviour=mine"]


@pytest.mark.parametrize(
    "line",
    [
        "rotctl --config-dir run run {}",  # a folder that is called as a command is
        "rotctl --config-dir=run run {}",
        "rotctl run --config-dir run {}",
        "rotctl run --config-dir nowhere --config-dir=run {}",  # the last one counts
        "rotctl --config-dir ~/run run {}",
    ],
)
def test_a_folder_that_the_line_names_is_asked(line, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    file = tmp_path / "run" / "behaviour" / "mine.yaml"
    file.parent.mkdir(parents=True)
    file.write_text("defaults: [stand, _self_]\nonly_here: 1\n")
    assert words(line.format("behaviour=mi"), capsys) == ["behaviour=mine"]
    line = line.format("behaviour=mine behaviour.only")
    assert words(line, capsys) == ["behaviour.only_here="]
    assert words("rotctl run behaviour=mi", capsys) == []


@pytest.mark.parametrize(
    "name",
    [
        *("x$(touch pwned)", "x`id`", "x;id", "x&id", "x|id", "x>y", "x y", "x\nid", "x\\id"),
        *("x*", "x[a]", "x{a,b}", "x!id", "x#", "x'", 'x"', "xé"),
    ],
)
def test_a_name_or_key_that_a_shell_would_act_on_is_left_out(name, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "conf" / "behaviour"
    folder.mkdir(parents=True)
    (tmp_path / "conf" / "rotctl.yaml").touch()
    (folder / f"{name}.yaml").write_text("defaults: [stand, _self_]\n")
    (folder / "x1.yaml").write_text(
        yaml.safe_dump({"defaults": ["stand", "_self_"], "x_more": 1, name: 1, "x2": {name: 1}})
    )
    assert words("rotctl run behaviour=x", capsys) == ["behaviour=x1"]
    assert words("rotctl new behaviour mine --from x", capsys) == ["x1"]
    key = "rotctl run behaviour=x1 behaviour.x"
    assert words(key, capsys) == ["behaviour.x2.", "behaviour.x_more="]
    assert words(f"{key}2.", capsys) == []


def test_a_key_is_no_path_of_a_command_to_zsh(capsys, tmp_path, monkeypatch):
    """Which looks up what follows a `=` that a word begins with."""
    monkeypatch.setattr("rotctl.cli.completing._keys", lambda *of: ["=ls=", "seed="])
    assert words("rotctl run ", capsys) == ["seed="]


SAID = {
    "bash": "source <(rotctl completion bash); COMP_LINE='{0}'; COMP_POINT={1}; _rotctl; "
    'printf "%s\\n" "${{COMPREPLY[@]}}"',
    "fish": "rotctl completion fish | source; complete -C '{0}'",
}


@pytest.mark.parametrize("shell", SAID)
@pytest.mark.parametrize(
    ("line", "wanted"),
    [("rotctl summ", "summarise"), ("rotctl run behaviour=back_f", "behaviour=back_flip")],
)
def test_the_scripts_ask_for_them(shell, line, wanted):
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell} here")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [shell, "-c", SAID[shell].format(line, len(line))],
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    cut = "=" in wanted and shell == "bash"  # which puts in what comes after a `=`
    assert done.stdout.split() == [wanted.partition("=")[2] if cut else wanted]
