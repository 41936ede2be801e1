"""A motion that was not simulated as one picture: postures side by side."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from rotctl import files
from rotctl.maths.rotations import Array
from rotctl.report import gl
from rotctl.report.filmstrip import MAX_COLUMNS, OVERSAMPLING, write
from rotctl.report.frame import INK, PAPER, SOFT, draw, typeface
from rotctl.report.moments import Moment
from rotctl.report.sheet import FRAME

_MARGIN, _GAP, _CAPTION, _HEADER = 22, 10, 30, 84  # pixels
_NO_CONTACTS = (np.empty((0, 3)), np.empty((0, 3)), np.empty(0, dtype=bool))
_NOTHING = Moment(0.0, 0.0, "", *_NO_CONTACTS, push=np.zeros(3), pushed=np.zeros(3))


def motion_strip(
    mjcf: str, states: Array, captions: Sequence[str], title: str, note: str, out: Path
) -> None:
    """Draw postures of our own model into a PNG file.

    Args:
        mjcf: the model.
        states: (n, nq) generalised positions.
        captions: n, one under each.
        title: above the picture.
        note: one line below the title.
        out: replaced if it is there.

    Raises:
        InputError: nothing can be drawn on this machine, or `out` cannot be written.
    """
    files.require_ending(out, ".png")
    backend = gl.backend()
    # After that only: importing MuJoCo raises where MUJOCO_GL makes no sense.
    import mujoco

    from rotctl.report import scene

    model = mujoco.MjModel.from_xml_string(mjcf)
    width, height = (OVERSAMPLING * side for side in FRAME)
    with scene.opened(model, backend, width, height) as stage:
        stage.fit(states)
        pictures = [draw(stage, state, _NOTHING, FRAME) for state in states]
    write(out, _sheet(pictures, captions, title, note))


def _sheet(
    pictures: Sequence[Image.Image], captions: Sequence[str], title: str, note: str
) -> Image.Image:
    columns = min(MAX_COLUMNS, len(pictures))
    wide, high = FRAME[0] + _GAP, FRAME[1] + _CAPTION + _GAP
    rows = -(-len(pictures) // columns)
    sheet = Image.new(
        "RGB", (2 * _MARGIN + columns * wide - _GAP, _HEADER + rows * high + _GAP), PAPER
    )
    pen = ImageDraw.Draw(sheet)
    pen.text((_MARGIN, 16), title, INK, typeface(27))
    pen.text((_MARGIN, 51), note, SOFT, typeface(19))
    for i, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        x, y = _MARGIN + i % columns * wide, _HEADER + i // columns * high
        sheet.paste(picture, (x, y))
        pen.text((x + FRAME[0] / 2, y + FRAME[1] + 5), caption, INK, typeface(16), anchor="ma")
    return sheet
