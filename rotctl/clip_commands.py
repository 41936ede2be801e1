"""What the commands on reference clips do; each imports only what it needs."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl.errors import InputError
from rotctl.wording import clock_warnings, imported, printable

if TYPE_CHECKING:
    from rotctl.mechanics.model import Model
    from rotctl.motion import Clip

CLIP_FRAMES = 12  # of the filmstrip beside a clip


def import_motion(arguments: argparse.Namespace) -> int:
    """Make a clip of captured motion."""
    from tqdm import tqdm

    from rotctl.motion.importing import import_motion, read_capture

    model = _model(arguments.character)
    capture = read_capture(arguments.file, arguments.skeleton, arguments.rate)
    with tqdm(desc="retarget", unit="frame", leave=False, disable=None, delay=0.2) as bar:

        def progress(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        made = import_motion(
            model,
            arguments.character,
            arguments.file,
            capture,
            arguments.cycle,
            arguments.symmetric,
            arguments.licence,
            progress,
        )
    out = _clip_written(arguments, made.clip)
    print(printable(imported(made)))
    for warning in clock_warnings(made.flights):
        print(f"rotctl: warning: {warning}", file=sys.stderr)
    return _clip_shown(arguments, model, made.clip, out)


def author_motion(arguments: argparse.Namespace) -> int:
    """Make a clip of key poses."""
    from rotctl.motion.author import author, load_keys

    model = _model(arguments.character)
    clip = author(model, load_keys(arguments.file), arguments.character)
    return _clip_shown(arguments, model, clip, _clip_written(arguments, clip))


def preview_motion(arguments: argparse.Namespace) -> int:
    """Draw a clip."""
    from rotctl.motion import load_clip

    _draw_clip(
        _model(arguments.character), load_clip(arguments.clip), arguments.out, arguments.frames
    )
    print(arguments.out)
    return 0


def _model(character: str) -> "Model":
    from rotctl.config import load
    from rotctl.scenario import model_of

    return model_of(load([f"character={character}"]))


def _clip_written(arguments: argparse.Namespace, clip: "Clip") -> Path:
    """Write a clip; returns where it is."""
    from rotctl import files
    from rotctl.motion.writing import text

    out = arguments.out if arguments.out.suffix else arguments.out.with_suffix(".yaml")
    files.replace(out, text(clip).encode())
    return out


def _clip_shown(arguments: argparse.Namespace, model: "Model", clip: "Clip", out: Path) -> int:
    """Say where a clip is; draw it if that is wanted and this machine can."""
    print(f"clip       {out}")
    if arguments.filmstrip:
        try:
            _draw_clip(model, clip, out.with_suffix(".png"), CLIP_FRAMES)
        except InputError as error:
            print(f"rotctl: no filmstrip: {error}", file=sys.stderr)
        else:
            print(f"filmstrip  {out.with_suffix('.png')}")
    return 0


def _draw_clip(model: "Model", clip: "Clip", out: Path, frames: int) -> None:
    from rotctl.motion.preview import preview
    from rotctl.report.motion_strip import motion_strip

    states, phases = preview(model, clip, frames)
    captions = [f"{phase:.2f} rev" for phase in phases]
    note = clip.description or clip.source
    motion_strip(model.mjcf, states, captions, clip.name, note, out)
