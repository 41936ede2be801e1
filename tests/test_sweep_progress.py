"""Progress: a line now and then where nobody watches, with rate, time left and counts."""

from types import SimpleNamespace

import pytest

from rotctl.sweep import progress
from rotctl.sweep.launch import Tally
from rotctl.sweep.progress import duration, shown


def test_lines_come_every_ten_seconds(monkeypatch, capsys):
    clock = iter([0.0, 1.0, 12.0, 13.0, 24.0])
    # The module's own clock alone: other threads of this process read the real one.
    monkeypatch.setattr(progress, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    with shown(100, 10, quiet=False) as update:
        update(Tally(10, 0, {}))
        update(Tally(20, 2, {}))
        update(Tally(21, 2, {}))
        update(Tally(30, 3, {"a": "no luck"}))
    assert capsys.readouterr().err == (
        "22/100 runs, 1 run/s, 78 s left, 20 succeeded, 2 did not\n"
        "34/100 runs, 1 run/s, 66 s left, 30 succeeded, 3 did not, 1 failed to run\n"
    )


def test_quiet_is_quiet(capsys):
    with shown(3, 0, quiet=True) as update:
        update(Tally(3, 0, {}))
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.0, "0 s"), (89.0, "89 s"), (120.0, "2 min"), (5400.0, "1.5 h")],
)
def test_a_time_span_for_people(seconds, text):
    assert duration(seconds) == text
