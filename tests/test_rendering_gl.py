"""Which OpenGL is used, and the one line where there is none."""

import pytest

from rotctl.errors import InputError
from rotctl.report import gl

HINT = "on Debian: apt-get install libosmesa6"


@pytest.fixture(autouse=True)
def _forget(monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    gl.backend.cache_clear()
    yield
    gl.backend.cache_clear()


@pytest.fixture(autouse=True)
def _linux(monkeypatch):
    monkeypatch.setattr(gl, "_CANDIDATES", ("osmesa", "egl"))


def only(monkeypatch, *working):
    asked = []

    def works(name):
        asked.append(name)
        return name in working

    monkeypatch.setattr(gl, "works", works)
    return asked


@pytest.mark.parametrize(("working", "chosen"), [(("osmesa", "egl"), "osmesa"), (("egl",), "egl")])
def test_the_first_backend_that_works_is_taken_and_remembered(monkeypatch, working, chosen):
    asked = only(monkeypatch, *working)
    assert gl.backend() == chosen
    tries = len(asked)
    assert gl.backend() == chosen
    assert len(asked) == tries


def test_no_backend_says_what_to_install(monkeypatch):
    only(monkeypatch)
    with pytest.raises(InputError) as caught:
        gl.backend()
    assert str(caught.value) == f"cannot render: no working OpenGL (tried osmesa, egl); {HINT}"


def test_the_users_choice_is_the_only_one_tried(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "EGL")
    asked = only(monkeypatch, "osmesa", "egl")
    assert gl.backend() == "egl"
    assert asked == ["egl"]


def test_the_users_choice_is_named_where_it_fails(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "egl")
    only(monkeypatch, "osmesa")
    with pytest.raises(InputError) as caught:
        gl.backend()
    assert str(caught.value) == (
        f"cannot render: MUJOCO_GL=egl gives no working OpenGL; unset it to try osmesa, egl; {HINT}"
    )


@pytest.mark.parametrize("code", ["raise SystemExit(1)", "import os; os.abort()"])
def test_a_backend_that_ends_its_process_does_not_work(monkeypatch, code):
    monkeypatch.setattr(gl, "_PROBE", code)
    assert not gl.works("osmesa")


def test_a_backend_that_hangs_does_not_work(monkeypatch):
    monkeypatch.setattr(gl, "_PROBE", "import time; time.sleep(60)")
    monkeypatch.setattr(gl, "_PROBE_SECONDS", 0.2)
    assert not gl.works("osmesa")
