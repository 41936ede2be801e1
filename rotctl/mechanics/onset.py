"""When something begins in a run: at a time, or as the behaviour next comes through a phase."""

from math import nan, tau
from typing import Annotated

from pydantic import AfterValidator

from rotctl.settings.fields import Drawn, ends


def _from_the_start(time: float | tuple[float, float]) -> float | tuple[float, float]:
    if ends(time)[0] < 0.0:
        raise ValueError("must not begin before the run does, at 0 s")
    return time


def _within_a_turn(phase: float | tuple[float, float]) -> float | tuple[float, float]:
    if max(map(abs, ends(phase))) > 360.0:
        raise ValueError("must lie within a revolution, from -360 to 360 deg")
    return phase


SHORTEST = 1e-3  # [s] of what acts for a while: time counts to 1e-15 of itself
ROUNDING = 1e-9  # [s] by which a run's time, a sum of its steps, may miss a control step's

Time = Annotated[Drawn, AfterValidator(_from_the_start)]
"""Of a run [s]: a number, or a range to draw from."""
Phase = Annotated[Drawn, AfterValidator(_within_a_turn)]
"""Of a behaviour [deg]: a number, or a range to draw from."""


class Onset:
    """The control step at which something begins, asked for at each."""

    def __init__(self, begin: float, phase: float | None) -> None:
        """At `begin` [s], or from then on as the behaviour comes through that phase [rad]."""
        self._begin, self._phase, self._last = begin, phase, nan

    def come(self, time: float, phase: float) -> bool:
        """Whether it begins with this control step, at `time` [s], or has begun in one before.

        Args:
            phase: of the behaviour, a control step ago [rad].
        """
        last, self._last = self._last, phase
        if time < self._begin - ROUNDING:
            return False
        return self._phase is None or passed(self._phase, last, phase)


def passed(goal: float, last: float, phase: float) -> bool:
    """Whether a step from one phase to the next goes over `goal`, either way [rad]."""
    step, ahead = phase - last, goal - last
    return ahead % tau <= step if step > 0.0 else -ahead % tau <= -step


def far_from(time: float, period: float, begin: float, end: float) -> bool:
    """Whether a control step at `time` is two before `begin`, or two behind `end` [s]."""
    return time + 2.0 * period < begin or time - 2.0 * period > end
