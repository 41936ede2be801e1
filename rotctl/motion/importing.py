"""A captured motion to a clip: read, retarget, cut out the roll, turn it to +x, close it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import tau
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.capture import Capture
from rotctl.motion.clip import Clip
from rotctl.motion.closing import Closed, close
from rotctl.motion.cutting import cut, part_of, within
from rotctl.motion.cycle import SAMPLES, by_excursion
from rotctl.motion.finding import find_roll, roll_kind, rolling_axis
from rotctl.motion.flight import Flight, flights
from rotctl.motion.glance import has_false_start, require_motion, stood_up, up_axis
from rotctl.motion.ground import centres
from rotctl.motion.landmarks import Landmarks, find_landmarks
from rotctl.motion.mirror import mirrored, symmetric
from rotctl.motion.reading import NOTHING, Wishes
from rotctl.motion.retarget import Retargeted, retarget
from rotctl.motion.turning import Motion, qpos, rotation_between_postures
from rotctl.motion.writing import make_clip


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
        doubt: how far the second of the trunk's axes lies along the rolling axis, of the first [-].
        flights: of the whole time looked at.
        roles: which joint of the file was taken for what.
        up: the file's axis that was taken for up; empty where the file leaves no doubt.
        false_start: whether the first frame was left out.
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
    doubt: float
    flights: list[Flight]
    roles: dict[str, str]
    up: str
    false_start: bool


@dataclass(frozen=True)
class _Found:
    """A roll in a fitted stretch of the capture: frames `first` to `last` of it."""

    cost: float
    time: Array
    fitted: Retargeted
    turns: Array
    first: int
    last: int


def import_motion(
    model: Model,
    character: str,
    path: Path,
    capture: Capture,
    cycle: tuple[float, float] | None = None,
    symmetrise: bool = False,
    licence: str = "",
    progress: Callable[[int, int], object] | None = None,
    wishes: Wishes = NOTHING,
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
    marks, up = find_landmarks(path, capture, wishes.joints), ""
    if not capture.upright:
        up = wishes.up or up_axis(marks)
        marks = stood_up(marks, up)
    time, false_start = capture.time, has_false_start(marks)
    if false_start:
        time, marks = time[1:], part_of(marks, slice(1, None))
    require_motion(path, marks)
    found, flown = _best(model, cut(path, time, marks, cycle), cycle, progress)
    time, fitted = found.time, found.fitted
    motion, root, turns = fitted.motion, fitted.root, found.turns
    first, last = found.first, found.last
    part = slice(first, last + 1)
    time, motion, root, turns = time[part], motion[part], root[part], turns[first:last]
    axis = rolling_axis(turns)
    to_x = Rotation.from_rotvec([0.0, 0.0, np.arctan2(axis[0], axis[1])])
    motion, root = Motion(motion.poses, to_x * motion.pelvis), to_x.apply(root)
    kind, other_way, doubt = roll_kind(motion)
    if other_way:
        motion, root = mirrored(model, motion), root * [1.0, -1.0, 1.0]
    if symmetrise:
        if kind in ("head", "face"):
            what = "a log's" if kind == "head" else "a cartwheel"
            raise InputError(f"{path}: --symmetric is for forward and backward rolls, not {what}")
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
        error=fitted.error[part],
        start=float(time[0]),
        end=float(time[-1]),
        span=span,
        speed=float(centre[-1, 0] - centre[0, 0]) / lasted,
        closed=closed,
        joint_names=model.joint_names,
        mirrored=other_way,
        doubt=doubt,
        flights=flown,
        roles=marks.roles,
        up=up,
        false_start=false_start,
    )


def _best(
    model: Model,
    parts: list[tuple[Array, Landmarks]],
    cycle: tuple[float, float] | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[_Found, list[Flight]]:
    """Fit every stretch; the roll that closes best, and all flights."""
    whole = sum(len(time) for time, _ in parts)
    best, flown, done, complaint = None, [], 0, None
    for time, marks in parts:
        fitted = retarget(model, marks, partial(_told, progress, done, whole) if progress else None)
        done += len(time)
        turns = rotation_between_postures(model, fitted.motion)
        flown += flights(model, time, _positions(model, fitted.motion, fitted.root), fitted.leg)
        try:
            cost, first, last = (
                (0.0, *within(cycle, time)) if cycle else find_roll(time, fitted.motion, turns)
            )
        except InputError as error:
            complaint = complaint or error
            continue
        if best is None or cost < best.cost:
            best = _Found(cost, time, fitted, turns, first, last)
    if best is None:
        assert complaint  # one of each stretch
        raise complaint
    return best, flown


def _told(
    progress: Callable[[int, int], object], before: int, whole: int, done: int, _: int
) -> None:
    progress(before + done, whole)


def _positions(model: Model, motion: Motion, root: Array) -> Array:
    positions = qpos(model, motion)
    positions[:, :3] = root
    return positions
