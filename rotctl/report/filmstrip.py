"""A run as one picture: frames side by side, drawn from the log alone."""

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.report import gl, stored_model
from rotctl.rotations import Array

if TYPE_CHECKING:
    from rotctl.report.scene import Camera, Scene

MAX_FRAMES = 200
FRAME = (320, 250)  # pixels
OVERSAMPLING = 2  # frames are drawn this much larger: smooth edges without multisampling
DEFAULT_COLUMNS = 6
SETTLED = 2.0  # [s] by default the strip starts here
DEFAULT_TURNS = 2.0  # [rev] and lasts so long
FORCE_SCALE = 0.45  # [m] length of an arrow as large as the body's weight
SMALL = 1_500_000  # [bytes] a larger picture is reduced to 256 colours
MAX_POSITION = 1e5  # [m, rad] a run that broke down is shown until there
MAX_FORCE = 5.0  # [body weights] longer arrows are cut
MARK_SIDE = 0.42  # [m] towards the camera from the character

_MARGIN, _GAP, _CAPTION, _HEADER, _FOOTER = 22, 10, 30, 84, 40  # pixels
_PAPER, _INK, _SOFT = (255, 255, 255), (28, 34, 44), (104, 114, 128)
_GOOD, _BAD = (22, 122, 76), (190, 32, 38)
_USED, _UNUSED = (235, 88, 18), (138, 146, 156)
_GROUND_INK = (108, 120, 134)


@dataclass(frozen=True)
class _Moment:
    """What a frame shows beside the model."""

    time: float  # [s]
    turns: float  # in-plane, since the start of the run [rev]
    blend: float
    contacts: Array  # (k, 3)
    forces: Array  # (k, 3) [N]
    used: Array  # (k,)


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
        frames: how many, evenly spaced in time; fewer if there are not as many steps.
        start: time of the first frame [s].
        end: time of the last frame [s]. Without start and end: two revolutions from
            2 s on; the whole run where those are not reached.
        columns: frames in a row; at most 6 by default.

    Raises:
        InputError: an argument is out of range, nothing can be drawn on this machine, or
            `out` cannot be written.
        LogError: the log is damaged or its model is not safe to draw.
    """
    if not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames is {frames}, valid: 1 to {MAX_FRAMES}")
    columns = min(DEFAULT_COLUMNS, frames) if columns is None else columns
    if not 1 <= columns <= frames:
        raise InputError(f"columns is {columns}, valid: 1 to {frames}, the number of frames")
    states = log["trajectory/qpos"]
    rows = _rows(log, states, frames, start, end)
    backend = gl.backend()
    # After that only: importing MuJoCo raises where MUJOCO_GL makes no sense.
    from rotctl.report import scene

    model = stored_model.load(log)
    width, height = (OVERSAMPLING * side for side in FRAME)
    moments = _moments(log, rows)
    with scene.opened(model, backend, width, height) as stage:
        stage.fit(states[rows])
        pictures = [
            _frame(stage, state, moment)
            for state, moment in zip(states[rows], moments, strict=True)
        ]
    sheet = _sheet(log, pictures, moments, columns)
    _write(out, sheet)


# ---------------------------------------------------------------- which moments


def _rows(
    log: RunLog, states: Array, frames: int, start: float | None, end: float | None
) -> list[int]:
    """Rows of the log to show."""
    time = log["trajectory/time"]
    sound = (np.abs(states) < MAX_POSITION).all(axis=1) & np.isfinite(time)
    last = len(time) if sound.all() else int(np.argmin(sound))
    if last == 0:
        raise LogError(f"{log.path}: has no step that could be drawn")
    time = time[:last]
    if start is None and end is None:
        first, final = _two_turns(time, _turns(log)[:last])
    else:
        first = _row(time, "start", float(time[0]) if start is None else start)
        final = _row(time, "end", float(time[-1]) if end is None else end)
        if start is not None and end is not None and start >= end:
            raise InputError(f"start is {start:g} s, valid: less than end = {end:g} s")
    rows = np.round(np.linspace(first, final, frames)).astype(int)
    return list(dict.fromkeys(rows.tolist()))


def _row(time: Array, name: str, value: float) -> int:
    if not time[0] <= value <= time[-1] + 1e-9:
        raise InputError(f"{name} is {value:g} s, valid: {time[0]:g} to {time[-1]:g} s")
    return int(np.abs(time - value).argmin())


def _two_turns(time: Array, turns: Array) -> tuple[int, int]:
    """Rows from SETTLED on until DEFAULT_TURNS are done; all rows where they never are."""
    first = int(np.searchsorted(time, SETTLED))
    done = np.flatnonzero(np.abs(turns[first:] - turns[first : first + 1]) >= DEFAULT_TURNS)
    return (first, first + int(done[0])) if len(done) else (0, len(time) - 1)


def _turns(log: RunLog) -> Array:
    """In-plane excursion since the start of the run [rev]."""
    angle = log["trajectory/angular_excursion"][:, 1]
    turns: Array = (angle - angle[:1]) / (2.0 * np.pi)
    return turns


def _moments(log: RunLog, rows: list[int]) -> list[_Moment]:
    time, turns, blend = log["trajectory/time"], _turns(log), log["trajectory/blend"]
    filled = log["contacts/body"] >= 0
    position, used = log["contacts/position"], log["contacts/used"]
    force = log["contacts/force_realised"]
    sound = filled & np.isfinite(position).all(axis=2) & np.isfinite(force).all(axis=2)
    return [
        _Moment(
            time=float(time[i]),
            turns=float(turns[i]),
            blend=float(blend[i]),
            contacts=position[i, sound[i]].astype(float),
            forces=force[i, sound[i]].astype(float),
            used=used[i, sound[i]],
        )
        for i in rows
    ]


# ---------------------------------------------------------------- one frame


def _frame(stage: "Scene", state: Array, moment: _Moment) -> Image.Image:
    pixels, camera = stage.draw(state)
    picture = Image.fromarray(pixels)
    layer = Image.new("RGBA", picture.size)
    pen = ImageDraw.Draw(layer)
    labels = _metre_marks(pen, stage, camera)
    _contacts(pen, camera, moment, stage.weight)
    picture.paste(layer, mask=layer)
    picture = picture.resize(FRAME, Image.Resampling.BOX)
    pen = ImageDraw.Draw(picture)
    for (x, y), text in labels:
        pen.text((x, y), text, _GROUND_INK, _font(12), anchor="ma")
    return picture


def _metre_marks(
    pen: ImageDraw.ImageDraw, stage: "Scene", camera: "Camera"
) -> list[tuple[tuple[float, float], str]]:
    """Ticks on the ground at whole metres; returns where which label goes."""
    x, y, _ = camera.target
    near = y - MARK_SIDE
    labels = []
    for metre in range(int(np.floor(x)) - 3, int(np.ceil(x)) + 4):
        ends = [[metre, side, stage.ground(metre, side)] for side in (near, near + 0.1)]
        (x0, y0), (x1, y1) = camera.pixels(np.array(ends)).tolist()
        if 0 < x0 < camera.width and y0 < camera.height:
            pen.line([x0, y0, x1, y1], (*_GROUND_INK, 255), 3)
            if 0.05 * camera.width < x0 < 0.95 * camera.width:
                labels.append(((x0 / OVERSAMPLING, y0 / OVERSAMPLING + 2), f"{metre} m"))
    return labels


def _contacts(pen: ImageDraw.ImageDraw, camera: "Camera", moment: _Moment, weight: float) -> None:
    """Dots at contacts and arrows along their forces, over the picture: never hidden by it."""
    near = np.linalg.norm(moment.contacts - camera.target, axis=1) < 0.7 * camera.distance
    forces = moment.forces[near] / max(weight, 1.0)
    forces *= np.minimum(1.0, MAX_FORCE / np.linalg.norm(forces, axis=1, keepdims=True).clip(1e-9))
    feet = camera.pixels(moment.contacts[near])
    tips = camera.pixels(moment.contacts[near] + FORCE_SCALE * forces)
    used = moment.used[near].astype(bool)
    for chosen in (False, True):
        for foot, tip in zip(feet[used == chosen], tips[used == chosen], strict=True):
            _arrow(pen, foot, tip, (*(_USED if chosen else _UNUSED), 215))
    for chosen in (False, True):
        for x, y in feet[used == chosen].tolist():
            _dot(pen, x, y, 4.5 * OVERSAMPLING, chosen)


def _dot(pen: ImageDraw.ImageDraw, x: float, y: float, radius: float, used: bool) -> None:
    box = [x - radius, y - radius, x + radius, y + radius]
    pen.ellipse(box, _USED if used else _UNUSED, (255, 255, 255), max(1, round(radius / 4)))


def _arrow(
    pen: ImageDraw.ImageDraw, foot: Array, tip: Array, colour: tuple[int, ...], size: float = 2.0
) -> None:
    along = tip - foot
    length = float(np.hypot(*along))
    if length < 4.0 * size:
        return
    along = along / length
    across = np.array([-along[1], along[0]])
    neck = tip - 6.0 * size * along
    pen.line([*foot, *neck], colour, round(1.5 * size))
    corners = [tip, neck + 2.6 * size * across, neck - 2.6 * size * across]
    pen.polygon([tuple(corner) for corner in corners], colour)


# ---------------------------------------------------------------- the sheet


def _sheet(
    log: RunLog, pictures: Sequence[Image.Image], moments: Sequence[_Moment], columns: int
) -> Image.Image:
    wide, high = FRAME[0] + _GAP, FRAME[1] + _CAPTION + _GAP
    rows = -(-len(pictures) // columns)
    size = (2 * _MARGIN + columns * wide - _GAP, _HEADER + rows * high + _FOOTER)
    sheet = Image.new("RGB", size, _PAPER)
    pen = ImageDraw.Draw(sheet)
    _header(pen, log)
    for i, (picture, moment) in enumerate(zip(pictures, moments, strict=True)):
        x, y = _MARGIN + i % columns * wide, _HEADER + i // columns * high
        sheet.paste(picture, (x, y))
        _caption(pen, x, y + FRAME[1] + 5, moment)
    _legend(pen, _MARGIN, size[0] - _MARGIN, size[1] - _FOOTER)
    return sheet


def _header(pen: ImageDraw.ImageDraw, log: RunLog) -> None:
    outcome = log.outcome
    name = _plain(outcome.get("behaviour", "run"))
    pen.text((_MARGIN, 16), name, _INK, _font(27))
    beside = _MARGIN + pen.textlength(name, _font(27)) + 18
    about = f"seed {log.attributes['seed']}   run {_plain(log.attributes['run_id'])}"
    pen.text((beside, 25), about, _SOFT, _font(18))
    colour, verdict = _verdict(outcome)
    pen.text((_MARGIN, 51), verdict, colour, _font(19))


def _verdict(outcome: dict[str, Any]) -> tuple[tuple[int, int, int], str]:
    if outcome.get("success") is True:
        done, took = outcome.get("revolutions"), outcome.get("duration")
        if isinstance(done, float) and isinstance(took, float):
            return _GOOD, f"success: {done:.1f} revolutions in {took:.1f} s"
        return _GOOD, "success"
    if outcome.get("success") is False:
        return _BAD, f"FAILED: {_plain(outcome.get('failure_reason') or 'no reason given')}"
    return _SOFT, "outcome unknown"


def _caption(pen: ImageDraw.ImageDraw, x: float, y: float, moment: _Moment) -> None:
    font = _font(16)
    pen.text((x + 2, y), f"{moment.time:.2f} s", _INK, font)
    pen.text((x + FRAME[0] / 2, y), f"{moment.turns:.2f} rev", _INK, font, anchor="ma")
    pen.text((x + FRAME[0] - 2, y), f"blend {moment.blend:.2f}", _SOFT, font, anchor="ra")


def _legend(pen: ImageDraw.ImageDraw, x: float, right: float, y: float) -> None:
    font = _font(15)
    for used, text in ((True, "contact used by the controller"), (False, "contact left out")):
        _dot(pen, x + 6, y + 10, 5.5, used)
        pen.text((x + 18, y), text, _SOFT, font)
        x += 18 + pen.textlength(text, font) + 26
    _arrow(pen, np.array([x, y + 10.0]), np.array([x + 30, y + 10.0]), _USED, 1.3)
    pen.text((x + 38, y), f"ground force (body weight: {FORCE_SCALE:g} m)", _SOFT, font)
    pen.text((right, y), "left limbs are darker", _SOFT, font, anchor="ra")


def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size=size)


def _plain(value: object) -> str:
    """A stranger's text on one printable line."""
    return "".join(c if c.isprintable() else " " for c in f"{value!s:.140}")


def _write(out: Path, sheet: Image.Image) -> None:
    """Replace `out` by a PNG in one step."""
    packed = _png(sheet)
    if len(packed) > SMALL:
        packed = _png(sheet.quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE))
    part = out.with_name(f"{out.name}.part")
    try:
        part.write_bytes(packed)
        os.replace(part, out)
    except OSError as error:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise InputError(f"cannot write {out}: {error.strerror or error}") from None


def _png(sheet: Image.Image) -> bytes:
    packed = BytesIO()
    sheet.save(packed, "PNG", optimize=True)
    return packed.getvalue()
