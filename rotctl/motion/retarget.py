"""A captured motion on one of our characters: each segment points where the actor's did.

Only directions are matched, so that neither rest poses nor bone axes nor the proportions of
the actor matter; the root follows the actor's hips, scaled by the length of the legs. Each frame
is fitted from the one before (`fit`). A limb that is stuck in a pose that is only the best near
by begins again from the best of a grid (`limbs`), and the frames before are mended.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.fit import FORWARD, GAIN, LEFT, SEGMENTS, TO_PREVIOUS, UP, Fit, unit
from rotctl.motion.landmarks import Landmarks
from rotctl.motion.limbs import Limb
from rotctl.motion.turning import Motion

STUCK = np.radians(2.0)  # an error of a limb from which other starts are tried
RETRY = 5  # frames, after starts that brought nothing, and twice as many each time that they do:
LONGEST_WAIT = 160  # the joints' ranges may not allow more, and a noisy file would take for ever


@dataclass(frozen=True)
class Retargeted:
    """A motion of our character over the capture's frames.

    Attributes:
        motion: joint angles and pelvis orientations.
        root: (n, 3) position of the pelvis; its height is the actor's, scaled [m].
        error: (n, k) angle between a segment and its target [rad].
        segments: k names.
        leg: of the character, from hip to knee to ankle [m].
    """

    motion: Motion
    root: Array
    error: Array
    segments: tuple[str, ...]
    leg: float


def retarget(
    model: Model, marks: Landmarks, progress: Callable[[int, int], object] | None = None
) -> Retargeted:
    """Fit the character to the landmarks, frame by frame.

    Args:
        progress: told after each frame how many are done, and of how many.

    Raises:
        InputError: the character has not the bodies of a human.
    """
    fit = Fit(model)
    scale = fit.leg / marks.leg
    targets = np.stack(
        [unit(marks.points[end] - marks.points[start]) for _, _, start, end, _ in SEGMENTS],
        axis=1,
    )
    n = len(targets)
    positions, errors = np.empty((n, model.mj.nq)), np.empty((n, len(SEGMENTS)))
    position = fit.afresh(targets[0])
    waits, patience = [0] * len(fit.limbs), [RETRY] * len(fit.limbs)
    for i in range(n):
        position = fit.solve(position, targets[i], TO_PREVIOUS if i else 0.0)
        for k, limb in enumerate(fit.limbs):
            waits[k] = max(0, waits[k] - 1)
            stuck = fit.limb_error(limb, position, targets[i])
            if stuck < STUCK or waits[k]:
                continue
            better = fit.again(limb, position, targets[i])
            if fit.limb_error(limb, better, targets[i]) > STUCK:
                better = min(
                    (better, fit.afresh(targets[i])),
                    key=lambda tried: fit.limb_error(limb, tried, targets[i]),
                )
            if fit.limb_error(limb, better, targets[i]) < stuck - GAIN:
                position, patience[k] = better, RETRY
                _mend(fit, limb, targets, positions[:i], errors, position)
            else:
                waits[k] = patience[k]
                patience[k] = min(2 * patience[k], LONGEST_WAIT)
        positions[i], errors[i] = position, fit.error(position, targets[i])
        if progress:
            progress(i + 1, n)
    motion = Motion(positions[:, 7:], Rotation.from_quat(positions[:, 3:7], scalar_first=True))
    middle = 0.5 * scale * (marks.points["hip_l"] + marks.points["hip_r"])
    root = middle - motion.pelvis.apply(fit.hips)
    return Retargeted(motion, root, errors, tuple(_names()), fit.leg)


def _mend(
    fit: Fit, limb: Limb, targets: Array, before: Array, errors: Array, position: Array
) -> None:
    """Go back from where a better pose was found, as far as it is better there too."""
    for i in range(len(before) - 1, -1, -1):
        position = fit.solve(position, targets[i], TO_PREVIOUS)
        was = fit.limb_error(limb, before[i], targets[i])
        if not fit.limb_error(limb, position, targets[i]) < was - GAIN:
            break
        before[i], errors[i] = position, fit.error(position, targets[i])


def _names() -> list[str]:
    axes = {UP: "up", LEFT: "left", FORWARD: "forward"}
    return [f"{body} {axes[axis]}" if axis in axes else body for body, axis, *_ in SEGMENTS]
