"""Reference clips: `import-motion`, `author-motion`, `preview-motion`."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl.bars import bar, following
from rotctl.cli.clip_wording import import_warnings, imported
from rotctl.cli.commands.arguments import FRAMES, Commands, path_name, role_and_name
from rotctl.cli.wording import printable
from rotctl.errors import InputError

if TYPE_CHECKING:
    from rotctl.mechanics.model import Model
    from rotctl.motion import Clip

CLIP_FRAMES = 12  # of the filmstrip beside a clip


def add_import(commands: Commands) -> None:
    """Add `import-motion`."""
    command = commands.add_parser(
        "import-motion",
        help="make a reference clip of captured motion",
        description="Read a captured roll (BVH, ASF/AMC, DeepMimic, SMPL, a robot's joints), put "
        "it on one of our characters, cut out one cycle and write it as a clip over the phase of "
        "the roll. Says which joints it took, how well each segment follows, how fast the body "
        "turns and how well the loop closes.",
    )
    command.add_argument(
        "file", type=path_name, metavar="FILE", help=".bvh, .amc, .txt, .json, .npz or .csv"
    )
    command.add_argument(
        "--cycle",
        type=_seconds,
        metavar="START:END",
        help="of the roll [s] [the one that closes best]",
    )
    command.add_argument(
        "--skeleton", type=path_name, metavar="FILE.asf", help="of an .amc [the .asf of its name]"
    )
    command.add_argument("--rate", type=float, metavar="HZ", help="frame rate [the file's]")
    command.add_argument(
        "--up", choices=("x", "y", "z"), help="axis of a .bvh that is up [guessed, and told]"
    )
    command.add_argument(
        "--map",
        type=role_and_name,
        action="append",
        default=[],
        metavar="ROLE=NAME",
        help="which joint is what, as left_hip=Bone_7, where its name does not say",
    )
    command.add_argument(
        "--model",
        type=path_name,
        metavar="ROBOT.xml",
        help="whose joints a .csv or .npz has (MJCF)",
    )
    command.add_argument(
        "--symmetric", action="store_true", help="the mean of the roll and its mirror image"
    )
    command.add_argument("--licence", default="", metavar="TEXT", help="the source's terms")
    _add_clip_options(command)
    _add_character(command)
    command.set_defaults(command=import_motion, interrupted="an unfinished clip is not written")


def import_motion(arguments: argparse.Namespace) -> int:
    """Make a clip of captured motion."""
    from rotctl.motion.importing import import_motion
    from rotctl.motion.reading import Wishes, read_capture

    wishes = Wishes(
        arguments.skeleton, arguments.rate, arguments.up, dict(arguments.map), arguments.model
    )
    model = _model(arguments.character)
    capture = read_capture(arguments.file, wishes)
    with bar("retarget", "frame") as shown:
        made = import_motion(
            model,
            arguments.character,
            arguments.file,
            capture,
            arguments.cycle,
            arguments.symmetric,
            arguments.licence,
            following(shown),
            wishes,
        )
    out = _clip_written(arguments, made.clip)
    print(printable(imported(made)))
    for warning in import_warnings(made):
        print(f"rotctl: warning: {warning}", file=sys.stderr)
    return _clip_shown(arguments, model, made.clip, out)


def add_author(commands: Commands) -> None:
    """Add `author-motion`."""
    command = commands.add_parser(
        "author-motion",
        help="make a reference clip of key poses",
        description="Make a clip of the key poses of one cycle, as in conf/motion/keys/: smooth "
        "between them, its phase linear in how far the body has turned.",
    )
    command.add_argument("file", type=path_name, metavar="KEYS.yaml")
    _add_clip_options(command)
    _add_character(command)
    command.set_defaults(command=author_motion, interrupted="an unfinished clip is not written")


def author_motion(arguments: argparse.Namespace) -> int:
    """Make a clip of key poses."""
    from rotctl.motion.author import author, load_keys

    model = _model(arguments.character)
    clip = author(model, load_keys(arguments.file), arguments.character)
    return _clip_shown(arguments, model, clip, _clip_written(arguments, clip))


def add_preview(commands: Commands) -> None:
    """Add `preview-motion`."""
    command = commands.add_parser(
        "preview-motion",
        help="draw a reference clip",
        description="Draw one cycle of a clip as it rolls over the ground; nothing is simulated.",
    )
    command.add_argument("clip", metavar="CLIP", help="a name in conf/motion/, or a .yaml file")
    command.add_argument("--out", type=path_name, required=True, metavar="OUT.png")
    command.add_argument(
        "--frames", type=int, default=FRAMES, help="number of frames of the filmstrip [%(default)s]"
    )
    _add_character(command)
    command.set_defaults(command=preview_motion, interrupted="an unfinished picture is not written")


def preview_motion(arguments: argparse.Namespace) -> int:
    """Draw a clip."""
    from rotctl.motion import load_clip

    _draw_clip(
        _model(arguments.character), load_clip(arguments.clip), arguments.out, arguments.frames
    )
    print(arguments.out)
    return 0


def _model(character: str) -> "Model":
    from rotctl.config.loading import load
    from rotctl.runs.scenario import model_of

    return model_of(load([f"character={character}"]))


def _clip_written(arguments: argparse.Namespace, clip: "Clip") -> Path:
    """Write a clip; returns where it is."""
    from rotctl import files
    from rotctl.choices.own_folder import put, require_own_name
    from rotctl.motion.writing import text

    out = arguments.out if arguments.out.suffix else arguments.out.with_suffix(".yaml")
    files.require_ending(out, ".yaml")
    require_own_name("motion", out)
    if out.exists() and out.samefile(arguments.file):
        raise InputError(f"--out={out}: is the file that is read; give the clip another name")
    put("motion", out, text(clip))
    return out


def _clip_shown(arguments: argparse.Namespace, model: "Model", clip: "Clip", out: Path) -> int:
    """Say where a clip is; draw it if that is wanted and this machine can.

    A picture that lies there may be one of the user's own, so it stays; but that is told.
    """
    print(f"clip       {out}")
    picture = out.with_suffix(".png")
    if arguments.filmstrip:
        try:
            _draw_clip(model, clip, picture, CLIP_FRAMES)
        except InputError as error:
            print(f"rotctl: no filmstrip: {error}", file=sys.stderr)
        else:
            print(f"filmstrip  {picture}")
            return 0
    if picture.exists():
        told = f"{picture}: is older than the clip and does not show it"
        print(f"rotctl: warning: {told}", file=sys.stderr)
    return 0


def _draw_clip(model: "Model", clip: "Clip", out: Path, frames: int) -> None:
    from rotctl.motion.preview import preview
    from rotctl.report.motion_strip import motion_strip

    states, phases = preview(model, clip, frames)
    captions = [f"{phase:.2f} rev" for phase in phases]
    note = clip.description or clip.source
    motion_strip(model.mjcf, states, captions, clip.name, note, out)


def _add_clip_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--out", type=path_name, required=True, metavar="CLIP.yaml", help="the clip"
    )
    command.add_argument("--filmstrip", action="store_true", help="also draw CLIP.png beside it")


def _add_character(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--character", default="adult", metavar="NAME", help="whose joints [%(default)s]"
    )


def _seconds(text: str) -> tuple[float, float]:
    start, _, end = text.partition(":")
    try:
        return float(start), float(end)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: valid: START:END in seconds") from None
