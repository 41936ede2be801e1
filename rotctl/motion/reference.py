"""Phase-locked reference poses: r_a and r_b a little after and before where the roll is now.

[Brown2013] section 4.3 with excursion in place of time: r_a = r(theta + lead + window) and
r_b = r(theta + lead - window), where r is one cycle of a clip over the phase theta; the paper has
r_a behind and r_b ahead, 1 - gamma for gamma. A captured motion seldom rolls on as it is; `offsets`
bend it until it does, smoothly and by a few numbers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import floor, tau
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.clip import Clip
from rotctl.motion.pose_pair import Turn
from rotctl.settings.fields import STRICT, Finite, NonNegative

STEPS = 720  # of the table that `at` reads: half a degree of phase

Harmonics = Annotated[list[Turn], Field(min_length=1, max_length=17)]  # a mean and up to eight


@validated(frozen=True, config=STRICT)
class ReferenceSettings:
    """Which clip is followed, and how.

    Attributes:
        clip: a name in `conf/motion/`, or the path of a clip.
        window: half the distance between r_a and r_b [rev of phase].
        lead: by how much their middle is ahead of the roll [rev of phase]; a pose takes
            time to reach.
        offsets: by joint name, what is added to the clip [rad]: its mean, cosine and sine over
            the phase, then cosine and sine of twice the phase, and so on. No side is both.
        found_for: the name in the clip that these numbers bend; any clip, if it is empty.
    """

    clip: str
    window: Annotated[NonNegative, Field(le=0.5)]
    lead: Annotated[Finite, Field(ge=-0.5, le=0.5)]
    offsets: dict[str, Harmonics] = field(default_factory=dict)
    found_for: str = ""


@dataclass(frozen=True)
class ReferencePair:
    """The two poses over the phase.

    Attributes:
        cycle: (n, nu) the clip at even phases [rad].
        table: (STEPS, 2, nu) r_a and r_b at even phases of one cycle [rad].
        rise: (STEPS, 2, nu) from there to the next of them [rad].
    """

    cycle: Array
    table: Array
    rise: Array

    def start(self, phase: float) -> Array:
        """The pose (nu,) [rad] to begin in at a phase [rad]: the clip's own."""
        return np.asarray(periodic(self.cycle, np.array([phase / tau]))[0])

    def at(self, phase: float) -> Array:
        """Both poses (2, nu) [rad] at a phase [rad], between the two nearest rows."""
        place = phase / tau % 1.0 * STEPS
        row = min(floor(place), STEPS - 1)
        return np.asarray(self.table[row] + (place - row) * self.rise[row])


def make_reference_pair(model: Model, clip: Clip, settings: ReferenceSettings) -> ReferencePair:
    """The poses around the phase of a clip.

    Raises:
        InputError: the clip or an offset names a joint that the model has not.
    """
    cycle = clip.poses(model) + _added(model, settings.offsets, clip.samples)
    cycle = np.clip(cycle, *model.joint_range.T)
    middle = np.linspace(0.0, 1.0, STEPS + 1) + settings.lead
    sides = [periodic(cycle, middle + side * settings.window) for side in (1.0, -1.0)]
    table = np.stack(sides, axis=1)
    return ReferencePair(cycle, table[:-1], np.diff(table, axis=0))


def _added(model: Model, offsets: Mapping[str, Sequence[float]], samples: int) -> Array:
    """Offsets by joint name to angles (samples, nu) [rad]."""
    phases = tau * np.arange(samples) / samples
    angles = np.zeros((samples, len(model.joint_names)))
    for name, harmonics in offsets.items():
        columns = model.bending(name, "behaviour.reference.offsets")
        angles[:, columns] += _fourier(harmonics, phases)[:, None]
    return angles


def _fourier(harmonics: Sequence[float], phases: Array) -> Array:
    """Mean, cosine, sine, cosine of twice the phase, ... at phases (n,) [rad]."""
    turns = [n * phases for n in range(1, len(harmonics) // 2 + 1)]
    waves = [np.ones_like(phases), *(wave(turn) for turn in turns for wave in (np.cos, np.sin))]
    return product(np.asarray(harmonics), np.array(waves[: len(harmonics)]))


def periodic(samples: Array, places: Array) -> Array:
    """Samples (n, k), even over a closed cycle, at places (m,) [cycles]; linear between."""
    n = len(samples)
    place = np.mod(places, 1.0) * n
    before = np.minimum(place.astype(int), n - 1)
    share = (place - before)[:, None]
    return np.asarray((1.0 - share) * samples[before] + share * samples[(before + 1) % n])
