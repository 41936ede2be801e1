"""One frame of a run: the drawn model, its contacts and forces, and metres on the ground."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays, in_frame
from rotctl.report.character import FORCE_SCALE
from rotctl.report.happenings import happenings
from rotctl.report.stage_names import stage_names, stages_of_parts

if TYPE_CHECKING:
    from rotctl.report.camera import Camera
    from rotctl.report.scene import Scene

MAX_FORCE = 5.0  # [body weights] longer arrows are cut
MARK_SIDE = 0.42  # [m] towards the camera from an adult
PAPER, INK, SOFT = (255, 255, 255), (28, 34, 44), (104, 114, 128)
GOOD, BAD = (22, 122, 76), (190, 32, 38)
MOODS = {True: GOOD, False: BAD, None: SOFT}  # of a run's verdict
USED, UNUSED = (235, 88, 18), (138, 146, 156)
OUTSIDE = (130, 30, 165)  # a force from outside
OUTSIDE_SCALE = 4.0  # its arrow is so much longer: a push that tips one over weighs a quarter
LONGEST_OUTSIDE = 0.8  # [m] of an adult's, at most: it begins in the picture
LEAST_PUSH = 0.5  # [N] less is none
FARTHEST = 1.0  # [m] from the centre of mass to where it acts; a stranger's log may say anything
MOST_TOLD = 4  # lines over a frame; a schedule may be long
STEADY = 1e-3  # what varies less over a stage is no blend
_GROUND_INK = (108, 120, 134)


@dataclass(frozen=True)
class Moment:
    """What a frame shows beside the model."""

    time: float  # [s]
    turns: float  # about its axis, see `turns_done` [rev]
    note: str  # the blend of the poses where there is one, else the name of the stage
    contacts: Array  # (k, 3)
    forces: Array  # (k, 3) [N]
    used: Array  # (k,)
    push: Array  # (3,) force from outside [N]
    pushed: Array  # (3,) where it acts: on its line, nearest to the centre of mass
    happened: tuple[str, ...] = ()  # since the frame before


def turns_done(log: Arrays, stages: Sequence[int] = ()) -> Array:
    """Excursion about what the behaviour turns about, since the start of the run (n,) [rev].

    Args:
        stages: how many each part of a chain has. A part that turns about another axis than the
            one before begins at 0.
    """
    axis = in_frame(log, "trajectory/trunk_axis")
    angle = in_frame(log, "trajectory/angular_excursion")
    part = np.zeros(len(angle), dtype=int)
    if len(stages) > 1:
        part = np.searchsorted(np.cumsum(stages), log["command/stage"], side="right")
    begins = np.flatnonzero(np.diff(part, prepend=-1)).tolist()
    turns, before = np.zeros(len(angle)), -1
    for first, end in zip(begins, [*begins[1:], len(angle)], strict=True):
        about = int(np.abs(axis[first]).argmax())
        done = turns[first - 1] if about == before else 0.0
        turns[first:end] = done + (angle[first:end, about] - angle[first, about]) / (2.0 * np.pi)
        before = about
    return turns


def moments(log: RunLog, rows: list[int], lasting: float = 0.0) -> list[Moment]:
    """What is drawn over the frames of these rows; what happened for so long [s] from then on."""
    time, turns, notes = log["trajectory/time"], turns_done(log, stages_of_parts(log)), _notes(log)
    filled = log["contacts/body"] >= 0
    position, used = log["contacts/position"], log["contacts/used"]
    force = log["contacts/force_realised"]
    sound = filled & np.isfinite(position).all(axis=2) & np.isfinite(force).all(axis=2)
    push, pushed = _pushes(log)
    changed = happenings(log)
    before = [rows[0] - 1, *rows[:-1]]
    return [
        Moment(
            time=float(time[i]),
            turns=float(turns[i]),
            note=notes[i],
            contacts=position[i, sound[i]].astype(float),
            forces=force[i, sound[i]].astype(float),
            used=used[i, sound[i]],
            push=push[i],
            pushed=pushed[i],
            happened=tuple(
                each.told
                for each in changed
                if each.row <= i and (each.row > last or time[i] < time[each.row] + lasting)
            ),
        )
        for last, i in zip(before, rows, strict=True)
    ]


def _pushes(log: RunLog) -> tuple[Array, Array]:
    """Forces from outside (n, 3), and where each acts: at c + F x M / F2, M about c."""
    com = np.asarray(log["trajectory/com"], dtype=float)
    if "disturbance/wrench" not in log:
        return np.zeros_like(com), com
    wrench = np.nan_to_num(log["disturbance/wrench"], nan=0.0, posinf=0.0, neginf=0.0)
    force, moment = wrench[:, :3], wrench[:, 3:]
    square = (force**2).sum(axis=1, keepdims=True).clip(LEAST_PUSH**2)
    off = np.cross(force, moment) / square
    return force, com + off.clip(-FARTHEST, FARTHEST)


def _notes(log: RunLog) -> list[str]:
    """The blend in every row; where a stage does not blend its name, if the config tells it."""
    blend = log["trajectory/blend"]
    stage = log["command/stage"] if "command/stage" in log else np.zeros(len(blend), dtype=int)
    named, notes = (
        stage_names(log),
        np.array([f"blend {value:.2f}" for value in blend], dtype=object),
    )
    for number in np.unique(stage).tolist():
        here = stage == number
        if np.ptp(blend[here]) < STEADY:
            notes[here] = named[number] if 0 <= number < len(named) else ""
    return [str(note) for note in notes]


def draw(stage: "Scene", state: Array, moment: Moment, size: tuple[int, int]) -> Image.Image:
    """A frame of `size` pixels; a stage that is larger gives smooth edges."""
    scale = stage.width / size[0]
    pixels, camera = stage.draw(state)
    picture = Image.fromarray(pixels)
    layer = Image.new("RGBA", picture.size)
    pen = ImageDraw.Draw(layer)
    labels = _metre_marks(pen, stage, camera, scale)
    _forces(pen, camera, moment, stage, scale)
    picture.paste(layer, mask=layer)
    if picture.size != size:
        picture = picture.resize(size, Image.Resampling.BOX)
    pen = ImageDraw.Draw(picture)
    for (x, y), text in labels:
        pen.text((x, y), text, _GROUND_INK, typeface(12), anchor="ma")
    lines = list(moment.happened)
    if is_pushed(moment):
        lines.insert(0, f"from outside: {np.linalg.norm(moment.push):.0f} N")
    for i, told in enumerate(lines[:MOST_TOLD]):
        pen.text((8, 6 + 18 * i), told, OUTSIDE, typeface(14))
    return picture


def is_pushed(moment: Moment) -> bool:
    """Whether a force from outside is to be seen."""
    return bool(LEAST_PUSH < np.linalg.norm(moment.push) < np.inf)


def _metre_marks(
    pen: ImageDraw.ImageDraw, stage: "Scene", camera: "Camera", scale: float
) -> list[tuple[tuple[float, float], str]]:
    """Ticks on the ground at whole metres of the way; returns where which label goes."""
    c, s = np.cos(stage.heading), np.sin(stage.heading)
    x, y, _ = camera.target
    along, near = c * x + s * y, c * y - s * x - max(MARK_SIDE * stage.size, stage.beside)
    labels = []
    for metre in range(int(np.floor(along)) - 3, int(np.ceil(along)) + 4):
        places = [(c * metre - s * side, s * metre + c * side) for side in (near, near + 0.1)]
        ends = [[*place, stage.ground(*place)] for place in places]
        (x0, y0), (x1, y1) = camera.pixels(np.array(ends)).tolist()
        if 0 < x0 < camera.width and y0 < camera.height:
            pen.line([x0, y0, x1, y1], (*_GROUND_INK, 255), round(1.5 * scale))
            if 0.05 * camera.width < x0 < 0.95 * camera.width:
                labels.append(((x0 / scale, y0 / scale + 2), f"{metre} m"))
    return labels


def _forces(
    pen: ImageDraw.ImageDraw, camera: "Camera", moment: Moment, stage: "Scene", scale: float
) -> None:
    """Dots at contacts, arrows along forces, over the picture: never hidden by it."""
    near = np.linalg.norm(moment.contacts - camera.target, axis=1) < 0.7 * camera.distance
    forces = moment.forces[near] / max(stage.weight, 1.0)
    forces *= np.minimum(1.0, MAX_FORCE / np.linalg.norm(forces, axis=1, keepdims=True).clip(1e-9))
    feet = camera.pixels(moment.contacts[near])
    tips = camera.pixels(moment.contacts[near] + FORCE_SCALE * stage.size * forces)
    used = moment.used[near].astype(bool)
    for chosen in (False, True):
        for foot, tip in zip(feet[used == chosen], tips[used == chosen], strict=True):
            arrow(pen, foot, tip, (*(USED if chosen else UNUSED), 215), scale)
    for chosen in (False, True):
        for x, y in feet[used == chosen].tolist():
            dot(pen, x, y, 4.5 * scale, chosen)
    if is_pushed(moment) and np.isfinite(moment.pushed).all():
        size = float(np.linalg.norm(moment.push))
        long = min(OUTSIDE_SCALE * FORCE_SCALE * size / max(stage.weight, 1.0), LONGEST_OUTSIDE)
        ends = [moment.pushed - stage.size * long * moment.push / size, moment.pushed]
        tail, tip = camera.pixels(np.array(ends))
        arrow(pen, tail, tip, (*OUTSIDE, 255), 1.4 * scale)


def dot(pen: ImageDraw.ImageDraw, x: float, y: float, radius: float, used: bool) -> None:
    """A contact."""
    box = [x - radius, y - radius, x + radius, y + radius]
    pen.ellipse(box, USED if used else UNUSED, (255, 255, 255), max(1, round(radius / 4)))


def arrow(
    pen: ImageDraw.ImageDraw, foot: Array, tip: Array, colour: tuple[int, ...], size: float
) -> None:
    """A force; nothing where it is too short to see."""
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


def typeface(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """The font of all words in pictures."""
    return ImageFont.load_default(size=size)
