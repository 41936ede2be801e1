"""A stretch of motion that turns about once, to a cycle that closes."""

from dataclasses import dataclass
from math import tau

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.turning import AXIS, Motion, rolled_by

DENSE = 360  # postures of the cycle
LEAST = 0.5  # [rev] that a cycle must turn before it is stretched to one


@dataclass(frozen=True)
class Closed:
    """A closed cycle, and what it took.

    Attributes:
        cycle: postures that are even over the turn made.
        gap: (nu,) by which each joint missed its start [rad].
        pelvis_gap: angle by which the pelvis missed one whole turn [rad].
        backwards: share of the time in which the body turned back [-].
    """

    cycle: Motion
    gap: Array
    pelvis_gap: float
    backwards: float


def close(motion: Motion, turns: Array) -> Closed:
    """Index a motion by the turn made, stretch that to one revolution, spread the gap evenly.

    Where the body turns back, it waits until it is again where it was.

    Args:
        motion: n postures that turn about +y.
        turns: (n - 1, 3) of the whole body between them [rad].

    Raises:
        InputError: it does not turn forwards.
    """
    advance = turns @ AXIS
    furthest = np.maximum.accumulate(np.append(0.0, np.cumsum(advance)))
    onward = np.append(True, np.diff(furthest) > 1e-9)
    if onward.sum() < 4 or furthest[-1] < LEAST * tau:
        raise InputError(f"no roll about one axis: the body turns {furthest[-1] / tau:.2f} rev")
    place = np.linspace(0.0, furthest[-1], DENSE + 1)
    made = furthest[onward]
    poses = np.stack([np.interp(place, made, joint) for joint in motion.poses[onward].T], axis=1)
    pelvis = Slerp(made, motion.pelvis[onward])(place)

    share = np.linspace(-0.5, 0.5, DENSE + 1)
    gap = poses[-1] - poses[0]
    poses -= np.outer(share, gap)
    roll = rolled_by(tau * (share + 0.5))
    unrolled = roll.inv() * pelvis  # what is left of a steady turn
    missed = (unrolled[-1] * unrolled[0].inv()).as_rotvec()
    pelvis = roll * Rotation.from_rotvec(np.outer(-share, missed)) * unrolled
    return Closed(
        Motion(poses[:-1], pelvis[:-1]),
        gap,
        float(np.linalg.norm(missed)),
        float((advance < 0.0).mean()),
    )
