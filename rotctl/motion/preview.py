"""A clip as postures on the ground, to be looked at."""

from math import tau

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.clip import Clip
from rotctl.motion.cycle import at_places
from rotctl.motion.ground import rolled
from rotctl.motion.turning import Motion, rolled_by, upright

MAX_FRAMES = 200
STEPS = 12  # postures rolled through from one that is shown to the next
LOG_HEADING = -1.0  # [rad] a log roll is seen from its side rather than from its feet


def preview(model: Model, clip: Clip, frames: int) -> tuple[Array, Array]:
    """Generalised positions (frames, nq) over one cycle, and their phases (frames,) [rev].

    Raises:
        InputError: the clip names a joint that the model has not, or too many frames.
    """
    if not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames is {frames}, valid: 1 to {MAX_FRAMES}")
    phases = np.arange(frames * STEPS) / (frames * STEPS)
    heading = LOG_HEADING if clip.roll_about == "head" else 0.0
    positions = rolled(model, at_places(motion_of(model, clip), phases), heading)
    return positions[::STEPS], phases[::STEPS]


def motion_of(model: Model, clip: Clip) -> Motion:
    """The clip's samples as postures.

    Raises:
        InputError: the clip names a joint that the model has not.
    """
    if clip.pelvis is not None:
        pelvis = Rotation.from_quat(np.array(clip.pelvis), scalar_first=True)
    else:
        turns = tau * np.arange(clip.samples) / clip.samples
        pelvis = rolled_by(turns) * upright(clip.roll_about)
    return Motion(clip.poses(model), pelvis)
