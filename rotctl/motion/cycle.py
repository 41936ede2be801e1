"""A closed cycle over a phase, re-indexed so that the excursion AE is linear in the phase."""

from math import tau

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.clip import TurnAbout
from rotctl.motion.reference import periodic
from rotctl.motion.turning import AXIS, Motion, pelvis_turn, rotation_between_postures

SAMPLES = 72  # of a clip: every 5 degrees of phase
_LEAST = 1e-4  # [rev] of AE from a posture to the next, so that there is an inverse


def by_excursion(model: Model, cycle: Motion, roll_about: TurnAbout, samples: int) -> Motion:
    """The same cycle at even phases 2 pi k / samples of AE; phase 0 is the pelvis upright.

    Args:
        cycle: closed: its last posture would be followed by its first.

    Raises:
        InputError: it does not turn once about +y.
    """
    n = len(cycle.poses)
    round_trip = at_places(cycle, np.arange(n + 1) / n)
    advance = rotation_between_postures(model, round_trip) @ AXIS / tau
    turned = pelvis_turn(round_trip.pelvis, roll_about) / tau
    if abs(turned[-1] - turned[0] - 1.0) > 1e-6:
        raise InputError(
            f"the pelvis turns {turned[-1] - turned[0]:+.2f} rev about the rolling axis in a "
            "cycle, it must be +1"
        )
    phase = np.append(0.0, np.cumsum(np.maximum(advance, _LEAST)))
    phase /= phase[-1]
    zero = _at_whole_turn(turned, phase)
    wanted = np.mod(zero + np.arange(samples) / samples, 1.0)
    return at_places(cycle, np.interp(wanted, phase, np.arange(n + 1) / n))


def _at_whole_turn(turned: Array, phase: Array) -> float:
    """The phase at which `turned` [rev] first comes to a whole number."""
    whole = np.floor(turned + 1e-9)  # an authored cycle starts at one, but for rounding
    before = int(np.argmax(np.diff(whole) > 0.0))
    pair = slice(before, before + 2)
    return float(np.interp(whole[before + 1], turned[pair], phase[pair]))


def at_places(cycle: Motion, places: Array) -> Motion:
    """A closed cycle at places (m,) [cycles]."""
    n = len(cycle.poses)
    closed = Rotation.concatenate([cycle.pelvis, cycle.pelvis[0]])
    pelvis = Slerp(np.arange(n + 1) / n, closed)(np.mod(places, 1.0))
    return Motion(periodic(cycle.poses, places), pelvis)
