"""A folder of one's own: choices beside ours, begun as copies; runs listed and compared."""

import os
import shutil

import numpy as np
import pytest
import yaml

from rotctl import api
from rotctl.choices import config_folders, listing
from rotctl.choices.config_folders import conf_dir, own
from rotctl.choices.listing import choices, named_file
from rotctl.choices.own_folder import kinds, make
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.motion import load_clip
from rotctl.results import experiments
from rotctl.runs.scenario import build
from rotctl.tune.space import load_space


@pytest.fixture
def cli(here, cli):
    """Calls the command line in that folder."""
    return cli


def test_a_copy_is_a_choice_like_any_other(here, cli):
    code, said, _ = cli("new", "behaviour", "my_roll", "--from", "reference_roll")
    assert (code, said) == (0, "conf/behaviour/my_roll.yaml\n")
    mine, theirs = (
        path.read_text().splitlines()
        for path in (here / said.strip(), conf_dir() / "behaviour" / "reference_roll.yaml")
    )
    assert mine[0].startswith("# Copied from behaviour/reference_roll of rotctl ")
    assert [a for a, b in zip(mine[1:], theirs, strict=True) if a != b] == ["name: my_roll"]
    shown = yaml.safe_load(cli("show", "behaviour=my_roll")[1])
    with_hydra = yaml.safe_load(cli("show", "behaviour=my_roll", "~behaviour.source")[1])
    theirs = yaml.safe_load(cli("show", "behaviour=reference_roll")[1])
    assert shown.pop("behaviour")["name"] == "my_roll" == with_hydra.pop("behaviour")["name"]
    theirs.pop("behaviour")
    assert shown == theirs == with_hydra
    (line,) = [line for line in cli("list")[1].splitlines() if "my_roll" in line]
    assert line.endswith(f"[yours: {here / 'conf' / 'behaviour' / 'my_roll.yaml'}]")
    assert config_folders.OWN not in os.environ


def test_a_conf_that_is_not_marked_is_somebody_elses(here, cli):
    cli("new", "start", "my_start", "--from", "rest")
    assert cli("show", "start=my_start")[0] == 0
    (here / "conf" / "rotctl.yaml").unlink()
    assert 'start="my_start": no such choice' in cli("show", "start=my_start")[2]
    assert cli("--config-dir", "conf", "show", "start=my_start")[0] == 0
    assert cli("show", "start=my_start", "--config-dir", here / "conf")[0] == 0
    assert cli("--config-dir", "no", "list")[2] == "rotctl: --config-dir=no: no such folder\n"


def test_in_a_clone_a_copy_is_one_of_ours(here, cli, monkeypatch):
    """There ./conf is what comes with rotctl: nothing in it is marked as the user's."""
    shutil.copytree(conf_dir(), here / "conf")
    monkeypatch.setattr(config_folders, "__file__", str(here / "package/choices/here.py"))
    code, said, _ = cli("new", "behaviour", "my_roll", "--from", "reference_roll")
    assert (code, said) == (0, "conf/behaviour/my_roll.yaml\n")
    assert not (here / "conf" / config_folders.MARK).exists()
    assert "my_roll" in listing.choices("behaviour")
    assert config_folders.own_dir() is None


def test_what_editors_leave_beside_a_file_is_no_choice(here, cli):
    assert cli("new", "behaviour", "my_roll", "--from", "reference_roll")[0] == 0
    (here / "conf" / "behaviour" / ".#my_roll.yaml").symlink_to("me@host.1:5")
    (here / "conf" / "behaviour" / "gone.yaml").symlink_to("nowhere")
    code, shown, _ = cli("show", "behaviour=my_roll")
    assert (code, ".#" in cli("list")[1]) == (0, False)
    assert "name: my_roll" in shown


@pytest.mark.parametrize("defaults", ["[_self_, bad]", "[{}, _self_]", "null"])
def test_defaults_that_make_no_config_are_told(here, cli, defaults):
    folder = here / "conf" / "behaviour"
    folder.mkdir(parents=True)
    (here / "conf" / config_folders.MARK).touch()
    (folder / "bad.yaml").write_text(f"defaults: {defaults}\nname: bad\n")
    code, _, said = cli("show", "behaviour=bad")
    assert (code, said.count("\n")) == (2, 1)
    assert said.startswith("rotctl: ")


def test_a_name_of_ours_is_not_taken(here, cli):
    cli("new", "start", "my_start", "--from", "rest")
    own = here / "conf" / "start" / "tucked.yaml"
    own.write_text("name: mine\n")
    message = f"{own}: rotctl has one of that name; give yours another"
    assert cli("show", "start=tucked")[2] == f"rotctl: {message}\n"
    assert cli("show", "start=rest")[0] == 0  # and nothing else is broken by it
    assert cli("list")[0] == 0


@pytest.mark.parametrize("text", ["speed: [1.2", "- a", "source: ${oc.env:HOME}"])
def test_a_wrong_file_breaks_no_list(here, cli, text):
    cli("new", "start", "my_start", "--from", "rest")
    path = here / "conf" / "start" / "my_start.yaml"
    path.write_text(text)
    code, said, error = cli("list")
    assert (code, error) == (0, "")
    assert f"cannot be used: {path}" in said
    assert cli("show", "start=my_start")[2].startswith(f"rotctl: {path}:")


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (("zoo", "a", "b"), "zoo: no such kind of file; valid: behaviour, "),
        (("start", "../a", "rest"), "../a: must be letters, digits and _, a letter first"),
        (("start", "1e3", "rest"), "1e3: must be letters, digits and _, a letter first"),
        *(
            (
                ("start", word, "rest"),
                f"{word}: YAML takes {word} for something else; give another name",
            )
            for word in ("true", "null", "No", "off", "inf")
        ),
        (("start", "a", "nope"), "--from=nope: no such start or run; valid: aloft, "),
        (("start", "still", "rest"), "still: there is a start of that name: "),
    ],
)
def test_what_cannot_be_begun(here, arguments, complaint):
    with pytest.raises(InputError) as error:
        make(*arguments)
    assert str(error.value).startswith(complaint)
    assert not list(here.iterdir())


@pytest.mark.parametrize("name", ["12", "1e3", "éa", "a,b", "a=b", "$q", "-x", " a", "Null"])
def test_a_file_that_nobody_can_choose_is_told_and_is_no_choice(here, cli, name):
    cli("new", "start", "my_start", "--from", "rest")
    mine = here / "conf" / "start" / "my_start.yaml"
    mine.with_name(f"{name}.yaml").write_text(mine.read_text())
    said = cli("list", "start")[1]
    (line,) = [line for line in said.splitlines() if line.endswith(f"{name}.yaml]")]
    assert line.startswith(f"  {name} ")
    assert "cannot be used: " in line
    with own(None):
        assert "my_start" in choices("start")
        assert name not in choices("start")


@pytest.mark.parametrize("name", ["2_rolls", "my-roll", "x.y", "my own"])
def test_a_file_that_can_be_chosen_is(here, cli, name):
    cli("new", "start", "my_start", "--from", "rest")
    mine = here / "conf" / "start" / "my_start.yaml"
    mine.with_name(f"{name}.yaml").write_text(mine.read_text())
    assert cli("show", f"start={name}", "--part", "start.name") == (0, "name: my_start\n", "")


@pytest.mark.parametrize(
    ("kind", "source", "words"),
    [
        ("start", "rest", ("run", "start=mine")),
        ("behaviour", "reference_roll", ("sweep", "behaviour=stand,mine", "--out", "x")),
        ("motion", "forward_roll",
         ("run", "behaviour=reference_roll", "behaviour.reference.clip=mine")),
        ("tune", "ablation", ("tune", "mine", "--out", "x")),
        ("experiments", "table1", ("sweep", "+experiment=mine", "--out", "x")),
    ],
)  # fmt: skip
def test_a_file_of_another_ending_is_told_and_is_no_choice(here, cli, kind, source, words):
    cli("new", kind, "mine", "--from", source)
    written = here / "conf" / kind / "mine.yaml"
    odd = written.rename(written.with_suffix(".yml"))
    said = f"{odd} must be called mine.yaml"
    (line,) = [line for line in cli("list", kind)[1].splitlines() if "mine" in line]
    assert line.startswith("  mine ")
    assert line.endswith(f"cannot be used: {said}  [yours: {odd}]")
    code, _, error = cli(*words)
    assert (code, error.count("\n")) == (2, 1)
    assert error.endswith(f"; {said}\n")


def test_a_folder_that_nobody_reads_is_told(here, cli):
    cli("new", "start", "mine", "--from", "rest")
    (here / "conf" / "start").rename(here / "conf" / "starts")
    said = (
        f"{here / 'conf' / 'starts'}: is of no group, so that nobody reads it; did you mean start?"
    )
    assert said in cli("list")[1].splitlines()
    assert said not in cli("list", "terrain")[1]


def test_nothing_is_written_that_nobody_could_choose(here, cli):
    cli("new", "start", "my_start", "--from", "rest")
    out = "conf/motion/12.yaml"
    keys = str(conf_dir() / "motion" / "keys" / "forward_roll.yaml")
    code, _, error = cli("author-motion", keys, "--out", out)
    assert (code, error) == (2, f"rotctl: {out}: YAML takes 12 for a number; give another name\n")
    assert not (here / out).exists()


def test_where_a_new_file_lies_is_told_the_same_way_each_time(here, cli):
    for name in ("one", "two"):
        assert cli("new", "start", name, "--from", "rest")[1] == f"conf/start/{name}.yaml\n"


def test_every_kind_can_be_begun(here):
    first = {"motion": "log_roll", "tune": "clip", "experiments": "table1"}
    for kind in kinds():
        source = first.get(kind) or listing.choices(kind)[0]
        assert make(kind, "my_own", source).read_text()
    with config_folders.own(here / "conf"):
        assert load_clip("my_own").name == "my_own"
        assert load_space("my_own")
        assert experiments.experiment("my_own").title
        assert named_file("motion", "my_own") == here / "conf" / "motion" / "my_own.yaml"
        for group in listing.group_names():
            assert "my_own" in listing.choices(group)


def test_five_calls(here):
    make("behaviour", "my_roll", "reference_roll")
    config = api.load(["behaviour=my_roll", "duration=0.5"], config_dir="conf")
    steps = []
    log = api.simulate(config, "out", progress=lambda: steps.append(1))
    assert len(steps) == log.steps == 30
    assert np.array_equal(api.read(log.path)["trajectory/qpos"], log["trajectory/qpos"])
    rows = api.sweep(
        ["behaviour=my_roll", "seed=3,4", "duration=0.3"], "s", jobs=1, config_dir="conf"
    )
    assert rows["seed"].tolist() == [3, 4]
    assert rows["status"].tolist() == ["done", "done"]
    (here / "conf").rename("elsewhere")
    with pytest.raises(InputError, match='behaviour="my_roll": no such choice'):
        api.load(["behaviour=my_roll"])


def test_a_report_is_the_fifth(here, monkeypatch):
    called = []
    monkeypatch.setattr("rotctl.report.site.build.report", lambda *paths: called.append(paths))
    assert api.report("s", "pages") == here.joinpath("pages", "index.html").relative_to(here)
    assert [str(path) for path in called[0]] == ["s", "pages"]


def test_of_two_choices_of_a_group_the_later_one_counts(here):
    make("start", "mine", "rest")
    with config_folders.own(here / "conf"):
        assert load(["start=mine", "start=raised"]).start.name == "raised"
        assert load(["start=raised", "start=mine"]).start.name == "mine"


def test_a_file_is_named_for_what_only_the_making_of_its_run_finds(here, capsys):
    path = make("behaviour", "my_roll", "reference_roll")
    path.write_text(path.read_text() + "  offsets: {elbo: [0.1, 0.1]}\n")
    assert main(["run", "behaviour=my_roll", "duration=0.1"]) == 2
    found = capsys.readouterr().err
    assert found.startswith(f"rotctl: {path.resolve()}: behaviour."), found
    assert "names the unknown joint 'elbo'; did you mean elbow? " in found


def test_no_file_is_named_for_how_two_of_ones_own_meet(here, capsys):
    path = make("behaviour", "my_roll", "reference_roll")
    make("criteria", "mine", "standing")
    said = "criteria={} does not judge behaviour=my_roll, a behaviour of kind rolling"
    for criteria, named in (("mine", ""), ("standing", f"{path.resolve()}: ")):
        assert main(["run", "behaviour=my_roll", f"criteria={criteria}", "duration=0.1"]) == 2
        assert capsys.readouterr().err.startswith(f"rotctl: {named}{said.format(criteria)}")


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: api.simulate(["seed=1"]), r"^config: must be one, not of type list; api\.load\("),
        (lambda: api.load("seed=1"), r"^overrides: must be a list of texts, .*, not a text$"),
        (lambda: api.load(["duration=1", 1]), r"^overrides: .* texts, .*, and 1 is of type int$"),
        (lambda: api.load({"seed": 3}), r"^overrides: must be a list of texts, .* of type dict$"),
        (lambda: api.load([None]), r"^overrides: .*, and None is of type NoneType$"),
        (lambda: api.load(3), r"^overrides: .*, not of type int$"),
        (lambda: api.load(config_dir=3), "^config_dir: must be a path, not of type int$"),
        (lambda: api.sweep("seed=1,2", "out"), "^overrides: must be a list of texts"),
        (lambda: api.sweep(api.load([]), "out"), "^overrides: .*, not of type Config$"),
        (lambda: api.sweep(["seed=1,2"], ""), "^out: is empty; '.' is this folder$"),
        (lambda: api.sweep(["seed=1,2"], None), "^out: must be a path, not of type NoneType$"),
        (lambda: api.sweep(["seed=1,2"], "out", jobs="2"), "^jobs: must be a number or None"),
        (lambda: api.read(api.load([])), "^path: must be a path, not of type Config$"),
        (lambda: api.report(None), "^folder: must be a path, not of type NoneType$"),
        (lambda: api.report("s", 3), "^out: must be a path, not of type int$"),
    ],
)
def test_what_is_of_the_wrong_kind_is_told_in_a_line(here, call, complaint):
    with pytest.raises(InputError, match=complaint):
        call()
    assert not list(here.iterdir())


def test_runs_are_listed_and_compared(here, cli):
    for seed in (2000, 2001):
        config = load([f"seed={seed}", "duration=0.3", f"controller.pose.weight=0.{seed}"])
        api.simulate(config)
    code, said, _ = cli("ls")
    assert code == 0
    assert [line.split()[3:9] for line in said.splitlines()] == [
        [
            "forward_roll_1",
            "seed",
            str(seed),
            "0.3",
            "s",
            f"controller.pose.weight=0.{seed}".rstrip("0"),
        ]
        for seed in sorted((2000, 2001), key=lambda s: _folder(s))
    ]
    name = said.split()[0]
    assert cli("inspect", name)[1] == cli("inspect", f"runs/{name}")[1] != ""
    same = "config: the same\n\nfigures: the same\n"
    assert cli("diff", name, f"runs/{name}") == (0, same, "")
    here.joinpath(name).write_text("of the same name")
    assert cli("inspect", name)[2] == f"rotctl: {name}: not an HDF5 file\n"
    one, other = _folder(2000), _folder(2001)
    said = cli("diff", one, other / "run.h5")[1].splitlines()
    assert said[0].split() == ["config", str(one), str(other / "run.h5")]
    assert [line.split() for line in said[1:3]] == [
        ["controller.pose.weight", "0.2", "0.2001"],
        ["seed", "2000", "2001"],
    ]
    assert "figures" in said[4]
    assert cli("diff", one, one)[1] == "config: the same\n\nfigures: the same\n"
    assert cli("diff", one, "runs")[2] == (
        f"rotctl: {one} and runs: a run and a sweep; give two of a kind\n"
    )
    assert cli("diff", one, "no")[2] == "rotctl: no: no such file or folder\n"


def _folder(seed):
    from pathlib import Path

    found = [path for path in Path("runs").iterdir() if f"seed: {seed}" in
             (path / "config.yaml").read_text()]  # fmt: skip
    return found[0]


def test_sweeps_are_compared(here, cli):
    for name, weight in (("a", 0.6), ("b", 0.7)):
        for seed in (1, 2):
            api.simulate(
                load([f"seed={seed}", "duration=0.3", f"controller.pose.weight={weight}"]), name
            )
    said = cli("diff", "a", "b")[1]
    assert said.splitlines()[1].split() == ["controller.pose.weight", "0.6", "0.7"]
    assert "seed" not in said.partition("figures")[0]
    assert "torque_p99_fraction" in said.partition("figures")[2]
    assert "real_time_factor" not in said  # no two runs take the same


def test_sweeps_over_other_values_of_a_key_are_not_the_same(here, cli):
    for name, seeds in (("a", (2000, 2001)), ("b", (2009, 2000)), ("c", range(2003, 2008))):
        for seed in seeds:
            api.simulate(load([f"seed={seed}", "duration=0.1"]), name)

    def told(one, other):
        return cli("diff", one, other)[1].partition("\n\n")[0].splitlines()

    assert told("a", "b") == ["config  a           b", "seed    2000, 2001  2000, 2009"]
    assert told("b", "c")[1] == "seed    2000, 2009  5 values, 2003 to 2007"
    assert told("c", "c") == ["config: the same"]


def test_of_sweeps_over_several_behaviours_their_names_are_compared(here, cli):
    """Not the hundreds of keys that only some of them have; and who rolled on as a share."""
    for name, others in (("a", ("stand", "get_up")), ("b", ("stand",))):
        for behaviour in ("forward_roll_1", *others):
            api.simulate(load([f"behaviour={behaviour}", "duration=0.2"]), name)
    pushed = ["disturbance=push", "disturbance.time=0.5", "disturbance.impulse=1", "duration=2.5"]
    api.simulate(load(pushed), "c")
    config, _, figures = cli("diff", "a", "b")[1].partition("figures")
    lines = [line.split("  ") for line in config.splitlines()[1:] if line]
    told = {line[0]: [cell.strip() for cell in line[1:] if cell.strip()] for line in lines}
    assert told["behaviour.name"] == ['"forward_roll_1, get_up, stand"', '"forward_roll_1, stand"']
    assert all(key.endswith(".name") or key.count(".") == 0 for key in told)
    assert "recovered" not in figures
    figures = cli("diff", "a", "c")[1].partition("figures")[2]
    line = next(line for line in figures.splitlines() if "recovered" in line)
    assert line.split() == ["recovered_rate", "-", "1"]


def test_figures_that_only_some_runs_of_a_sweep_have_say_how_many(here, cli):
    short, pushed = "duration=0.2", ["disturbance=push", "disturbance.time=0.5", "duration=2.5"]
    for choice in ("forward_roll_1", "stand"):
        api.simulate(load([f"behaviour={choice}", short]), "a")
    api.simulate(load([short]), "b")
    api.simulate(load([*pushed, "disturbance.impulse=1"]), "b")
    figures = cli("diff", "a", "b")[1].partition("figures")[2]
    told = {line.split()[0]: line.split()[1:] for line in figures.splitlines()[1:]}
    assert told["recovered_rate"] == ["-", "1", "of", "1"]
    assert told["speed_commanded"] == ["1.2", "of", "1", "1.2"]
    assert told["other_contact"] == ["0", "of", "1", "-"]
    assert "of" not in told["torque_p99_fraction"]


def test_two_claims_of_one_name_are_refused(here, cli):
    cli("new", "experiments", "mine", "--from", "forward_roll_1")
    path = here / "conf" / "experiments" / "mine.yaml"
    path.write_text(path.read_text().replace("id: forward_roll_1_phase.", "id: forward_roll_1."))
    said = f"rotctl: {path}: claims: forward_roll_1.success is the id of two; reports go by it\n"
    assert cli("sweep", "+experiment=mine", "--dry-run") == (2, "", said)


KEYS = (
    "name, kind, roll_about, angular_velocity, speed, heading, align_with_slope, poses, reference"
)


@pytest.mark.parametrize(
    "command",
    [("run",), ("run", "seed=2", "behaviour.speed=1.0"), ("sweep", "seed=1,2", "--out=x")],
)
def test_a_wrong_key_in_a_file_of_ones_own_is_told_with_the_file(here, cli, command):
    cli("new", "behaviour", "mine", "--from", "forward_roll_1")
    path = here / "conf" / "behaviour" / "mine.yaml"
    path.write_text(path.read_text() + "sped: 1.0\n")
    code, _, error = cli(*command, "behaviour=mine")
    assert code == 2
    assert error == (
        f"rotctl: {path}: unknown key 'behaviour.sped'; did you mean speed? "
        f"valid keys under behaviour: {KEYS}, angular_momentum, pace, finish, course, catch, "
        "oblique, alighting, lift, source, description\n"
    )
    path.write_text(path.read_text().replace("sped: 1.0\n", ""))  # an override is no fault of it
    assert cli("show", "behaviour=mine", "behaviour.sped=1")[2].startswith("rotctl: unknown key")


def test_a_wrong_key_says_more_than_the_one_that_is_missing_for_it(here, cli):
    cli("new", "behaviour", "mine", "--from", "back_flip")
    path = here / "conf" / "behaviour" / "mine.yaml"
    path.write_text(path.read_text().replace("gain: 1.148 ", "gian: 1.148 "))
    place = "behaviour.stages.0.tasks.balance.aim"
    assert cli("run", "behaviour=mine")[2].startswith(
        f"rotctl: {path}: unknown key '{place}.gian'; did you mean gain? valid keys under {place}: "
    )


def test_a_file_that_nobody_can_choose_is_told(here, cli):
    cli("new", "start", "mine", "--from", "rest")
    (here / "conf" / "start" / "mine.yaml").rename(here / "conf" / "start" / "true.yaml")
    assert "cannot be used: YAML takes true for something else" in cli("list")[1]
    assert "true" not in cli("show", "start=true")[2].partition("valid: ")[2]


@pytest.mark.parametrize(
    ("group", "overrides", "message"),
    [
        ("criteria", ["behaviour=stand", "criteria=rolling"], "such as criteria=cartwheel"),
        ("finish", ["finish.after=1"], "unknown key 'finish.after'; what +finish=CHOICE adds is "),
        ("start", ["behaviour=sideways_roll", "start=falling"], "; valid: "),
    ],
)
@pytest.mark.parametrize("text", ["kind: [", "defaults: [nobody]\n"])
def test_a_file_that_is_wrong_is_no_matter_to_who_does_not_choose_it(
    here, group, overrides, message, text
):
    path = here / "conf" / group / "aa.yaml"
    path.parent.mkdir(parents=True)
    path.write_text(text)
    with config_folders.own(here / "conf"), pytest.raises(InputError) as error:
        build(load([*overrides, "seed=1"]))
    assert message in str(error.value)
    assert "aa" not in str(error.value)
