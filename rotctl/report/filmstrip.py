"""A run as one picture: frames side by side, drawn from the log alone."""

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from rotctl import files
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import heading
from rotctl.metrics.halts import going
from rotctl.metrics.turning import longest_stall
from rotctl.report import gl, stored_model
from rotctl.report.character import FORCE_SCALE
from rotctl.report.frame import PAPER, draw
from rotctl.report.happenings import halts, happenings, stall
from rotctl.report.moments import Moment, moments, turns_done
from rotctl.report.rows import drawable, window
from rotctl.report.sheet import FRAME, sheet
from rotctl.report.skill import BEFORE, Part, first_push, parts
from rotctl.report.spacing import even, spread
from rotctl.report.stage_names import stages_of_parts
from rotctl.report.title import verdict

MAX_FRAMES = 200
OVERSAMPLING = 2  # frames are drawn this much larger: smooth edges without multisampling
MAX_COLUMNS = 6
SETTLED = 2.0  # [s] by default the strip starts here
DEFAULT_TURNS = 2.0  # [rev] and lasts so long
LEADS, FOLLOWS = 0.5, 2.0  # [rev, s] that are shown before a stall, and of it
SMALL = 1_500_000  # [bytes] a larger picture is reduced to 256 colours

_THIN = 4  # pixels between the frames of a strip


def filmstrip(
    log: RunLog,
    out: Path,
    frames: int = 12,
    start: float | None = None,
    end: float | None = None,
    columns: int | None = None,
) -> None:
    """Draw a run into a PNG file.

    Args:
        out: replaced if it is there.
        frames: how many; fewer if there are not as many steps.
        start: time of the first frame [s].
        end: time of the last frame [s]; from start to end they are evenly spaced in time. Without
            both: of a roll two revolutions from 2 s on, evenly, or from what first happens to it;
            of one that failed how it came to stall; the whole run where those are not reached, and
            of anything else what `rotctl.report.skill` finds, as `rotctl.report.spacing` says.
        columns: frames in a row; at most 6 by default.

    Raises:
        InputError: an argument is out of range, nothing can be drawn on this machine, or
            `out` cannot be written.
        LogError: the log is damaged or its model is not safe to draw.
    """
    if not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames is {frames}, valid: 1 to {MAX_FRAMES}")
    columns = min(MAX_COLUMNS, frames) if columns is None else columns
    if not 1 <= columns <= frames:
        raise InputError(f"columns is {columns}, valid: 1 to {frames}, the number of frames")
    files.require_ending(out, ".png")
    backend = gl.backend()  # first of all: importing MuJoCo raises where MUJOCO_GL makes no sense
    rows = _rows(log, frames, start, end)
    pictures, shown, weight = _drawn(log, rows, FRAME, backend)
    whole = sheet(log, pictures, shown, columns, weight)
    write(out, whole)


def strip(log: RunLog, frames: int, size: tuple[int, int]) -> bytes:
    """The same moments as a PNG without words: one row of frames of that many pixels each.

    Raises:
        InputError: nothing can be drawn on this machine.
        LogError: the log is damaged or its model is not safe to draw.
    """
    backend = gl.backend()
    pictures, _, _ = _drawn(log, _rows(log, frames, None, None), size, backend)
    row = Image.new("RGB", (frames * (size[0] + _THIN) - _THIN, size[1]), PAPER)
    for i, picture in enumerate(pictures):
        row.paste(picture, (i * (size[0] + _THIN), 0))
    return _png(row.quantize(160, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE))


def _drawn(
    log: RunLog, rows: list[int], size: tuple[int, int], backend: str
) -> tuple[list[Image.Image], list[Moment], float]:
    """Frames of these rows of the log, what they show, and the arrow of the body's weight [m]."""
    from rotctl.report import scene

    model = stored_model.load(log)
    width, height = (OVERSAMPLING * side for side in size)
    states, shown = log["trajectory/qpos"], moments(log, rows)
    with scene.opened(model, backend, width, height) as stage:
        stage.fit(states[rows], heading(log))
        pictures = [
            draw(stage, state, moment, size)
            for state, moment in zip(states[rows], shown, strict=True)
        ]
        return pictures, shown, FORCE_SCALE * stage.size


def _rows(log: RunLog, frames: int, start: float | None, end: float | None) -> list[int]:
    """Rows of the log to show."""
    time = drawable(log, log["trajectory/qpos"])
    if start is not None or end is not None:
        return even(*window(time, start, end), frames)
    changed = [each.row for each in happenings(log) if each.row < len(time)]
    found = parts(log, time, stages_of_parts(log), min(changed, default=None))
    if found:
        return spread(log, found, frames, changed)
    pushed = first_push(log)
    # It may have broken down before it was pushed.
    events = sorted([*changed, *([] if pushed is None or pushed >= len(time) else [pushed])])
    turns = turns_done(log)[: len(time)]
    shown = None
    if verdict(log.outcome)[0] is False:
        shown = _failing(time, turns, events, going(time, halts(log)), stall(log))
    if shown is None:
        since = max(SETTLED, float(time[events[0]]) - BEFORE) if events else SETTLED
        shown = _two_turns(time, turns, since)
        if shown and not events:
            return even(*shown, frames)
    return spread(log, [Part(*(shown or (0, len(time) - 1)), 1.0)], frames, changed)


def _failing(
    time: Array,
    turns: Array,
    events: Sequence[int],
    rolls: NDArray[np.bool_],
    stall: tuple[float, float],
) -> tuple[int, int] | None:
    """Rows of how a roll came to its longest stall, and what followed; None if it never stalled.

    Args:
        turns: done by each row (n,) [rev].
        events: rows in which something happened, in order. What did in the two revolutions before
            is shown, too.
        rolls: whether it is to roll in each row: who halts where he is told to does not stall.
        stall: less progress [rev] in so long [s].
    """
    least, lasting = stall
    period = float(time[-1] - time[0]) / max(len(time) - 1, 1)
    progress = np.abs(turns)
    asked = np.flatnonzero(rolls)
    lasted, begin = longest_stall(progress[asked], least, period) if len(asked) else (0.0, 0.0)
    if lasted < lasting:
        return None
    stalls, furthest = int(asked[round(begin / period)]), np.maximum.accumulate(progress)
    first, early = (
        int(np.searchsorted(furthest, furthest[stalls] - turn)) for turn in (LEADS, DEFAULT_TURNS)
    )
    caused = [row for row in events if early <= row <= stalls]
    first = min([first, *(max(row - round(BEFORE / period), 0) for row in caused)])
    return first, min(stalls + round(FOLLOWS / period), len(time) - 1)


def _two_turns(time: Array, turns: Array, since: float) -> tuple[int, int] | None:
    """Rows from a time [s] on until DEFAULT_TURNS are done; None where they never are."""
    first = int(np.searchsorted(time, since))
    done = np.flatnonzero(np.abs(turns[first:] - turns[first : first + 1]) >= DEFAULT_TURNS)
    return (first, first + int(done[0])) if len(done) else None


def write(out: Path, sheet: Image.Image) -> None:
    """Replace `out` by a PNG in one step."""
    packed = _png(sheet)
    if len(packed) > SMALL:
        packed = _png(sheet.quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE))
    files.replace(out, packed)


def _png(sheet: Image.Image) -> bytes:
    packed = BytesIO()
    sheet.save(packed, "PNG", optimize=True)
    return packed.getvalue()
