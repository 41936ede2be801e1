"""The search as a whole: repeats itself, survives a kill, and leaves a config choice."""

import json
import random
import shutil
import sqlite3
import subprocess
from dataclasses import replace

import pytest
import yaml
from sweep_cli import held_after, kill

from rotctl.choices import config_folders
from rotctl.cli.main import main
from rotctl.config import loading
from rotctl.errors import InputError, RotctlError
from rotctl.runs.run import run
from rotctl.sweep.engines import Failure
from rotctl.sweep.lock import locked
from rotctl.tune import result
from rotctl.tune.history import open_history
from rotctl.tune.search import Budget, Watch, prepare, tune

SPACE = {
    "name": "small",
    "title": "A small search",
    "base": ["behaviour=forward_roll_1"],
    "parameters": [
        {"key": "behaviour.poses.a.knee", "low": 1.0, "high": 2.75, "unit": "rad"},
        {"key": "behaviour.poses.b.knee", "low": 0.5, "high": 2.75, "unit": "rad"},
        {
            "key": "controller.tasks.linear.damping.0",
            "low": 1.0,
            "high": 10.0,
            "unit": "1/s",
            "scale": "log",
        },
    ],
    "runs": {"seeds": 2, "duration": 0.5, "final": 2},
    "objective": {
        "over_runs": "mean",
        "survival": 0.6,
        "progress": 0.4,
        "pace": 0.65,
        "drift": 0.03,
        "heading": 0.001,
    },
    "stopping": {"stall_time": 0.3, "stall_progress": 0.1, "off_axis": 70.0},
    "sampler": {"name": "cmaes", "population": 4, "sigma": 0.2},
    "trials": 8,
}


class HereEngine:
    """Carries tasks out in this process, in a random order."""

    where = "here"

    def __init__(self, fail=lambda item: False):
        self.fail = fail
        self.done = 0

    def map(self, task, items, retries):
        order = list(range(len(items)))
        random.shuffle(order)
        for i in order:
            self.done += 1
            yield i, Failure("its worker died") if self.fail(items[i]) else task(items[i])

    def close(self):
        pass


@pytest.fixture
def space(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(yaml.safe_dump(SPACE))
    return str(path)


def search(space, folder, engine=None, trials=8, overrides=(), seed=0, sampler=None):
    lines = []
    what, budget = prepare(space, list(overrides), seed, sampler, trials, None)
    watch = Watch(lines.append, lambda: None)
    return tune(what, folder, budget, engine or HereEngine(), watch), lines


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A search of two generations that nothing disturbed."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "small.yaml").write_text(yaml.safe_dump(SPACE))
    return search(str(folder / "small.yaml"), folder)[0]


def gist(found):
    """All but the times."""
    return tried(found.trials), found.start, found.candidates


def tried(trials):
    return [(t.generation, t.index, t.values, t.score, t.finished) for t in trials]


def test_a_search_repeats_itself_whatever_the_order_of_its_runs(space, tmp_path, whole):
    again, lines = search(space, tmp_path / "a")
    assert gist(again) == gist(whole)
    assert [(t.generation, t.index) for t in again.trials] == [
        (g, i) for g in range(2) for i in range(4)
    ]
    assert len(lines) == 3
    assert lines[1].startswith("generation   1  trials    8  best ")
    other, said = search(space, tmp_path / "b", trials=3, seed=1)
    assert said[0] == "4 trials in place of 3: whole generations of 4"
    assert tried(other.trials) != tried(whole.trials[:4])


def test_so_does_one_with_tpe(space, tmp_path):
    first, _ = search(space, tmp_path / "a", sampler="tpe")
    again, _ = search(space, tmp_path / "b", sampler="tpe")
    assert gist(again) == gist(first)


def test_the_same_command_goes_on_and_a_finished_search_tries_nothing_more(space, tmp_path, whole):
    search(space, tmp_path, trials=4)
    rest = HereEngine()
    found, _ = search(space, tmp_path, rest, trials=8)
    assert gist(found) == gist(whole)
    final = 2 * (1 + len(found.candidates))
    assert rest.done == 4 * 2 + final
    finished = HereEngine()
    search(space, tmp_path, finished, trials=8)
    assert finished.done == final


def test_an_interrupted_generation_keeps_what_was_finished(space, tmp_path, whole):
    class Interrupted(HereEngine):
        def map(self, task, items, retries):
            for i in range(len(items)):
                if self.done == 8 + 4:
                    raise KeyboardInterrupt
                self.done += 1
                yield i, task(items[i])

    with pytest.raises(KeyboardInterrupt):
        search(space, tmp_path, Interrupted())
    rest = HereEngine()
    found, _ = search(space, tmp_path, rest)
    assert gist(found) == gist(whole)
    assert rest.done == 2 * 2 + 2 * (1 + len(found.candidates))


def test_a_search_that_was_killed_goes_on_to_the_same_result(space, tmp_path, whole, capsys):
    folder = tmp_path / "killed"
    arguments = ["tune", space, "--out", str(folder), "--trials", "8", "--jobs", "1"]
    with held_after("rotctl.tune.history.History.add", *arguments) as process:
        process.reached()
        process.go_on()
        process.reached()
        kill(process.pid)
    assert _rows(folder) == 2
    assert main(arguments) == 0
    shown = capsys.readouterr().out
    assert ("to judge it" in shown) != ("none is better than the start" in shown)
    assert tried(reread(space, folder)) == tried(whole.trials)


def reread(space, folder):
    what, _ = prepare(space, [], 0, None, None, None)
    with sqlite3.connect(folder / "study.db") as base:
        query = "select value_json from study_user_attributes where key='identity'"
        identity = json.loads(base.execute(query).fetchone()[0])
    return open_history(folder, what.space, identity).trials()


def _rows(folder):
    with sqlite3.connect(f"file:{folder / 'study.db'}?mode=ro", uri=True) as base:
        return base.execute("select count(*) from trials where state='COMPLETE'").fetchone()[0]


def test_the_result_is_a_config_choice_for_each_group(space, tmp_path, monkeypatch):
    folder = tmp_path / "out"
    found, _ = search(space, folder, overrides=["behaviour.speed=1.1"])
    written = result.write(found, folder)
    assert [str(path.relative_to(folder)) for path in written] == [
        "behaviour/small_tuned.yaml",
        "controller/small_tuned.yaml",
    ]
    text = written[0].read_text()
    assert "# seeds      training 1000000 to 1000003; final choice 1900000 to 1900001\n" in text
    assert "# base       behaviour=forward_roll_1 behaviour.speed=1.1\n" in text
    assert "# trials     8 in 2 generations, 2 runs of 0.5 s each\n" in text
    copied = tmp_path / "conf"
    shutil.copytree(config_folders.conf_dir(), copied)
    for path in written:
        shutil.copy(path, copied / path.parent.name)
    monkeypatch.setattr(config_folders, "__file__", str(tmp_path / "package/choices/here.py"))
    chosen = loading.load(["behaviour=small_tuned", "controller=small_tuned", "duration=0.25"])
    best = found.candidates[0].values
    assert chosen.behaviour.poses.a["knee"] == best["behaviour.poses.a.knee"]
    assert chosen.controller.tasks["linear"].damping[0] == best["controller.tasks.linear.damping.0"]
    assert chosen.behaviour.speed == 1.1
    assert chosen.behaviour.name == "small_tuned"
    assert run(chosen, tmp_path / "runs").summary["behaviour"] == "small_tuned"


def test_a_result_brings_what_its_behaviour_brings(whole, tmp_path):
    """Its ground, its excursion: without them it would be judged elsewhere than it was found."""
    steep = replace(whole.search, overrides=["behaviour=steep"])  # which builds on incline
    made = result.choices(replace(whole, search=steep))
    (tmp_path / "behaviour").mkdir()
    (tmp_path / "behaviour" / "small_tuned.yaml").write_text(made["behaviour"])
    with config_folders.own(tmp_path):
        chosen = loading.load(["behaviour=small_tuned"])
        assert chosen.terrain == loading.load(["behaviour=steep"]).terrain
        assert loading.load(["behaviour=small_tuned", "terrain=flat"]).terrain.name == "flat"
    assert "defaults" not in yaml.safe_load(made["controller"])


def test_the_history_is_a_table_and_a_picture_and_says_how_to_judge(tmp_path, whole):
    found = whole
    written = result.write(found, tmp_path)
    lines = (tmp_path / "history.txt").read_text().splitlines()
    assert lines[0].split()[:4] == ["generation", "trials", "best", "median"]
    assert [line.split()[:2] for line in lines[1:]] == [["0", "4"], ["1", "4"]]
    assert "<svg" in (tmp_path / "history.svg").read_text()
    said = result.how_to_judge(found, written, tmp_path)
    assert said.endswith(
        "rotctl sweep behaviour=small_tuned controller=small_tuned 'seed=range(0,50)' "
        f"--out {tmp_path / 'judged'}"
    )
    assert "mean of the distribution" in result.comparison(found)
    for score, warned in ((2.0, True), (-2.0, False)):
        other = replace(found, start=replace(found.start, score=score))
        said = result.comparison(other)
        assert ("none is better than the start" in said) == warned
        marked = [line for line in said.splitlines() if line.endswith("<- written")]
        assert [line.split("  ")[1] for line in marked] == [found.candidates[0].name]


@pytest.mark.parametrize("successes", [0, 1])
def test_a_result_that_never_succeeds_is_called_so(whole, successes):
    """Better than a worse start it may be all the same."""
    best = whole.candidates[0]
    runs = [replace(run, success=i < successes) for i, run in enumerate(best.runs)]
    candidates = [replace(best, runs=runs), *whole.candidates[1:]]
    start = replace(whole.start, score=best.score - 1.0)
    found = replace(whole, start=start, candidates=candidates)
    told = f"of {len(runs)} runs to the end, {successes} a success"
    assert told in result.comparison(found)
    assert told in "\n".join(result.provenance(found))
    assert ("nothing was found that succeeds" in result.comparison(found)) == (not successes)
    assert bool(result.missed(found)) == (not successes)


def test_what_is_printed_to_judge_a_result_can_be_pasted(whole, tmp_path):
    """Its copies go into folders that are made where they are not there yet."""
    folder, mine = tmp_path / "a search", tmp_path / "my conf"
    written = result.write(whole, folder)
    (mine / "controller").mkdir(parents=True)
    with config_folders.own(mine):
        copies = result.how_to_judge(whole, written, folder).splitlines()[1:-1]
        assert [line.count("mkdir") for line in copies] == [1, 0]
        for line in copies:
            subprocess.run(line, shell=True, check=True)
        chosen = loading.load(["behaviour=small_tuned", "controller=small_tuned"])
        assert chosen.behaviour.name == "small_tuned"
        assert "mkdir" not in result.how_to_judge(whole, written, folder)


def test_another_search_or_a_second_one_at_once_is_refused(space, tmp_path):
    folder = tmp_path / "out"
    search(space, folder, trials=4)
    with pytest.raises(InputError, match=r"another search, with seed=0 \(now 1\); choose another"):
        search(space, folder, seed=1)
    with pytest.raises(InputError, match=r"another search, with space.sampler.name=\"cmaes\" \(no"):
        search(space, folder, sampler="tpe")
    with pytest.raises(InputError, match=r"another search, with overrides=\[\] \(now \[\"terrain"):
        search(space, folder, overrides=["terrain.friction=0.9"])
    with locked(folder), pytest.raises(InputError, match="at work there"):
        search(space, folder)


def test_lost_runs_are_worth_nothing_and_counted(space, tmp_path):
    lost = HereEngine(fail=lambda item: item.config.seed == 1_000_000)
    found, lines = search(space, tmp_path / "a", lost, trials=4)
    assert [trial.lost for trial in found.trials] == [1] * 4
    assert all(trial.score <= 0.5 for trial in found.trials)
    assert lines[0].endswith("  4 runs lost")
    with pytest.raises(RotctlError, match="^no run of a candidate gave a result: its worker died$"):
        search(space, tmp_path / "b", HereEngine(fail=lambda item: True))


def test_minutes_are_kept_but_one_generation_is_tried(space, tmp_path):
    what, _ = prepare(space, [], 0, None, None, 1.0)
    found = tune(what, tmp_path, Budget(None, 1e-9), HereEngine(), Watch(print, lambda: None))
    assert len(found.trials) == 4


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nope"], "rotctl: nope: no such space; valid: ablation, clip, clip_one_shoulder, "),
        (["rolling_gains", "--seed", "-1"], "rotctl: --seed=-1: must be 0 to 999,999"),
        (["rolling_gains", "--trials", "0"], "rotctl: --trials=0: must be above 0"),
        (["rolling_gains", "--minutes", "nan"], "rotctl: --minutes=nan: must be above 0"),
        (["rolling_gains", "seed=5"], "rotctl: seed=5: tune draws the seeds of its runs itself"),
        (["rolling_gains", "--jobs", "0"], "rotctl: --jobs=0: valid: 1 to 1024"),
        (["rolling_gains", "x=1"], "rotctl: unknown key 'x'"),
        (["rolling_gains", "duration=0.001"], "rotctl: duration=0.001 s is no whole number of "),
        (
            ["clip_pace", "+finish=stand", "criteria=finish"],
            "rotctl: criteria=finish is of kind finish; a search judges by kind rolling, and so a ",
        ),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments, said, tmp_path, capsys):
    assert main(["tune", *arguments, "--out", str(tmp_path / "out")]) == 2
    stdout, stderr = capsys.readouterr()
    assert stdout == ""
    assert stderr.startswith(said)
    assert stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_used_is_one_line(space, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["tune", space, "--out", str(tmp_path / "file")]) == 2
    (tmp_path / "torn").mkdir()
    (tmp_path / "torn" / "study.db").write_text("no database, but long enough to be read as one")
    assert main(["tune", space, "--out", str(tmp_path / "torn")]) == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first.startswith(f"rotctl: cannot write {tmp_path / 'file'}: ")
    assert second == f"rotctl: cannot use {tmp_path / 'torn' / 'study.db'}: file is not a database"
