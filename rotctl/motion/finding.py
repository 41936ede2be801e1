"""Which part of a captured motion is one roll, and about which way."""

from math import tau

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.clip import TurnAbout
from rotctl.motion.turning import Motion

SPAN = (0.8, 1.15)  # [rev] what passes for one roll: the loop is closed afterwards
LONGEST = 6.0  # [s]
CANDIDATES = 400  # frames that are tried as start and as end
# The cost of a cut, in rad of pose: how far apart its ends are, and how long it takes, since
# standing about before and after is not rolling.
PELVIS = 0.5  # [-] of the angle between the pelvis's orientations at the ends
MISSING = 2.0  # [rad/rev] of what the turn lacks or exceeds
DAWDLING = 1.0  # [rad/s]


def rolling_axis(turns: Array) -> Array:
    """The horizontal axis (3,) that most of the turning (n, 3) is about, its sum positive."""
    level = turns[:, :2]
    _, directions = np.linalg.eigh(level.T @ level)
    axis = np.array([*directions[:, -1], 0.0])
    return np.asarray(axis if turns.sum(axis=0) @ axis >= 0.0 else -axis)


def find_roll(time: Array, motion: Motion, turns: Array) -> tuple[float, int, int]:
    """The roll that closes best: its cost [rad], its first and last frame.

    Args:
        time: (n,) [s].
        turns: (n - 1, 3) of the body from frame to frame [rad].

    Raises:
        InputError: the body turns round nowhere.
    """
    turned = np.append(0.0, np.cumsum(turns @ rolling_axis(turns))) / tau
    tried = np.unique(np.linspace(0, len(time) - 1, CANDIDATES).astype(int))
    best, found = float(np.inf), None
    for first in tried:
        later = tried[(tried > first) & (time[tried] <= time[first] + LONGEST)]
        span = np.abs(turned[later] - turned[first])  # there or back
        later = later[(SPAN[0] <= span) & (span <= SPAN[1])]
        if not len(later):
            continue
        cost = _apart(motion, first, later) + DAWDLING * (time[later] - time[first])
        cost += MISSING * np.abs(np.abs(turned[later] - turned[first]) - 1.0)
        least = int(np.argmin(cost))
        if cost[least] < best:
            best, found = float(cost[least]), (int(first), int(later[least]))
    if found is None:
        raise InputError(
            f"no roll found: the body turns {np.ptp(turned):.2f} rev at most; "
            "give --cycle START:END [s]"
        )
    return (best, *found)


def roll_kind(motion: Motion) -> tuple[TurnAbout, bool, float]:
    """The trunk axis along +y, on average over a roll about +y; True if it is a mirror image.

    A log roll with the head to -y is the mirror image of ours, and so is a cartwheel to the
    left. The third value is how far along +y the next axis lies, of the one that is taken [-].
    """
    forward, left, up = motion.pelvis.inv().apply([0.0, 1.0, 0.0]).mean(axis=0)
    _, nearly, most = sorted(abs(x) for x in (forward, left, up))
    doubt = nearly / max(most, 1e-9)
    if abs(up) == most:
        return "head", bool(up < 0.0), doubt
    if abs(forward) == most:
        return "face", bool(forward < 0.0), doubt
    return ("left" if left > 0.0 else "right"), False, doubt


def _apart(motion: Motion, first: int, later: NDArray[np.int64]) -> Array:
    """How far postures are from the first [rad]."""
    apart = np.sqrt(np.mean((motion.poses[later] - motion.poses[first]) ** 2, axis=1))
    turned = (motion.pelvis[later] * motion.pelvis[int(first)].inv()).magnitude()
    return np.asarray(apart + PELVIS * turned)
