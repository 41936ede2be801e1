"""The plots beside a replay: which signals, in which plot, in which unit."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotctl.maths.rotations import Array
from rotctl.report.signals import Signals

Panel = dict[str, Any]
_ROOM = 0.06  # of the range above and below


@dataclass(frozen=True)
class Line:
    """One line of a plot.

    Attributes:
        role: ``achieved``, ``second``, ``third``, ``commanded`` or ``ghost``: its looks.
        steps: a value holds until the next one.
    """

    name: str
    role: str
    time: Array
    values: Array
    steps: bool = False

    def packed(self) -> dict[str, Any]:
        """For `rotctl.report.pack`."""
        single = {"time": self.time, "values": self.values}
        return {"name": self.name, "role": self.role, "steps": self.steps} | {
            key: np.asarray(array, dtype=np.float32) for key, array in single.items()
        }


def panels(run: Signals, other: Signals | None) -> list[Panel]:
    """The plots of a run, with another one laid over; none of a blend that neither has."""
    time, ends = run.time, run.commanded_time
    spin, speed = (np.full(len(ends), each) for each in (run.commanded_spin, run.commanded_speed))
    turns = run.commanded_spin * (ends - ends[:1])

    def over(values: str, column: int | None = None, steps: bool = False) -> list[Line]:
        if other is None:
            return []
        array = getattr(other, values)
        shown = array if column is None else array[:, column]
        return [Line("compared", "ghost", other.time, shown, steps)]

    blends = run.blends or (other is not None and other.blends)
    blend = _panel(
        "Blend \u03b3",
        "1",
        Line("0 pose b, 1 pose a", "achieved", time, run.blend),
        *over("blend"),
        limits=(-0.05, 1.05),
    )
    return [
        _panel(
            "In-plane angular velocity",
            "rev/s",
            Line("achieved", "achieved", time, run.spin[:, 1]),
            Line("commanded", "commanded", ends, spin),
            *over("spin", 1),
        ),
        _panel(
            "In-plane excursion",
            "rev",
            Line("achieved", "achieved", time, run.turns[:, 1]),
            Line("commanded", "commanded", ends, turns),
            *over("turns", 1),
        ),
        _panel(
            "Velocity of the centre of mass",
            "m/s",
            Line("forward", "achieved", time, run.velocity[:, 0]),
            Line("left", "second", time, run.velocity[:, 1]),
            Line("up", "third", time, run.velocity[:, 2]),
            Line("commanded forward", "commanded", ends, speed),
            *over("velocity", 0),
        ),
        *([blend] if blends else []),
        _panel(
            "Contacts",
            "1",
            Line("all", "achieved", time, run.count, steps=True),
            Line("used", "second", time, run.used, steps=True),
            *over("count", steps=True),
        ),
    ]


def _panel(title: str, unit: str, *lines: Line, limits: tuple[float, float] | None = None) -> Panel:
    known = [line for line in lines if np.isfinite(line.values).any()]
    low, high = limits or _limits(known)
    return {
        "title": title,
        "unit": unit,
        "limits": [low, high],
        "series": [line.packed() for line in known],
    }


def _limits(lines: list[Line]) -> tuple[float, float]:
    """Limits that show nearly everything: a single spike must not flatten the rest."""
    if not lines:
        return -1.0, 1.0
    spans = [np.percentile(line.values[np.isfinite(line.values)], [0.2, 99.8]) for line in lines]
    low, high = float(min(span[0] for span in spans)), float(max(span[1] for span in spans))
    if high - low < 1e-9:
        return low - 1.0, high + 1.0
    return low - _ROOM * (high - low), high + _ROOM * (high - low)
