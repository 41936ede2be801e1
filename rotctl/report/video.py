"""A run as a video, drawn from the log alone: the camera follows, 30 frames a second.

Fast in software: no shadows, reflections or multisampling, but dark discs on the ground.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from rotctl import files
from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import heading
from rotctl.report import encoder, gl, stored_model
from rotctl.report.frame import INK, MOODS, PAPER, SOFT, draw, typeface
from rotctl.report.moments import Moment, moments
from rotctl.report.rows import at_rate, drawable, window
from rotctl.report.skill import parts
from rotctl.report.stage_names import stages_of_parts
from rotctl.report.title import Title, title

RATE = 30.0  # [frames/s] of simulated time, which the video shows as fast as it was
FRAME = (640, 400)  # pixels of the picture
HEADER, FOOTER = 48, 32  # pixels above and below it
BESIDE = 0.5  # [s] before and after what is shown
TOLD = 1.5  # [s] for which words say what happened
FITTED = 60  # states that the camera's distance is chosen from


def video(
    log: RunLog,
    out: Path,
    start: float | None = None,
    end: float | None = None,
    progress: Callable[[int, int], object] = lambda done, of: None,
) -> None:
    """Draw a run into an MP4 file.

    Args:
        out: replaced if it is there.
        start: time of the first frame [s].
        end: time of the last frame [s]. Without both: a roll from the run's first to its last, of
            anything else what `rotctl.report.skill` finds, and a little before and after.
        progress: called after every frame with the number done and of how many.

    Raises:
        InputError: a time is not in the log, nothing can be drawn or encoded on this machine,
            or `out` cannot be written.
        LogError: the log is damaged or its model is not safe to draw.
    """
    files.require_ending(out, ".mp4")
    states = log["trajectory/qpos"]
    rows = _rows(log, drawable(log, states), start, end)
    program = encoder.executable()
    backend = gl.backend()
    # After that only: importing MuJoCo raises where MUJOCO_GL makes no sense.
    from rotctl.report import scene

    model = stored_model.load(log)
    top, shown = title(log), moments(log, rows, TOLD)
    size = (FRAME[0], HEADER + FRAME[1] + FOOTER)
    with (
        files.replacing(out) as part,
        scene.opened(model, backend, *FRAME, shadows=False) as stage,
    ):
        stage.fit(states[rows[:: 1 + len(rows) // FITTED]], heading(log))
        with encoder.encoding(program, part, size, RATE) as stream:
            for i, (row, moment) in enumerate(zip(rows, shown, strict=True)):
                picture = draw(stage, states[row], moment, FRAME)
                stream.write(_captioned(picture, top, moment, size).tobytes())
                progress(i + 1, len(rows))


def _rows(log: RunLog, time: Array, start: float | None, end: float | None) -> list[int]:
    shown = parts(log, time, stages_of_parts(log)) if start is None and end is None else []
    if shown:
        start = max(float(time[shown[0].first]) - BESIDE, float(time[0]))
        end = min(float(time[shown[-1].last]) + BESIDE, float(time[-1]))
    first, last = window(time, start, end)
    return (first + np.array(at_rate(time[first : last + 1], RATE))).tolist()


def _captioned(
    picture: Image.Image, top: Title, moment: Moment, size: tuple[int, int]
) -> Image.Image:
    whole = Image.new("RGB", size, PAPER)
    whole.paste(picture, (0, HEADER))
    pen = ImageDraw.Draw(whole)
    pen.text((12, 4), top.name, INK, typeface(18))
    beside = 12 + pen.textlength(top.name, typeface(18)) + 12
    pen.text((beside, 9), top.about, SOFT, typeface(13))
    pen.text((12, 27), top.verdict, MOODS[top.success], typeface(14))
    y, font = HEADER + FRAME[1] + 7, typeface(15)
    pen.text((12, y), f"{moment.time:.2f} s", INK, font)
    pen.text((size[0] / 2, y), f"{moment.turns:z.2f} rev", INK, font, anchor="ma")
    pen.text((size[0] - 12, y), moment.note, SOFT, font, anchor="ra")
    return whole
