"""The compiled library: taken only if it was built from this source, for this MuJoCo."""

import shutil
from importlib import import_module

import mujoco
import pytest

from rotctl.native.source import source_hash

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


def test_one_for_another_mujoco_is_refused(found_anew, monkeypatch):
    monkeypatch.setattr(mujoco, "mj_version", lambda: -1)
    assert found_anew() is None


@pytest.mark.parametrize("content", [None, b"", b"no library"])
def test_one_that_is_no_library_is_as_none(found_anew, monkeypatch, tmp_path, content):
    if content is not None:
        (tmp_path / "x.so").write_bytes(content)
    monkeypatch.setattr(native, "LIBRARY", tmp_path / "x.so")
    assert found_anew() is None
