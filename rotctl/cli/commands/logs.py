"""What is in a log: `export`, `inspect`, `verify`."""

import argparse
import sys

from rotctl.bars import bar
from rotctl.cli.commands.arguments import LOG_HELP, Commands, log_file, opened_log, path_name
from rotctl.cli.log_wording import described, repeated
from rotctl.cli.wording import printable


def add_export(commands: Commands) -> None:
    """Add `export`."""
    command = commands.add_parser(
        "export",
        help="write a logged run for other programs",
        description="Write a run as motion capture (BVH), as the tables that motion trackers read "
        "(CSV, npz), as an animated scene for any viewer (binary glTF), or its model for other "
        "simulators (MJCF). Nothing is simulated again.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.add_argument(
        "--to", required=True, choices=("bvh", "csv", "npz", "gltf", "mjcf"), help="the format"
    )
    command.add_argument("--out", type=path_name, metavar="FILE", help="where to [beside the log]")
    command.set_defaults(command=export, interrupted="an unfinished file is not written")


def export(arguments: argparse.Namespace) -> int:
    """Write a log in another format."""
    from rotctl.export import export

    log = opened_log(arguments.log)
    print(export(log, arguments.to, arguments.out))
    time = log["trajectory/time"]
    if arguments.to == "csv" and len(time) > 1:  # the one format that has no place for it
        rate = f"{(len(time) - 1) / float(time[-1] - time[0]):.6g}"
        said = f"{rate} rows a second, which a .csv does not say; import-motion --rate {rate}"
        print(f"rotctl: {said}", file=sys.stderr)
    return 0


def add_inspect(commands: Commands) -> None:
    """Add `inspect`."""
    command = commands.add_parser(
        "inspect",
        help="what is inside a log, and is it whole",
        description="List a log's datasets with units, its outcome and provenance, and verify "
        "its checksums.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.set_defaults(command=inspect)


def inspect(arguments: argparse.Namespace) -> int:
    """Say what is inside a log, and whether it is whole."""
    from rotctl.log import RunLog

    log = RunLog.open(log_file(arguments.log))
    print(printable(described(log)))
    log.verify()
    print("\nintegrity  complete, checksums match")
    return 0


def add_verify(commands: Commands) -> None:
    """Add `verify`."""
    command = commands.add_parser(
        "verify",
        help="repeat a logged run: does it come out the same, to the last bit",
        description="Simulate the config of a log once more and compare every dataset bit by bit. "
        "Prints 'same bits', or the first step and datasets that part, whether control or physics "
        "went another way there, and what of code, versions, processor and C library is not what "
        "it was. Writes nothing. Exit code 0: the same; 1: not; 2: no log, or none that can be "
        "run. docs/reproducibility.md says where the same bits can be expected.",
    )
    command.add_argument("log", type=path_name, metavar="RUN.h5", help=LOG_HELP)
    command.add_argument("--json", action="store_true", help="print it as JSON on stdout")
    command.set_defaults(command=verify, interrupted="nothing was compared")


def verify(arguments: argparse.Namespace) -> int:
    """Repeat a logged run, and say whether it came out the same."""
    import json
    from dataclasses import asdict

    from rotctl.log import RunLog
    from rotctl.runs.repetition import repeat

    log = RunLog.open(log_file(arguments.log))
    with bar("again", "step", log.steps) as shown:
        repetition = repeat(log, shown.update)
    if arguments.json:
        print(json.dumps({"same": repetition.same, **asdict(repetition)}))
    else:
        print(printable(repeated(log, repetition)))
    return 0 if repetition.same else 1
