"""The report: what its pages hold, what they say of missing runs, and what changed since."""

import csv
import io
import json
import os
import re
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from xml.etree import ElementTree as Xml

import h5py
import pandas as pd
import pytest
from here import swept
from logs import changed

from rotctl.choices.listing import choices
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.files import replace as replace_file
from rotctl.log import RunLog
from rotctl.metrics.claims import Claim, judge
from rotctl.report.site import against, build, pictures
from rotctl.report.site.build import report
from rotctl.report.site.charts import charts
from rotctl.report.site.folder import HEAD, LIST
from rotctl.report.site.folder import write as write_report
from rotctl.report.site.grid import grid
from rotctl.report.site.panels import drawn
from rotctl.report.site.rows import from_worst, rows
from rotctl.report.site.study import studies, warnings
from rotctl.report.site.words import (
    QUANTITIES,
    Names,
    kind,
    number,
    outcome,
    ranges,
    with_unit,
)
from rotctl.results import index
from rotctl.results.index_writer import Writer
from rotctl.results.manifest import Entry, read, write
from rotctl.results.sweeps import sweeps
from rotctl.runs.summary import numbers
from rotctl.sweep.claimed import METRICS

ARGUMENTS = ["behaviour=forward_roll_1,decline", "seed=range(0,3)", "duration=2"]
EXPERIMENT = """
title: A test of <b>rolls</b>
source: "[Brown2013] Table 1"
matrix: [["behaviour=forward_roll_1,decline"]]
seeds: range(0,3)
deviations: [{text: Poses are ours., where: {behaviour: decline}}, {text: Another simulator.}]
limitations: [Two seconds are short.]
claims:
  - {id: roll, metric: success_rate, comparison: at_least, expected: 0.9, tolerance: 0.0,
     source: paper, where: {behaviour: forward_roll_1}}
  - {id: roll.speed, metric: speed_mean, expected: 99.0, tolerance: 0.1, source: paper,
     where: {behaviour: forward_roll_1}}
  - {id: decline, metric: success_rate, comparison: at_most, expected: 0.1, tolerance: 0.0,
     source: paper, where: {behaviour: decline}}
  - {id: gone, metric: success_rate, expected: 1.0, tolerance: 0.0, source: paper,
     where: {behaviour: nobody}}
"""
EVIL = "<script>alert(1)</script>"
ANSWER = "In part: 1 of 4 claims reproduced."


class Page(HTMLParser):
    """What a page is made of."""

    def __init__(self, path):
        super().__init__()
        self.tags, self.headings, self.text = [], [], ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag in ("h1", "h2", "h3", "h4"):
            self.headings.append(int(tag[1]))

    def handle_data(self, data):
        self.text += data

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture(scope="module", autouse=True)
def _short_filmstrips():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pictures, "FRAMES", 1)
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with a sweep and its experiment, to be looked at only."""
    folder = tmp_path_factory.mktemp("sweeps")
    out = swept(folder / "table", *ARGUMENTS)
    (out / "experiment-test.yaml").write_text(EXPERIMENT)
    return folder


@pytest.fixture(scope="module")
def site(made, tmp_path_factory):
    out = tmp_path_factory.mktemp("pages") / "site"
    report(made, out)
    return out


@pytest.fixture
def sweep(made, tmp_path, monkeypatch):
    """A copy of the sweep, to be harmed; drawn quickly, without pictures."""
    monkeypatch.setattr(build, "MOST_DRAWN", 0)
    return shutil.copytree(made, tmp_path / "sweeps") / "table"


def content(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


# ---------------------------------------------------------------- the pages


def test_the_first_heading_asks_and_the_next_line_answers(site):
    page = Page(site / "index.html")
    assert page.headings[0] == 1
    assert page.text.index("Does it reproduce the paper?") < page.text.index(ANSWER)
    assert page.text.index(ANSWER) < page.text.index("forward_roll_1")


def test_pages_are_sound(site):
    for path in (site / "index.html", site / "sweeps" / "table.html"):
        page = Page(path)
        assert page.all("html") == [{"lang": "en"}]
        assert page.headings.count(1) == 1
        assert all(b <= a + 1 for a, b in zip(page.headings, page.headings[1:], strict=False))
        assert all("alt" in image and "width" in image for image in page.all("img"))
        assert all(region["tabindex"] == "0" for region in page.all("div"))
        assert page.all("script") == []
        assert not [tag for tag, found in page.tags if "style" in found or "onclick" in found]
        (policy,) = [m["content"] for m in page.all("meta") if "http-equiv" in m]
        assert policy.startswith("default-src 'none'; style-src 'sha256-")
        assert policy.endswith("img-src 'self' file:; base-uri 'none'; form-action 'none'")


@pytest.mark.usefixtures("drawing")
def test_links_and_pictures_lead_somewhere(site):
    for path in (site / "index.html", *site.glob("sweeps/*.html")):
        page = Page(path)
        ids = {attributes["id"] for _, attributes in page.tags if "id" in attributes}
        addresses = [a["href"] for a in page.all("a")] + [i["src"] for i in page.all("img")]
        addresses += [source["srcset"] for source in page.all("source")]
        for address in addresses:
            file, _, anchor = address.partition("#")
            assert (path.parent / file).exists() if file else anchor in ids
    assert len(list(site.glob("replays/*.html"))) == len(list(site.glob("pictures/*.png"))) == 4


def test_rows_show_what_was_commanded_and_reached(site):
    text = " ".join(Page(site / "index.html").text.split())
    assert "100 % [44, 100] of 3 runs" in text
    assert "of 1.3 commanded" in text
    assert "at least 90 %" in text
    assert "Two seconds are short." in text
    assert text.count("Poses are ours.") == 2  # at its row and in the list
    assert "Only 3 starts a row, so that the intervals are wide." in text
    assert "6 with a result, 0 without" in text
    assert "1 claim, not tested: no such run in the sweep." in text


def test_the_whole_of_a_machine_is_told(made, site):
    log = RunLog.open(sorted(made.glob("table/*/run.h5"))[0])
    machine = json.loads(log.attributes["machine"])
    text = Page(site / "index.html").text
    assert all(f"{key} {value}" in text for key, value in machine.items())


def test_replays_share_one_script(site):
    assert (pages := sorted(site.glob("replays/*.html")))
    for path in pages:
        html = path.read_text(encoding="utf-8")
        assert '<script src="../replay.js"></script>' in html
        assert "script-src 'self' file:;" in html
        assert '<a class="back" href="../index.html">' in html
        assert len(html) < 400_000


def test_the_same_runs_give_the_same_bytes_and_old_pages_go(made, site, tmp_path):
    out, (old, mine) = tmp_path / "again", ("replays/old.html", "CNAME")
    (out / "replays").mkdir(parents=True)
    (out / old).touch()
    (out / mine).write_text("not ours")
    listed = (HEAD, old, mine, "../outside.html", "replays/../../outside.html")
    (out / LIST).write_text("".join(f"{line}\n" for line in listed))
    (tmp_path / "outside.html").touch()
    report(made, out)
    again = content(out)
    assert again.pop(mine) == b"not ours"
    assert again == content(site)
    assert (tmp_path / "outside.html").exists()
    there = again.keys() - {LIST}
    assert (out / LIST).read_text().splitlines() == [HEAD, *sorted(there)]


def test_files_of_others_stay(made, tmp_path, capsys):
    """`--out` may be any folder: what is not of a report is neither taken away nor written over."""
    mine = {f"{name}/me.{end}" for name, end in (("pictures", "png"), ("sweeps", "csv"))}
    for name in mine:
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    for _ in range(2):
        report(made, tmp_path)
        assert mine < content(tmp_path).keys()


@pytest.mark.parametrize("name", ["summary.md", "files.txt", "pictures", "sweeps"])
@pytest.mark.usefixtures("drawing")
def test_what_is_in_the_way_of_a_report_is_told(made, tmp_path, capsys, name):
    (tmp_path / name).write_text("mine")
    assert main(["report", str(made), "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == (
        f"rotctl: {tmp_path / name}: is there, and of no earlier report; choose another --out\n"
    )
    assert content(tmp_path) == {name: b"mine"}


def test_a_link_to_nothing_is_not_replaced(tmp_path):
    link = tmp_path / "index.html"
    link.symlink_to("none")
    with pytest.raises(InputError, match="index.html: is there, and of no earlier report"):
        write_report({"index.html": b""}, tmp_path)
    assert link.is_symlink()
    assert [*tmp_path.iterdir()] == [link]


def test_of_a_report_that_does_not_say_what_is_its_own_nothing_is_taken_away(tmp_path):
    """As older versions made them."""
    (tmp_path / "pictures").mkdir()
    for name in ("index.html", "replay.js", "pictures/old.png"):
        (tmp_path / name).write_text("old")
    write_report({"index.html": b"new"}, tmp_path)
    there = {"index.html": b"new", "replay.js": b"old", "pictures/old.png": b"old"}
    assert content(tmp_path) == {**there, LIST: f"{HEAD}\nindex.html\n".encode()}


def test_two_reports_at_once_are_both_listed(tmp_path, monkeypatch):
    """The other begins and ends while the first one is written."""

    def meanwhile(path, data):
        if path.name == "first.html":
            monkeypatch.undo()
            (tmp_path / LIST).unlink()
            write_report({"second.html": b""}, tmp_path)
        replace_file(path, data)

    monkeypatch.setattr("rotctl.report.site.folder.files.replace", meanwhile)
    write_report({"first.html": b""}, tmp_path)
    listed = ["first.html", "second.html"]
    assert (tmp_path / LIST).read_text().splitlines() == [HEAD, *listed]


def test_a_report_that_was_cut_off_is_made_again(made, site, tmp_path, monkeypatch):
    def full(path, data):
        if path.name == "index.html":
            raise InputError("no space left")
        real(path, data)

    real = replace_file
    with monkeypatch.context() as patched:
        patched.setattr("rotctl.report.site.folder.files.replace", full)
        with pytest.raises(InputError):
            report(made, tmp_path)
    report(made, tmp_path)
    assert content(tmp_path) == content(site)


# ---------------------------------------------------------------- for programs


def test_claims_csv_has_a_line_a_claim(site):
    rows = list(csv.DictReader(io.StringIO((site / "claims.csv").read_text())))
    assert [(row["id"], row["verdict"]) for row in rows] == [
        ("roll", "reproduced"),
        ("roll.speed", "not tested"),  # half a second is over before it settled
        ("decline", "not reproduced"),
        ("gone", "not tested"),
    ]
    assert (rows[0]["sweep"], rows[0]["experiment"]) == ("table", "test")
    assert (rows[0]["value"], rows[0]["low"], rows[0]["runs"]) == ("1", "0.438503", "3")
    assert json.loads(rows[0]["where"]) == {"behaviour": "forward_roll_1"}


def test_junit_has_a_case_a_claim(site):
    (suite,) = Xml.parse(site / "junit.xml").getroot()
    assert suite.attrib == {"name": "table: test", "tests": "4", "failures": "1", "skipped": "2"}
    roll, _, decline, gone = suite
    assert (roll.get("name"), len(roll)) == ("roll", 0)
    assert decline[0].tag == "failure"
    assert re.fullmatch(
        r"not reproduced: Success rate at most 10 % expected, \d+ \[\d+, \d+\] % measured over 3 "
        "runs",
        decline[0].get("message"),
    )
    assert gone[0].tag == "skipped"


def test_the_summary_is_markdown_without_html(site):
    text = (site / "summary.md").read_text()
    assert text.startswith(f"# Does it reproduce the paper?\n\n**{ANSWER}**\n")
    assert "## A test of &lt;b>rolls&lt;/b>" in text
    assert "| roll | Success rate | at least 90 % | 100 \\[44, 100\\] % | 3 | reproduced |" in text


# ---------------------------------------------------------------- strangers, gaps, failures


def test_a_strangers_names_are_text_everywhere(sweep, tmp_path):
    evil = EXPERIMENT.replace("nobody", EVIL).replace("title: A", f"title: {EVIL}")
    (sweep / "experiment-test.yaml").write_text(evil.replace("id: gone", f'id: "{EVIL}"'))
    log = RunLog.open(sorted(sweep.glob("*/run.h5"))[0])
    config = log.config_yaml.replace("name: decline", f"name: '{EVIL}'")
    config = config.replace("name: forward_roll_1", f"name: '{EVIL}'")
    outcome = {**log.outcome, "behaviour": EVIL, "success": False, "failure_reason": EVIL}
    hostile = changed(log, tmp_path, outcome=outcome, config=config, run_id=f'x"{EVIL}')
    (sweep / "evil").mkdir()
    shutil.move(hostile.path, sweep / "evil" / "run.h5")
    build.MOST_DRAWN = 9  # monkeypatch puts it back
    report(sweep.parent, tmp_path / "site")
    files = content(tmp_path / "site")
    assert "replays/script-alert-1-script-median.html" in files
    for name, data in files.items():
        assert b"<script>alert" not in data or name.endswith(".csv")
    index = Page(tmp_path / "site" / "index.html")
    assert EVIL in index.text
    assert index.all("script") == []
    Xml.parse(tmp_path / "site" / "junit.xml")


def test_a_log_that_was_changed_is_not_played(sweep, tmp_path):
    for log in sweep.glob("*/run.h5"):
        with h5py.File(log, "r+") as file:
            file["trajectory/qpos"][5, 2] += 0.1
    build.MOST_DRAWN = 9  # monkeypatch puts it back
    report(sweep, tmp_path / "site")
    assert list((tmp_path / "site").glob("replays/*.html")) == []
    text = " ".join(Page(tmp_path / "site" / "index.html").text.split())
    assert "run.h5: damaged, its content does not match its SHA-256" in text


def test_missing_failed_and_damaged_runs_are_told(sweep, tmp_path):
    logs = sorted(sweep.glob("*/run.h5"))
    logs[0].write_bytes(logs[0].read_bytes()[:1000])
    entries = read(sweep)
    for log, reason in zip(logs[1:3], ("its worker died", ""), strict=True):
        name = log.parent.name
        entries[name] = Entry(name, entries[name].values, reason)
        log.unlink()
    write(sweep, entries.values())
    report(sweep, tmp_path / "site")
    text = " ".join(Page(tmp_path / "site" / "index.html").text.split())
    assert f"{logs[0].parent.name}: damaged: truncated or damaged HDF5 file" in text
    assert f"{logs[1].parent.name}: failed to run: its worker died" in text
    assert "1 run of the sweep is not there; the same command does what is left" in text
    assert "3 with a result, 3 without" in text
    assert "without a result" in text


def test_a_log_that_cannot_be_drawn_is_told(sweep, tmp_path):
    for log in sweep.glob("*/run.h5"):
        small = changed(RunLog.open(log), tmp_path, model_xml="<mujoco/>")
        shutil.move(small.path, log)
    build.MOST_DRAWN = 9  # monkeypatch puts it back
    report(sweep, tmp_path / "site")
    assert "no replay: " in Page(tmp_path / "site" / "index.html").text
    assert str(sweep) not in (tmp_path / "site" / "index.html").read_text()


def test_a_machine_without_opengl_makes_a_report_without_filmstrips(sweep, tmp_path, monkeypatch):
    def no_backend():
        raise InputError("cannot render: no working OpenGL")

    monkeypatch.setattr("rotctl.report.gl.backend", no_backend)
    build.MOST_DRAWN = 1  # monkeypatch puts it back
    report(sweep, tmp_path / "site")
    text = Page(tmp_path / "site" / "index.html").text
    assert "no filmstrip: cannot render: no working OpenGL" in text
    assert list(tmp_path.glob("site/replays/*.html"))


def test_a_wrong_experiment_or_manifest_is_told_and_the_rest_is_there(sweep, tmp_path):
    (sweep / "experiment-test.yaml").write_text("title: [")
    broken = sweep.parent / "broken"
    broken.mkdir()
    (broken / "sweep.jsonl").write_text("nonsense\n")
    shutil.copytree(sorted(sweep.glob("*/"))[0], sweep.parent / "loose")
    claims = report(sweep.parent, tmp_path / "site")
    assert claims == []
    text = " ".join(Page(tmp_path / "site" / "index.html").text.split())
    assert "No claims to judge." in text
    assert f"left out: {broken}/sweep.jsonl: line 1 is not a row of a sweep" in text
    assert "loose/run.h5: is part of no sweep, left out" in text
    assert "its claims are not judged: " in text
    assert "What these runs did" in text
    for empty in ("Does it reproduce the paper?", "How verdicts are made", "no claim "):
        assert empty not in text
    assert "forward_roll_1" in text


def test_a_single_sweep_and_bare_runs_will_do(sweep, tmp_path):
    (found,), notes = sweeps(sweep)
    assert (found.name, notes) == ("table", [])
    (sweep / "sweep.jsonl").unlink()
    (found,), notes = sweeps(sweep)
    assert len(found.runs) == 6
    assert notes == []


# ---------------------------------------------------------------- the command


def test_no_runs_is_one_line(tmp_path, capsys):
    for folder, message in (
        (tmp_path / "none", f"{tmp_path / 'none'}: no such folder"),
        (tmp_path, f"{tmp_path}: no runs in it; rotctl sweep --out {tmp_path} makes some"),
    ):
        assert main(["report", str(folder), "--out", str(tmp_path / "site")]) == 2
        assert capsys.readouterr() == ("", f"rotctl: {message}\n")
    assert not (tmp_path / "site").exists()


def test_against_tells_what_changed_and_fails_if_worse(sweep, tmp_path, capsys):
    site = str(tmp_path / "site")
    command = ["report", str(sweep.parent), "--out", site]
    assert main(command) == 0
    assert capsys.readouterr().out.startswith(f"{site}/index.html\n")
    assert main([*command, "--against", site]) == 0
    assert capsys.readouterr().out.endswith("no claim changed its verdict\n")
    better = EXPERIMENT.replace("at_most, expected: 0.1", "at_most, expected: 1.0")
    worse = better.replace("at_least, expected: 0.9", "at_most, expected: 0.0")
    (sweep / "experiment-test.yaml").write_text(worse.replace("id: gone", "id: new"))
    assert main([*command, "--against", site]) == 1
    assert capsys.readouterr().out.splitlines()[-3:] == [
        "- worse: table/test/roll: reproduced -> not reproduced",
        "- better: table/test/decline: not reproduced -> reproduced",
        "- new: table/test/new: absent -> not tested",
    ]


def test_a_tested_claim_that_has_gone_is_worse():
    old = {("s", "e", "tested"): "partly", ("s", "e", "untested"): "not tested"}
    found = against.changes(old, [])
    assert (found.text, found.worse) == ("- worse: s/e/tested: partly -> absent", True)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "--against {old}: no report, there is no {old}/claims.csv"),
        *(
            (text, "{old}/claims.csv: is no claims.csv of a report, its columns must include "
             "sweep, experiment, id, verdict")
            for text in ("id,verdict\nx,reproduced\n", "any text\n", "\n", "\x1b\0", "a,b\n" * 99,
                         '"' + "x" * 200_000, '"torn')
        ),
        ("sweep,experiment,id,verdict\ns,e,x\n",
         "{old}/claims.csv: row 1 is no claim with its verdict"),
        ("sweep,experiment,id,verdict\ns,e,x,partly\n\n",
         "{old}/claims.csv: row 2 is no claim with its verdict"),
        ("sweep,experiment,id,verdict\ns,e,x,partly\ns,e,x,reproduced\n",
         "{old}/claims.csv: row 2 judges s/e/x again"),
        (
            "sweep,experiment,id,verdict\ns,e,x,good\n",
            "{old}/claims.csv: row 1 is no claim with its verdict",
        ),
    ],
)  # fmt: skip
def test_what_is_no_report_is_one_line(made, tmp_path, capsys, text, message):
    old = tmp_path / "old"
    old.mkdir()
    if text:
        (old / "claims.csv").write_text(text)
    command = ["report", str(made), "--out", str(tmp_path / "site"), "--against", str(old)]
    assert main(command) == 2
    assert capsys.readouterr() == ("", f"rotctl: {message.format(old=old)}\n")
    assert not (tmp_path / "site").exists()


def test_any_file_is_no_earlier_report(made, tmp_path, capsys):
    """In CI a path that is wrong, but there, would pass for ever."""
    command = ["report", str(made), "--out", str(tmp_path / "site"), "--against"]
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "empty").touch()
    (tmp_path / "binary").write_bytes(b"\xff")
    columns = (
        "is no claims.csv of a report, its columns must include sweep, experiment, id, verdict"
    )
    for name, said in (
        ("pipe", "is no plain file"),
        ("empty", columns),
        ("binary", "is no text (UTF-8)"),
    ):
        assert main([*command, str(tmp_path / name)]) == 2
        where = f"{tmp_path / name}" + (":1" if name == "binary" else "")
        assert capsys.readouterr() == ("", f"rotctl: {where}: {said}\n")
    assert main([*command, str(made / "table" / "sweep.jsonl")]) == 2
    assert capsys.readouterr().err.endswith(f"sweep.jsonl: {columns}\n")


def test_a_folder_that_cannot_be_written_is_one_line(sweep, tmp_path, capsys):
    (tmp_path / "file").touch()
    assert main(["report", str(sweep), "--out", str(tmp_path / "file")]) == 2
    assert capsys.readouterr().err.startswith(f"rotctl: cannot write {tmp_path / 'file'}")


def test_a_sweep_of_ones_own_reproduces_no_paper(tmp_path):
    swept(tmp_path / "own", "behaviour=stand", "duration=0.2", "seed=0")
    report(tmp_path / "own", tmp_path / "site")
    text = (tmp_path / "site" / "summary.md").read_text()
    assert text.startswith("# What these runs did\n\n**No claims to judge.**\n")
    assert "What these runs did" in Page(tmp_path / "site" / "index.html").text


def test_runs_of_one_seed_are_not_told_as_so_many_starts(sweep, tmp_path):
    whole = EXPERIMENT.replace(", where: {behaviour: forward_roll_1}", "")
    (sweep / "experiment-test.yaml").write_text(whole.replace(", where: {behaviour: decline}", ""))
    (found,), _ = sweeps(sweep)
    (study,) = studies(found)
    assert warnings(study)[0] == "Only 6 runs from 3 seeds a row, so that the intervals are wide."


@pytest.mark.parametrize(
    ("whole", "one", "asked"),
    [
        ("ours", "ours, after a talk", "Do the claims hold?"),
        ("ours", "[Brown2013] Table 1", "Does it reproduce the paper?"),
        ("[AlBorno2014]: dives", "ours", "Does it reproduce the paper?"),
    ],
)
def test_claims_of_ones_own_are_no_papers(sweep, tmp_path, whole, one, asked):
    text = EXPERIMENT.replace('"[Brown2013] Table 1"', f'"{whole}"')
    text = text.replace("source: paper", f'source: "{one}"')
    (sweep / "experiment-test.yaml").write_text(text)
    report(sweep, tmp_path / "site")
    assert (tmp_path / "site" / "summary.md").read_text().startswith(f"# {asked}\n\n**{ANSWER}**")
    page = Page(tmp_path / "site" / "index.html").text
    assert asked in page
    assert ("the paper" in page) == ("paper" in asked)


def test_a_move_that_does_not_roll_has_its_own_metrics_on_the_page_of_its_sweep(tmp_path):
    pushes = ("disturbance=push", "disturbance.impulse=10,20,30", "disturbance.time=[0.1,0.1]")
    swept(tmp_path / "own", "behaviour=stand", *pushes, "duration=0.4", "seed=0")
    (found,), _ = sweeps(tmp_path / "own")
    laid_out = grid(found.table)
    assert {"lean_most", "speed_end", "duration"} <= set(laid_out.metrics)
    assert not {"criteria", "parts"} & set(laid_out.metrics)
    assert drawn(laid_out)[:2] == ["lean_most", "lean_end"]
    assert [chart.heading for chart in charts(laid_out)][:2] == [
        "Success rates with 95 % intervals; medians and quartiles of the rest",
        "Over disturbance.impulse: success rate with its 95 % interval, medians with quartiles",
    ]
    alone = replace(laid_out, groups=laid_out.groups[:1], axes=[])
    assert charts(alone)[0].heading == "Success rates with 95 % intervals"


def test_the_page_of_a_sweep_has_the_share_that_rolled_on_after_a_push(sweep, tmp_path):
    listed = index.read(sweep)
    (sweep / index.INDEX_NAME).unlink()
    writer = Writer(sweep, index.Index())
    for row in listed.rows.values():
        late = row.outcome["seed"] > 0
        writer.add(row._replace(outcome={**row.outcome, "recovered": 0.0 if late else 1.0}))
    writer.close()
    report(sweep, tmp_path / "site")
    text = " ".join(Page(tmp_path / "site" / "sweeps" / "table.html").text.split())
    _, _, groups = text.partition("Rolled on in time after the push")
    assert groups.count(" 33 %") == 2


def test_who_fell_first_and_leans_most_is_the_worst_where_nothing_rolls():
    done = pd.DataFrame(
        {
            "run_id": ["stood", "moved", "fell late", "leant", "fell first"],
            "success": [True, False, False, False, False],
            "other_contact": [0.0, 0.0, 0.4, 0.0, 1.9],
            "lean_end": [1.0, 3.0, 80.0, 25.0, 70.0],
        }
    )
    assert from_worst(done) == ["fell first", "fell late", "leant", "moved", "stood"]
    rolled = done.assign(revolutions=[9.0, 1.0, 3.0, 2.0, 4.0])
    assert from_worst(rolled) == ["moved", "leant", "fell late", "fell first", "stood"]


def test_a_row_over_several_settings_says_so_and_of_which_its_pictures_are(tmp_path):
    swept(tmp_path / "own", "behaviour=stand", "duration=0.2,0.3,0.4", "seed=0")
    (found,), _ = sweeps(tmp_path / "own")
    (row,) = rows(found, None)
    assert row.pooled == "config.duration 0.2, 0.3, 0.4"
    assert set(row.which.values()) <= {f"config.duration {time}" for time in (0.2, 0.3, 0.4)}
    report(tmp_path / "own", tmp_path / "site")
    text = " ".join(Page(tmp_path / "site" / "index.html").text.split())
    assert "taken together: config.duration 0.2, 0.3, 0.4." in text
    assert f"Median run: seed 0 run {row.median.run_id}, config.duration 0.3" in text


def test_runs_that_are_the_same_to_the_bit_are_told(sweep, tmp_path):
    listed = index.read(sweep)
    (sweep / index.INDEX_NAME).unlink()
    writer = Writer(sweep, index.Index())
    for row in listed.rows.values():
        writer.add(row._replace(trajectory="0" * 64))
    writer.close()
    report(sweep, tmp_path / "site")
    text = " ".join(Page(tmp_path / "site" / "index.html").text.split())
    assert "100 % [21, 100] of 3 runs 1 distinct" in text
    told = "decline: 3 runs, 1 distinct, as many as its interval is of"
    assert told in text
    assert f"> {told}" in (tmp_path / "site" / "summary.md").read_text()
    assert "6 runs, 2 distinct" in Page(tmp_path / "site" / "sweeps" / "table.html").text


@pytest.mark.parametrize(
    ("seeds", "rest"),
    [
        ("range(0,3)", ""),
        ("range(0,9)", " The whole experiment has seed=range(0,9)."),
        ("range(3", " The whole experiment has seed=range(3."),  # a stranger's
    ],
)
def test_few_starts_are_the_whole_experiment_or_not(sweep, seeds, rest):
    (sweep / "experiment-test.yaml").write_text(EXPERIMENT.replace("range(0,3)", seeds))
    (found,), _ = sweeps(sweep)
    (study,) = studies(found)
    assert warnings(study)[0] == f"Only 3 starts a row, so that the intervals are wide.{rest}"


def test_one_of_something_is_no_number_of_them(tmp_path, monkeypatch):
    monkeypatch.setattr(build, "MOST_DRAWN", 0)
    out = swept(tmp_path / "sweeps" / "one", "seed=2000", "duration=1")
    (out / "experiment-test.yaml").write_text(EXPERIMENT.replace("speed_mean", "revolutions"))
    report(tmp_path / "sweeps", tmp_path / "site")
    failed = list(Xml.parse(tmp_path / "site" / "junit.xml").getroot().iter("failure"))
    assert failed
    assert all(each.get("message").endswith(" measured over 1 run") for each in failed)
    assert "> Only 1 start a row" in (tmp_path / "site" / "summary.md").read_text()


def test_claims_that_nobody_could_test_are_named_with_the_reason(sweep, tmp_path, capsys):
    (sweep / "experiment-test.yaml").write_text(EXPERIMENT.replace("speed_mean", "sped_mean"))
    assert main(["report", str(sweep), "--out", str(tmp_path / "site")]) == 0
    why = [
        "Not tested, the summary has no 'sped_mean': roll.speed",
        "Not tested, no such run in the sweep: gone",
    ]
    assert capsys.readouterr().out.splitlines() == [str(tmp_path / "site" / "index.html"), *why]
    text = Page(tmp_path / "site" / "index.html").text
    assert all(line in text for line in why)
    assert (
        "> Not tested, no such run in the sweep: gone"
        in (tmp_path / "site" / "summary.md").read_text()
    )


# ---------------------------------------------------------------- words


def test_all_that_is_measured_has_a_title():
    assert set(METRICS) <= QUANTITIES.keys()
    for name in choices("behaviour"):
        assert numbers(load([f"behaviour={name}"])) <= QUANTITIES.keys(), name
    assert with_unit(number(3), "solver_failures") == "3 steps"


@pytest.mark.parametrize(
    ("reason", "expected"),
    [
        ("stalled for 3.20 s from t = 1.00 s", "stalled for \u2026 s"),
        ("heading off by -40 deg at the end", "heading off by \u2026 deg at the end"),
        ("is up from 4.21 s only", "is up from \u2026 s only"),
        ("turned 312 deg of 360", "turned \u2026 deg of \u2026"),
        ("fell: centre of mass 0.10 m above the ground", "fell"),
        ("left the ground at t = 3.10 s, x = 60.03 m, y = 1.00 m: it", "left the ground"),
        ("physics broke down at t = 0.50 s: MuJoCo warns", "physics broke down"),
        ("part 2 of 3, roll_1: leans by 40 deg", "part 2 of 3, roll_1: leans by \u2026 deg"),
        ("part 3 of 3, roll_1, has not begun", "part 3 of 3, roll_1, has not begun"),
        ("x" * 200, "x" * 79 + "\u2026"),
        ("", "no reason given"),
    ],
)
def test_reasons_without_their_numbers(reason, expected):
    assert kind(reason) == expected


@pytest.mark.parametrize(
    ("quantile", "values", "expected"),
    [
        (0.5, [1.0, 2.0, 3.0, 4.0, 5.0], "3 [2, 4] s"),
        (0.9, [1.0, 2.0, 3.0, 4.0, 5.0], "4.6 s, quartiles 2 and 4"),
        (0.9, [1.0, 1.0, 1.0], "1 s"),
        (0.9, [1.0, 1.0, 1.0, 1.0, 3.0], "2.2 s, quartiles 1 and 1"),
        (0.9, [None], "\u2013"),
    ],
)
def test_a_quantile_has_no_brackets_that_it_does_not_lie_in(quantile, values, expected):
    claim = Claim("c", "longest_stall", 1.0, 0.0, "ours", quantile=quantile)
    runs = pd.DataFrame({"success": [True] * len(values), "longest_stall": values})
    assert outcome(judge(claim, runs, [])) == expected


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (0.7061, "0.706"),
        (-0.0001, "0"),
        (-3.756, "\u22123.76"),
        (12345.6, "12346"),
        (None, "\u2013"),
    ],
)
def test_numbers_have_three_digits(value, expected):
    assert number(value) == expected


def test_names_of_files_are_plain_and_given_once():
    names = Names()
    assert [names.give(text) for text in ("A b/../c", "a b c", "<>", "滚")] == [
        "a-b-c",
        "a-b-c-2",
        "x",
        "x-2",
    ]
    assert ranges([5, 0, 1, 2, 7]) == "0-2, 5, 7"
