"""What the README tells people to type works."""

import re
import shlex
from pathlib import Path

import pytest
import readme_sample

from rotctl.cli.main import main
from rotctl.log import RunLog
from rotctl.log.provenance import libm
from rotctl.native import library

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^\.venv/bin/rotctl ([^#\n]*)", README, flags=re.MULTILINE)
LIBM = "4448391d"  # of glibc on a processor with FMA
RUNS = [line for line in COMMANDS if line.startswith("run ")]


def test_commands_were_found():
    assert len(COMMANDS) >= 6
    assert len(RUNS) >= 3


@pytest.mark.parametrize("line", RUNS)
def test_runs(line, tmp_path, capsys):
    words = [w for w in shlex.split(line) if w != "--filmstrip" and "duration" not in w]
    pushed = ["disturbance.time=[0,0]"] if "disturbance=push" in words else []
    ends = ["behaviour.finish.after=0"] if "+finish=stand" in words else []
    assert main([*words, *pushed, *ends, "duration=0.1", "--out", str(tmp_path)]) == 0
    assert "run.h5" in capsys.readouterr().out


@pytest.mark.parametrize("line", [line for line in COMMANDS if line not in RUNS])
def test_other_commands(line, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)  # not into our own conf/
    try:
        code = main(shlex.split(line))
    except SystemExit as end:  # argparse ends --help itself
        code = end.code
    assert code == 0
    assert capsys.readouterr().out


@pytest.mark.exact
def test_the_sample_is_what_everybody_gets():
    """The bits of a run are the same everywhere, so its figures are; `make readme` renews them."""
    if library() is None or libm() != LIBM:
        pytest.skip("no C compiler at installation, or a C library that rounds otherwise")
    here, there = (
        [line for line in lines if not re.match(" *(real time|filmstrip) ", line)]
        for lines in (readme_sample.printed(), readme_sample.shown())
    )
    assert len(here) == 7
    assert here == there, "the README is old; make readme"


def test_the_python_example_reads_a_log(tmp_path, capsys):
    assert main(["run", "duration=3", "--quiet", "--out", str(tmp_path)]) == 0
    (path,) = tmp_path.glob("*/run.h5")
    (snippet,) = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    snippet = re.sub(r'open\("[^"]*"\)', f"open({str(path)!r})", snippet)
    exec(snippet, {})  # our own README, not a stranger's file
    assert capsys.readouterr().out.startswith("True ")
    assert RunLog.open(path).steps == 180


def test_make_calls_what_the_readme_says():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert "rotctl run" in makefile
    for target in ("run:", "test:", "help:", "bench:", "lint:", "clean:"):
        assert re.search(rf"^{target}", makefile, flags=re.MULTILINE)


def test_links_lead_somewhere():
    for target in re.findall(r"\]\(([^)]+)\)", README):
        assert (ROOT / target.partition("#")[0]).exists(), target
