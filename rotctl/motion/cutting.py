"""The parts of a capture that a roll is looked for in, cut out and finely sampled."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.glance import stretches
from rotctl.motion.landmarks import Landmarks

LONGEST = 60.0  # [s] of capture that are fitted
FEWEST = 5  # frames of a cycle
FINE = 1.0 / 120.0  # [s] a slower capture is interpolated to that
BESIDE = 0.5  # [s] what is fitted on either side of a given cycle


def cut(
    path: Path, time: Array, marks: Landmarks, cycle: tuple[float, float] | None
) -> list[tuple[Array, Landmarks]]:
    """Times and landmarks of each part: about a given cycle, else wherever the body turns round.

    Raises:
        InputError: there is none, the cycle is not in the capture, or all of it takes too long.
    """
    if cycle:
        parts = [_around(cycle, time)]
    else:
        parts = stretches(path, time, marks)
        lasts = sum(float(time[part][-1] - time[part][0]) for part in parts)
        if lasts > LONGEST:
            raise InputError(
                f"{path}: the body turns round in {lasts:.0f} s of it, a roll is looked for in "
                f"{LONGEST:g} s at most; give --cycle START:END [s]"
            )
    return [_fine(time[part], part_of(marks, part)) for part in parts]


def _around(cycle: tuple[float, float], time: Array) -> slice:
    """The frames of a given cycle, and some beside it, so that the fit does not begin in it."""
    start, end = cycle
    if not 0.0 <= start < end <= time[-1] + 1e-6:
        raise InputError(
            f"--cycle={start:g}:{end:g}: valid: 0 to {time[-1]:.3f} s, START before END"
        )
    first, last = within(cycle, time)
    if last - first + 1 < FEWEST:
        raise InputError(f"--cycle={start:g}:{end:g}: {last - first + 1} frames, at least {FEWEST}")
    near = np.flatnonzero((time >= start - BESIDE) & (time <= end + BESIDE))
    return slice(int(near[0]), int(near[-1]) + 1)


def within(cycle: tuple[float, float], time: Array) -> tuple[int, int]:
    """First and last frame of a cycle."""
    first, after = np.searchsorted(time, [cycle[0] - 1e-6, cycle[1] + 1e-6])
    return int(first), int(after) - 1


def part_of(marks: Landmarks, part: slice) -> Landmarks:
    """The landmarks of some frames."""
    return replace(marks, points={name: at[part] for name, at in marks.points.items()})


def _fine(time: Array, marks: Landmarks) -> tuple[Array, Landmarks]:
    """The landmarks at `FINE` steps, where the capture's are longer."""
    if np.median(np.diff(time)) <= 1.01 * FINE:
        return time, marks
    fine = np.linspace(time[0], time[-1], 1 + round((time[-1] - time[0]) / FINE))
    points = {name: CubicSpline(time, at)(fine) for name, at in marks.points.items()}
    return fine, replace(marks, points=points)
