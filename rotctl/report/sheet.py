"""The sheet of a filmstrip: frames side by side, what was run above them, a legend below."""

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from rotctl.log import RunLog
from rotctl.report.frame import (
    INK,
    LONGEST_OUTSIDE,
    MOODS,
    OUTSIDE,
    OUTSIDE_SCALE,
    PAPER,
    SOFT,
    USED,
    arrow,
    dot,
    typeface,
)
from rotctl.report.moments import Moment, is_pushed
from rotctl.report.title import title

FRAME = (320, 250)  # pixels
_MARGIN, _GAP, _CAPTION, _HEADER, _FOOTER = 22, 10, 30, 84, 40  # pixels
_LINE, _MARK, _APART = 22, 38, 26  # pixels: a line of the legend, its marks, between two entries
ARROWS = {"force": USED, "outside": OUTSIDE}
_LEGEND = (
    ("used", "contact used by the controller"),
    ("left out", "contact left out"),
    ("force", "ground force (body weight: {weight:.2g} m)"),
    (
        "outside",
        f"force from outside ({OUTSIDE_SCALE:g} times as long, {LONGEST_OUTSIDE:g} m at most)",
    ),
    ("", "left limbs are darker"),
)


def sheet(
    log: RunLog,
    pictures: Sequence[Image.Image],
    moments: Sequence[Moment],
    columns: int,
    weight: float,
) -> Image.Image:
    """Frames in rows of so many, below what was run and above what is drawn over them.

    Args:
        weight: length of the arrow of the body's weight [m].
    """
    wide, high = FRAME[0] + _GAP, FRAME[1] + _CAPTION + _GAP
    rows = -(-len(pictures) // columns)
    width = columns * wide - _GAP
    legend = _lines(width, weight, any(is_pushed(moment) for moment in moments))
    size = (2 * _MARGIN + width, _HEADER + rows * high + _FOOTER + _LINE * (len(legend) - 1))
    whole = Image.new("RGB", size, PAPER)
    pen = ImageDraw.Draw(whole)
    _header(pen, log, width)
    times = told_times([moment.time for moment in moments])
    for i, (picture, moment) in enumerate(zip(pictures, moments, strict=True)):
        x, y = _MARGIN + i % columns * wide, _HEADER + i // columns * high
        whole.paste(picture, (x, y))
        _caption(pen, x, y + FRAME[1] + 5, times[i], moment)
    for i, entries in enumerate(legend):
        _legend(pen, _MARGIN, size[1] - _FOOTER - _LINE * (len(legend) - 1 - i), entries)
    return whole


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


def told_times(times: Sequence[float]) -> list[str]:
    """Times [s] to hundredths, or to thousandths where two would read the same."""
    told = [f"{time:.2f} s" for time in times]
    return told if len(set(told)) == len(told) else [f"{time:.3f} s" for time in times]


def _caption(pen: ImageDraw.ImageDraw, x: float, y: float, time: str, moment: Moment) -> None:
    font = typeface(16)
    pen.text((x + 2, y), time, INK, font)
    pen.text((x + FRAME[0] / 2, y), f"{moment.turns:z.2f} rev", INK, font, anchor="ma")
    pen.text((x + FRAME[0] - 2, y), moment.note, SOFT, font, anchor="ra")


def _lines(width: float, weight: float, pushed: bool) -> list[list[tuple[float, str, str]]]:
    """Entries of the legend in lines that are no wider, if they can be: x, mark and text."""
    legend = [entry for entry in _LEGEND if pushed or entry[0] != "outside"]
    lines: list[list[tuple[float, str, str]]] = [[]]
    x = 0.0
    for mark, text in legend:
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
    return _MARK if mark in ARROWS else 18 if mark else 0


def _legend(
    pen: ImageDraw.ImageDraw, left: float, y: float, entries: Sequence[tuple[float, str, str]]
) -> None:
    for beside, mark, text in entries:
        x = left + beside
        if mark in ARROWS:
            ends = np.array([x, y + 10.0]), np.array([x + 30, y + 10.0])
            arrow(pen, ends[0], ends[1], ARROWS[mark], 1.3)
        elif mark:
            dot(pen, x + 6, y + 10, 5.5, mark == "used")
        pen.text((x + _legend_mark(mark), y), text, SOFT, typeface(15))
