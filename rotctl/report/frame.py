"""One frame of a run: the drawn model, its contacts and forces, and metres on the ground."""

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from rotctl.maths.rotations import Array
from rotctl.report.character import FORCE_SCALE
from rotctl.report.moments import Moment, is_pushed

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
MOST_TOLD = 4  # lines over a frame; a schedule may be long
_GROUND_INK = (108, 120, 134)


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
