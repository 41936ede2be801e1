"""A captured motion to a clip: read, retarget, cut out the roll, turn it to +x, close it."""

from collections.abc import Callable
from dataclasses import dataclass
from math import tau
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.mechanics.model import Model
from rotctl.motion.asf_amc import RATE, read_amc
from rotctl.motion.bvh import read_bvh
from rotctl.motion.capture import Capture
from rotctl.motion.clip import Clip
from rotctl.motion.closing import Closed, close
from rotctl.motion.cycle import SAMPLES, by_excursion
from rotctl.motion.deepmimic import read_deepmimic
from rotctl.motion.finding import find_roll, roll_kind, rolling_axis
from rotctl.motion.flight import Flight, flights
from rotctl.motion.ground import centres
from rotctl.motion.landmarks import Landmarks, find_landmarks
from rotctl.motion.mirror import mirrored, symmetric
from rotctl.motion.retarget import retarget
from rotctl.motion.turning import Motion, qpos, rotation_between_postures
from rotctl.motion.writing import make_clip
from rotctl.rotations import Array

LONGEST = 60.0  # [s] of capture that a roll is looked for in
FEWEST = 5  # frames of a cycle
FINE = 1.0 / 120.0  # [s] a slower capture is interpolated to that
FORMATS = ".bvh, .amc (with --skeleton FILE.asf), .txt or .json (DeepMimic)"


@dataclass(frozen=True)
class Imported:
    """A clip, and what there is to know of how it was made.

    Attributes:
        clip: the cycle.
        segments, error: k names, and (n, k) angle of each to the actor's [rad].
        start, end: of the cycle in the file [s].
        span: what the body turns in that time [rev].
        speed: of the centre of mass, along the roll [m/s].
        closed: how the loop was closed.
        joint_names: nu names.
        mirrored: whether left and right were exchanged.
        flights: of the whole time looked at.
    """

    clip: Clip
    segments: tuple[str, ...]
    error: Array
    start: float
    end: float
    span: float
    speed: float
    closed: Closed
    joint_names: tuple[str, ...]
    mirrored: bool
    flights: list[Flight]


def read_capture(path: Path, skeleton: Path | None, rate: float | None) -> Capture:
    """Read a motion file by its ending.

    Args:
        skeleton: of an .amc; without it the .asf of the same name.
        rate: [Hz] instead of the file's own.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    if rate is not None and not 1.0 <= rate <= 10_000.0:
        raise InputError(f"--rate={rate:g}: valid: 1 to 10000 Hz")
    ending = path.suffix.lower()
    if ending == ".bvh":
        capture = read_bvh(path)
    elif ending == ".amc":
        capture = read_amc(path, skeleton or path.with_suffix(".asf"), rate or RATE)
    elif ending in (".txt", ".json"):
        capture = read_deepmimic(path)
    else:
        raise InputError(f"{path}: unknown kind of file, valid: {FORMATS}")
    if rate is None:
        return capture
    return Capture(np.arange(len(capture.time)) / rate, capture.joints)


def import_motion(
    model: Model,
    character: str,
    path: Path,
    capture: Capture,
    cycle: tuple[float, float] | None = None,
    symmetrise: bool = False,
    licence: str = "",
    progress: Callable[[int, int], object] | None = None,
) -> Imported:
    """Make a clip of a captured roll.

    Args:
        character: the model's name.
        path: of the capture.
        cycle: its start and end [s]; without it the roll that closes best is taken.
        symmetrise: take the mean of the roll and its mirror image.
        licence: of the source.
        progress: told how many frames are done, and of how many.

    Raises:
        InputError: the capture is not of a human, or there is no roll in it.
    """
    chosen = _frames(path, capture.time, cycle)
    marks = find_landmarks(path, capture)
    marks = Landmarks({name: at[chosen] for name, at in marks.points.items()}, marks.leg)
    time, marks = _fine(capture.time[chosen], marks)
    fitted = retarget(model, marks, progress)
    motion, root = fitted.motion, fitted.root
    turns = rotation_between_postures(model, motion)
    flown = flights(model, time, _positions(model, motion, root), fitted.leg)

    first, last = (0, len(time) - 1) if cycle else find_roll(time, motion, turns)
    part = slice(first, last + 1)
    time, motion, root, turns = time[part], motion[part], root[part], turns[first:last]
    axis = rolling_axis(turns)
    to_x = Rotation.from_rotvec([0.0, 0.0, np.arctan2(axis[0], axis[1])])
    motion, root = Motion(motion.poses, to_x * motion.pelvis), to_x.apply(root)
    kind, other_way = roll_kind(motion)
    if other_way:
        motion, root = mirrored(model, motion), root * [1.0, -1.0, 1.0]
    if symmetrise:
        if kind == "head":
            raise InputError(f"{path}: --symmetric is for forward and backward rolls, not a log's")
        motion, root = symmetric(model, motion), root * [1.0, 0.0, 1.0]
    turns = rotation_between_postures(model, motion)
    closed = close(motion, turns)
    centre = centres(model, _positions(model, motion, root)[[0, -1]])
    span, lasted = float(turns[:, 1].sum()) / tau, float(time[-1] - time[0])
    clip = make_clip(
        model,
        by_excursion(model, closed.cycle, kind, SAMPLES),
        name=path.stem,
        roll_about=kind,
        character=character,
        source=f"{path.name}, {time[0]:.3f} to {time[-1]:.3f} s"
        + (", mirror average" if symmetrise else ""),
        licence=licence,
        rate=round(span / lasted, 3),
        loop_gap=round(float(np.abs(closed.gap).max()), 3),
    )
    return Imported(
        clip=clip,
        segments=fitted.segments,
        error=fitted.error,
        start=float(time[0]),
        end=float(time[-1]),
        span=span,
        speed=float(centre[-1, 0] - centre[0, 0]) / lasted,
        closed=closed,
        joint_names=model.joint_names,
        mirrored=other_way,
        flights=flown,
    )


def _frames(path: Path, time: Array, cycle: tuple[float, float] | None) -> slice:
    """Which frames are looked at."""
    lasts = float(time[-1])
    if cycle is None:
        if lasts > LONGEST:
            raise InputError(
                f"{path}: lasts {lasts:.0f} s, a roll is looked for in {LONGEST:g} s at most; "
                "give --cycle START:END [s]"
            )
        return slice(None)
    start, end = cycle
    if not 0.0 <= start < end <= lasts + 1e-6:
        raise InputError(f"--cycle={start:g}:{end:g}: valid: 0 to {lasts:.3f} s, START before END")
    first, after = np.searchsorted(time, [start - 1e-6, end + 1e-6])
    if after - first < FEWEST:
        raise InputError(f"--cycle={start:g}:{end:g}: {after - first} frames, at least {FEWEST}")
    return slice(int(first), int(after))


def _fine(time: Array, marks: Landmarks) -> tuple[Array, Landmarks]:
    """The landmarks at `FINE` steps, where the capture's are longer."""
    if np.median(np.diff(time)) <= 1.01 * FINE:
        return time, marks
    fine = np.linspace(time[0], time[-1], 1 + round((time[-1] - time[0]) / FINE))
    points = {name: CubicSpline(time, at)(fine) for name, at in marks.points.items()}
    return fine, Landmarks(points, marks.leg)


def _positions(model: Model, motion: Motion, root: Array) -> Array:
    positions = qpos(model, motion)
    positions[:, :3] = root
    return positions
