"""The compiled library: taken only if it was built from this source, for this MuJoCo."""

import os
import re
import shutil
import subprocess
from importlib import import_module
from pathlib import Path

import mujoco
import pytest

from rotctl.native.source import source_hash

ROOT = Path(__file__).parent.parent
native = import_module("rotctl.native.library")
pytestmark = pytest.mark.skipif(
    native.library() is None, reason="the library is not built here (no C compiler at installation)"
)


@pytest.fixture
def found_anew():
    """What `library` finds now, whatever it found before."""
    native.library.cache_clear()
    yield native.library
    native.library.cache_clear()


def test_it_is_taken_if_all_is_as_it_was(found_anew):
    assert found_anew() is not None


def test_one_of_other_source_is_refused(found_anew, monkeypatch, tmp_path):
    shutil.copytree(native.FOLDER, tmp_path / "native")
    monkeypatch.setattr(native, "FOLDER", tmp_path / "native")
    assert found_anew() is not None
    found_anew.cache_clear()
    with (tmp_path / "native" / "small.h").open("a") as header:
        header.write("// another\n")
    assert found_anew() is None


def test_a_source_that_came_or_went_is_seen(tmp_path):
    (tmp_path / "a.c").write_text("int a;")
    one = source_hash(tmp_path)
    (tmp_path / "notes.txt").write_text("no source")
    assert source_hash(tmp_path) == one
    (tmp_path / "b.h").touch()
    assert source_hash(tmp_path) != one


@pytest.mark.skipif(not shutil.which("make"), reason="needs make")
def test_set_up_builds_it_again_for_another_source_of_an_older_time(tmp_path):
    """As a copy or an archive leaves one behind; and not for the same source of a newer one."""

    def stamp():
        printed = subprocess.run(
            ["make", "--dry-run", "--always-make", "setup"],
            cwd=tmp_path, capture_output=True, text=True, check=True,
        ).stdout  # fmt: skip
        return re.search(r"touch (\S+/\.installed-\d+)\n", printed)[1]

    for name in ("Makefile", "requirements.lock", "pyproject.toml", "hatch_build.py"):
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(native.FOLDER, tmp_path / "rotctl" / "native")
    header = tmp_path / "rotctl" / "native" / "small.h"
    one = stamp()
    header.touch()
    assert stamp() == one
    with header.open("a") as file:
        file.write("// another\n")
    os.utime(header, (0, 0))
    assert stamp() != one


def test_one_for_another_mujoco_is_refused(found_anew, monkeypatch):
    monkeypatch.setattr(mujoco, "mj_version", lambda: -1)
    assert found_anew() is None


@pytest.mark.parametrize("content", [None, b"", b"no library"])
def test_one_that_is_no_library_is_as_none(found_anew, monkeypatch, tmp_path, content):
    if content is not None:
        (tmp_path / "x.so").write_bytes(content)
    monkeypatch.setattr(native, "LIBRARY", tmp_path / "x.so")
    assert found_anew() is None
