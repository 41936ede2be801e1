"""Pictures of a log: `render`, `replay`, `plot`."""

import argparse

from rotctl import files
from rotctl.bars import bar, following
from rotctl.cli.commands.arguments import (
    FRAMES,
    LOG_HELP,
    Commands,
    opened_log,
    path_name,
    second,
)
from rotctl.errors import InputError


def add_render(commands: Commands) -> None:
    """Add `render`."""
    command = commands.add_parser(
        "render",
        help="draw pictures of a logged run",
        description="Draw a run from its log alone; nothing is simulated again.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.add_argument(
        "--filmstrip",
        type=path_name,
        metavar="OUT.png",
        help="side view that follows the character, frame beside frame",
    )
    command.add_argument(
        "--video",
        type=path_name,
        metavar="OUT.mp4",
        help="the same view as a film, 30 frames/s; needs ffmpeg (pip install 'rotctl[video]')",
    )
    command.add_argument("--frames", type=int, help=f"number of frames of the filmstrip [{FRAMES}]")
    _add_window(command)
    command.set_defaults(command=render, interrupted="an unfinished picture is not written")


def render(arguments: argparse.Namespace) -> int:
    """Draw a filmstrip, a video or both from a log."""
    if arguments.filmstrip is None and arguments.video is None:
        raise InputError("nothing to draw: give --filmstrip OUT.png, --video OUT.mp4 or both")
    if arguments.video is not None:
        files.require_ending(arguments.video, ".mp4")
    if arguments.frames is not None and arguments.filmstrip is None:
        raise InputError(f"--frames={arguments.frames}: is of a filmstrip; a video has 30 a second")
    log, window = opened_log(arguments.log), (arguments.start, arguments.end)
    if arguments.filmstrip is not None:
        from rotctl.report.filmstrip import filmstrip

        frames = FRAMES if arguments.frames is None else arguments.frames
        filmstrip(log, arguments.filmstrip, frames, *window)
        print(arguments.filmstrip, flush=True)
    if arguments.video is not None:
        from rotctl.report.video import video

        with bar("video", "frame") as shown:
            video(log, arguments.video, *window, following(shown))
        print(arguments.video)
    return 0


def add_replay(commands: Commands) -> None:
    """Add `replay`."""
    command = commands.add_parser(
        "replay",
        help="make a page that plays a logged run in the browser",
        description="Write one HTML file that works offline: the run in 3D with its contact "
        "forces, beside its plots. Nothing is simulated again.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.add_argument(
        "--html",
        type=path_name,
        metavar="OUT.html",
        help="where to write it [replay.html by the log]",
    )
    command.add_argument(
        "--compare", type=path_name, metavar="OTHER.h5", help="another run, laid over as a ghost"
    )
    command.set_defaults(command=replay, interrupted="an unfinished picture is not written")


def replay(arguments: argparse.Namespace) -> int:
    """Write a page that plays a log in the browser."""
    from rotctl.report.replay import replay

    log = opened_log(arguments.log)
    other = arguments.compare and opened_log(arguments.compare)
    out = arguments.html or log.path.with_name("replay.html")
    replay(log, out, other)
    print(out)
    return 0


def add_plot(commands: Commands) -> None:
    """Add `plot`."""
    command = commands.add_parser(
        "plot",
        help="plot a logged run on one page",
        description="Plot rotation, momentum rates, blend, torques, contacts and solver of a run "
        "on one page, from its log alone.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.add_argument(
        "--out",
        type=path_name,
        metavar="OUT.png|.svg|.pdf",
        help="where to write it [plot.png, plan.png or prints.png by the log]",
    )
    view = command.add_mutually_exclusive_group()
    view.add_argument(
        "--from-above",
        action="store_true",
        help="plot where it rolled, beside the way that it was to follow",
    )
    view.add_argument(
        "--from-behind",
        action="store_true",
        help="plot where on its body the ground bore it",
    )
    _add_window(command)
    command.set_defaults(command=plot, interrupted="an unfinished picture is not written")


def plot(arguments: argparse.Namespace) -> int:
    """Plot a log on one page."""
    from rotctl.report.plan import plan
    from rotctl.report.plot import plot
    from rotctl.report.prints import prints

    log = opened_log(arguments.log)
    name, drawn = ("plan.png", plan) if arguments.from_above else ("plot.png", plot)
    if arguments.from_behind:
        name, drawn = "prints.png", prints
    out = arguments.out or log.path.with_name(name)
    drawn(log, out, arguments.start, arguments.end)
    print(out)
    return 0


def _add_window(command: argparse.ArgumentParser) -> None:
    command.add_argument("--from", type=second, metavar="S", dest="start", help="first time [s]")
    command.add_argument("--to", type=second, metavar="S", dest="end", help="last time [s]")
