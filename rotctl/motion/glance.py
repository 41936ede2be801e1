"""What landmarks tell before a character is fitted: which way is up, where the body turns round."""

from math import tau
from pathlib import Path

import numpy as np

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.landmarks import Landmarks

# From the file's axis that is up to our z, where the file was read as if y were.
_TO_Z = {
    "x": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),  # it is our y
    "y": np.eye(3),
    "z": np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]),  # it is our x
}
_OURS = {"x": 1, "y": 2, "z": 0}
STANDING = 0.8  # [legs] head over ankles, as the median: so it stands most of the time
ACROSS = 0.4  # [legs] and across it is no more
STEADIER = 3.0  # the lowest point moves so much less along the axis that is up
JUMP = 0.15  # [legs] a first frame farther from the second was put there
JUMPS = 5.0  # and so many times the steps that follow
FASTEST = 75.0  # [deg] from a frame to the next: in fewer than five a revolution no motion shows
_CLOUD = ("hip", "knee", "ankle", "elbow", "wrist")  # points of a side, beside those of the trunk
_TRUNK = ("hips", "chest", "neck", "head")
TURN = 0.6  # [rev] less of it is no roll, whatever the masses are
WITHIN = 6.0  # [s]
BESIDE = 1.0  # [s] what is fitted before and after
RATE = 20.0  # [Hz] at which turns are looked for


def up_axis(marks: Landmarks) -> str:
    """The axis of the file that is up, `y` or `z`, where it was read as if it were y."""
    points = marks.points
    rise = points["head"] - 0.5 * (points["ankle_l"] + points["ankle_r"])
    tall = np.median(rise, axis=0) / marks.leg
    for axis, other in (("y", "z"), ("z", "y")):
        if tall[_OURS[axis]] > STANDING and abs(tall[_OURS[other]]) < ACROSS:
            return axis
    if marks.rest is not None:
        return "z" if abs(marks.rest[2, _OURS["z"]]) > STANDING else "y"
    cloud = _cloud(marks)
    lowest = {axis: np.std(cloud[:, :, _OURS[axis]].min(axis=1)) for axis in ("y", "z")}
    if lowest["y"] > STEADIER * max(lowest["z"], 0.02 * marks.leg):
        return "z"
    return "y"


def stood_up(marks: Landmarks, axis: str) -> Landmarks:
    """The landmarks with the file's axis upward."""
    turn = _TO_Z[axis]
    points = {name: at @ turn.T for name, at in marks.points.items()}
    return Landmarks(points, marks.leg, marks.roles, marks.rest)


def has_false_start(marks: Landmarks) -> bool:
    """Whether the first frame is no neighbour of the second: a T-pose that was put in front."""
    cloud = _cloud(marks)
    if len(cloud) < 4:
        return False
    apart = np.linalg.norm(np.diff(cloud[:7], axis=0), axis=2).max(axis=1) / marks.leg
    return bool(apart[0] > max(JUMP, JUMPS * apart[1:].max()))


def require_motion(path: Path, marks: Landmarks) -> None:
    """See that frames follow each other: of noise a fit takes minutes, and finds rolls in it.

    Raises:
        InputError: they do not.
    """
    cloud = _cloud(marks)
    arms = cloud - cloud.mean(axis=1, keepdims=True)
    arms /= np.maximum(np.linalg.norm(arms, axis=2, keepdims=True), 1e-9)
    cosines = (arms[1:] * arms[:-1]).sum(axis=2)
    turned = float(np.median(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))))
    if turned > FASTEST:
        raise InputError(
            f"{path}: from one frame to the next the points of the body turn by a median of "
            f"{turned:.0f} deg about its middle: that is no motion"
        )


def turning(marks: Landmarks) -> Array:
    """How far the points as a whole have turned about the world's axes (n, 3) [rad]."""
    cloud = _cloud(marks)
    between = 0.5 * (cloud[1:] + cloud[:-1])
    arms = between - between.mean(axis=1, keepdims=True)
    spin = np.cross(arms, np.diff(cloud, axis=0)).sum(axis=1)
    inertia = np.einsum("npi,npi->n", arms, arms)[:, None, None] * np.eye(3)
    inertia = inertia - np.einsum("npi,npj->nij", arms, arms)
    turns = np.linalg.solve(inertia + 1e-9 * marks.leg**2 * np.eye(3), spin[:, :, None])[..., 0]
    return np.vstack([np.zeros(3), np.cumsum(turns, axis=0)])


def stretches(path: Path, time: Array, marks: Landmarks) -> list[slice]:
    """Where the body may turn round once, with what is before and after.

    Raises:
        InputError: nowhere; it says how far it turns.
    """
    turned = turning(marks) / tau
    step = max(1, round(1.0 / (RATE * float(np.median(np.diff(time))))))
    tried = np.unique(np.append(np.arange(0, len(time), step), len(time) - 1))
    level = turned[tried][:, :2]
    most, chosen = 0.0, np.zeros(len(time), dtype=bool)
    for place, first in enumerate(tried):
        end = np.searchsorted(time[tried], time[first] + WITHIN, side="right")
        span = np.linalg.norm(level[place:end] - level[place], axis=1)
        most = max(most, float(span.max()))
        if span.max() >= TURN:
            last = tried[place + int(np.argmax(span >= TURN))]
            within = (time >= time[first] - BESIDE) & (time <= time[last] + BESIDE)
            chosen |= within
    if not chosen.any():
        spun = float(np.ptp(turned[:, 2]))
        upright = f", and {spun:.2f} rev about the vertical" if spun > TURN else ""
        raise InputError(
            f"{path}: no roll found: the body turns {most:.2f} rev at most{upright}; "
            "give --cycle START:END [s] for less than one"
        )
    edges = np.flatnonzero(np.diff(np.concatenate([[0], chosen.astype(int), [0]])))
    return [slice(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _cloud(marks: Landmarks) -> Array:
    """The points (n, k, 3) that stand for the body."""
    names = [*_TRUNK, *(f"{part}_{side}" for part in _CLOUD for side in "lr")]
    return np.stack([marks.points[name] for name in names], axis=1)
