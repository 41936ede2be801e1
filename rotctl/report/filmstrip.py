"""A run as one picture: frames side by side, drawn from the log alone."""

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from rotctl import files
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.metrics.columns import heading
from rotctl.report import gl, stored_model
from rotctl.report.frame import (
    FORCE_SCALE,
    INK,
    MOODS,
    PAPER,
    SOFT,
    USED,
    Moment,
    arrow,
    dot,
    draw,
    moments,
    stages_of_parts,
    turns_done,
    typeface,
)
from rotctl.report.rows import drawable, window
from rotctl.report.skill import Part, parts
from rotctl.report.spacing import even, spread
from rotctl.report.title import title
from rotctl.rotations import Array

MAX_FRAMES = 200
FRAME = (320, 250)  # pixels
OVERSAMPLING = 2  # frames are drawn this much larger: smooth edges without multisampling
MAX_COLUMNS = 6
SETTLED = 2.0  # [s] by default the strip starts here
DEFAULT_TURNS = 2.0  # [rev] and lasts so long
SMALL = 1_500_000  # [bytes] a larger picture is reduced to 256 colours

_THIN = 4  # pixels between the frames of a strip
_MARGIN, _GAP, _CAPTION, _HEADER, _FOOTER = 22, 10, 30, 84, 40  # pixels
_LINE, _MARK, _APART = 22, 38, 26  # pixels: a line of the legend, its marks, between two entries
_LEGEND = (
    ("used", "contact used by the controller"),
    ("left out", "contact left out"),
    ("force", "ground force (body weight: {weight:.2g} m)"),
    ("", "left limbs are darker"),
)


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
            both: of a roll two revolutions from 2 s on, evenly; the whole run where those are not
            reached, and of anything else what `rotctl.report.skill` finds, as
            `rotctl.report.spacing` says.
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
    sheet = _sheet(log, pictures, shown, columns, weight)
    write(out, sheet)


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


# ---------------------------------------------------------------- which moments


def _rows(log: RunLog, frames: int, start: float | None, end: float | None) -> list[int]:
    """Rows of the log to show."""
    time = drawable(log, log["trajectory/qpos"])
    if start is not None or end is not None:
        return even(*window(time, start, end), frames)
    found = parts(log, time, stages_of_parts(log))
    turning = None if found else _two_turns(time, turns_done(log)[: len(time)])
    if turning:
        return even(*turning, frames)
    return spread(log, found or [Part(0, len(time) - 1, 1.0)], frames)


def _two_turns(time: Array, turns: Array) -> tuple[int, int] | None:
    """Rows from SETTLED on until DEFAULT_TURNS are done; None where they never are."""
    first = int(np.searchsorted(time, SETTLED))
    done = np.flatnonzero(np.abs(turns[first:] - turns[first : first + 1]) >= DEFAULT_TURNS)
    return (first, first + int(done[0])) if len(done) else None


# ---------------------------------------------------------------- the sheet


def _sheet(
    log: RunLog,
    pictures: Sequence[Image.Image],
    moments: Sequence[Moment],
    columns: int,
    weight: float,
) -> Image.Image:
    wide, high = FRAME[0] + _GAP, FRAME[1] + _CAPTION + _GAP
    rows = -(-len(pictures) // columns)
    width = columns * wide - _GAP
    legend = _lines(width, weight)
    size = (2 * _MARGIN + width, _HEADER + rows * high + _FOOTER + _LINE * (len(legend) - 1))
    sheet = Image.new("RGB", size, PAPER)
    pen = ImageDraw.Draw(sheet)
    _header(pen, log, width)
    for i, (picture, moment) in enumerate(zip(pictures, moments, strict=True)):
        x, y = _MARGIN + i % columns * wide, _HEADER + i // columns * high
        sheet.paste(picture, (x, y))
        _caption(pen, x, y + FRAME[1] + 5, moment)
    for i, entries in enumerate(legend):
        _legend(pen, _MARGIN, size[1] - _FOOTER - _LINE * (len(legend) - 1 - i), entries)
    return sheet


def _header(pen: ImageDraw.ImageDraw, log: RunLog, width: int) -> None:
    top, beside = title(log), 0.0
    for text, y, ink, size in ((top.name, 16, INK, 27), (top.about, 25, SOFT, 18)):
        shown = _cut(text, width - beside, size)
        pen.text((_MARGIN + beside, y), shown, ink, typeface(size))
        beside += typeface(size).getlength(shown) + 18
    pen.text((_MARGIN, 51), _cut(top.verdict, width, 19), MOODS[top.success], typeface(19))


def _cut(text: str, width: float, size: int) -> str:
    """As much of a text as is no wider."""
    font, shown = typeface(size), text
    while shown and font.getlength(shown if shown == text else f"{shown}...") > width:
        shown = shown[:-1]
    return shown if shown == text or not shown else f"{shown}..."


def _caption(pen: ImageDraw.ImageDraw, x: float, y: float, moment: Moment) -> None:
    font = typeface(16)
    pen.text((x + 2, y), f"{moment.time:.2f} s", INK, font)
    pen.text((x + FRAME[0] / 2, y), f"{moment.turns:z.2f} rev", INK, font, anchor="ma")
    pen.text((x + FRAME[0] - 2, y), moment.note, SOFT, font, anchor="ra")


def _lines(width: float, weight: float) -> list[list[tuple[float, str, str]]]:
    """Entries of the legend in lines that are no wider, if they can be: x, mark and text."""
    lines: list[list[tuple[float, str, str]]] = [[]]
    x = 0.0
    for mark, text in _LEGEND:
        told = text.format(weight=weight)
        wide = _legend_mark(mark) + typeface(15).getlength(told)
        if lines[-1] and x + wide > width:
            lines.append([])
            x = 0.0
        # The last one stands at the right where others are before it.
        at = width - wide if not mark and lines[-1] else x
        lines[-1].append((at, mark, told))
        x += wide + _APART
    return lines


def _legend_mark(mark: str) -> int:
    return {"": 0, "used": 18, "left out": 18}.get(mark, _MARK)


def _legend(
    pen: ImageDraw.ImageDraw, left: float, y: float, entries: Sequence[tuple[float, str, str]]
) -> None:
    for beside, mark, text in entries:
        x = left + beside
        if mark == "force":
            arrow(pen, np.array([x, y + 10.0]), np.array([x + 30, y + 10.0]), USED, 1.3)
        elif mark:
            dot(pen, x + 6, y + 10, 5.5, mark == "used")
        pen.text((x + _legend_mark(mark), y), text, SOFT, typeface(15))


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
