"""One's own files and results: `new`, `inspect-model`, `ls`, `diff`."""

import argparse
import os
from pathlib import Path

from rotctl.cli.commands.arguments import (
    LOG_HELP,
    RUNS,
    Commands,
    opened_log,
    path_name,
    role_and_name,
    run_folder,
    second,
)
from rotctl.cli.wording import one_line, printable
from rotctl.engine import mujoco_without_opengl
from rotctl.errors import InputError


def add_new(commands: Commands) -> None:
    """Add `new`."""
    command = commands.add_parser(
        "new",
        help="a behaviour, character, terrain, ... of your own",
        description="Copy a choice with its comments under another name into your own folder of "
        "configs, ./conf or --config-dir, as in: rotctl new behaviour my_roll --from "
        "reference_roll. It is a choice like any other then. A start may also be the state that a "
        "run was in: rotctl new start my_fall --from RUN --at 12.5.",
    )
    command.add_argument("kind", metavar="KIND", help="a group of rotctl list, or motion, tune, "
                         "experiments")  # fmt: skip
    command.add_argument("name", metavar="NAME")
    command.add_argument("--from", dest="source", required=True, metavar="CHOICE",
                         help="that is copied; of a start also " + LOG_HELP)  # fmt: skip
    command.add_argument(
        "--at", type=second, metavar="S", help="of a run, when [s]; the last row if not said"
    )
    command.set_defaults(command=new, interrupted="an unfinished file is not written")


def new(arguments: argparse.Namespace) -> int:
    """Begin a file of one's own."""
    from rotctl.choices.own_folder import make

    kind, name, source, at = arguments.kind, arguments.name, arguments.source, arguments.at
    if kind == "start" and _is_run(source):
        mujoco_without_opengl()
        from rotctl.runs.recorded_start import make as recorded

        print(recorded(name, opened_log(Path(source)), at))
        return 0
    if at is not None:
        raise InputError(f"--at={at:g}: is a time of a run, and --from={source} is none")
    print(make(kind, name, source))
    return 0


def _is_run(source: str) -> bool:
    """Whether it names a run and no start."""
    from rotctl.choices.listing import choices

    return source not in choices("start") and os.path.lexists(run_folder(Path(source)))


def add_inspect_model(commands: Commands) -> None:
    """Add `inspect-model`."""
    command = commands.add_parser(
        "inspect-model",
        help="what a humanoid of yours (MJCF) is as a character",
        description="Find pelvis, chest, head and limbs of a humanoid with hinge joints and say "
        "which of its bodies and joints is which of ours, how strong it is, and what is made up. "
        "--out writes it as a character, such as conf/character/NAME.yaml, to be changed and "
        "chosen with character=NAME.",
    )
    command.add_argument("file", type=path_name, metavar="ROBOT.xml")
    command.add_argument("--out", type=path_name, metavar="NAME.yaml")
    command.add_argument(
        "--map",
        type=role_and_name,
        action="append",
        default=[],
        metavar="ROLE=NAME",
        help="which body is what, as left_hip=leg_1, where its name does not say",
    )
    command.add_argument(
        "--hulls", action="store_true", help="meshes touch by their convex hulls, not by capsules"
    )
    command.add_argument(
        "--proxies",
        action="append",
        default=[],
        metavar="NAME",
        help="which of its shapes touch: a name, class:NAME or group:N, where * stands for "
        "anything; all that collide in the file by default",
    )
    command.set_defaults(command=inspect_model, interrupted="an unfinished file is not written")


def inspect_model(arguments: argparse.Namespace) -> int:
    """Say what a model is as a character, and write it as one."""
    import yaml

    from rotctl import files
    from rotctl.adopting import adopt
    from rotctl.choices.own_folder import put, require_own_name
    from rotctl.cli.character_wording import adopted

    out = arguments.out
    if out is not None:
        files.require_ending(out, ".yaml")
        require_own_name("character", out)
        if os.path.lexists(out):  # edited by hand, as what it writes is meant to be
            raise InputError(f"--out={out}: is there already; give the character another name")
    name, roles = (out or arguments.file).stem, dict(arguments.map)
    proxies = tuple(arguments.proxies)
    found = adopt(arguments.file, name, roles, hulls=arguments.hulls, proxies=proxies)
    print(printable(adopted(found)))
    if out is not None:
        head = f"# {arguments.file.name} as rotctl inspect-model takes it.\n"
        text = yaml.safe_dump(found.character, sort_keys=False, default_flow_style=None, width=100)
        put("character", out, head + text)
        print(f"character  {out}")
    return 0


def add_ls(commands: Commands) -> None:
    """Add `ls`."""
    command = commands.add_parser(
        "ls",
        help="the runs in a folder",
        description="List the runs below a folder, one a line: run id, when its log was written, "
        "behaviour, seed, duration, the config values in which it differs from other runs of its "
        "behaviour, and how it ended.",
    )
    command.add_argument(
        "folder", type=path_name, nargs="?", default=RUNS, metavar="DIR", help="[%(default)s]"
    )
    command.set_defaults(command=ls)


def ls(arguments: argparse.Namespace) -> int:
    """List runs."""
    from rotctl.results.lines import lines
    from rotctl.results.stored_runs import stored_runs

    runs, notes = stored_runs(arguments.folder)
    for line in lines(runs, arguments.folder):
        print(printable(line))
    for note in notes:
        print(one_line(note))
    return 0


def add_diff(commands: Commands) -> None:
    """Add `diff`."""
    command = commands.add_parser(
        "diff",
        help="what differs between two runs or two sweeps",
        description="Compare two logs, or two folders of runs: the config's values that differ, "
        "and the figures (of a folder median and quartiles).",
    )
    command.add_argument(
        "one", type=path_name, metavar="A", help=f"{LOG_HELP}, or a folder of runs"
    )
    command.add_argument("other", type=path_name, metavar="B")
    command.set_defaults(command=diff)


def diff(arguments: argparse.Namespace) -> int:
    """Compare runs or sweeps."""
    from rotctl.results.comparison import compared

    one, other = run_folder(arguments.one), run_folder(arguments.other)
    for path in (one, other):
        if not path.exists():
            raise InputError(f"{path}: no such file or folder")
    print(printable(compared(one, other, opened_log)))
    return 0
