"""One run and its config: `run`, `list`, `show`, `bench`."""

import argparse
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl.bars import bar
from rotctl.cli.commands.arguments import (
    IS_ID,
    LOG_NAME,
    OVERRIDES_HELP,
    RUNS,
    Commands,
    opened_log,
    path_name,
    run_folder,
)
from rotctl.cli.wording import one_line, readable
from rotctl.errors import InputError

if TYPE_CHECKING:
    from rotctl.results.index import Row


def add_run(commands: Commands) -> None:
    """Add `run`."""
    command = commands.add_parser(
        "run",
        help="simulate one run and log it",
        description="Simulate one run into OUT/<run id>/run.h5 and summary.json. The run id is "
        "a hash of the config: a run that is already there is reported, not redone.",
    )
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUE", help=OVERRIDES_HELP
    )
    command.add_argument(
        "--out", type=path_name, default=RUNS, help="folder for runs [%(default)s]"
    )
    command.add_argument(
        "--again",
        type=path_name,
        metavar="RUN.h5",
        help="the config of that log, instead of KEY=VALUE (rotctl verify compares, too); "
        "DIR/<run id> of a sweep that kept its row alone: the same bits again, or exit code 1",
    )
    command.add_argument(
        "--json", action="store_true", help="print the summary row as JSON on stdout"
    )
    command.add_argument("--quiet", action="store_true", help="no progress, no notices")
    command.add_argument("--force", action="store_true", help="redo a run that is already there")
    command.add_argument(
        "--filmstrip", action="store_true", help="also draw filmstrip.png beside it"
    )
    command.set_defaults(
        command=run,
        interrupted="an unfinished run leaves no log; of one of more than a minute its beginning "
        "is in interrupted.h5",
    )


def run(arguments: argparse.Namespace) -> int:
    """Simulate one run and say how it went."""
    from rotctl.engine import mujoco_without_opengl

    mujoco_without_opengl()
    from rotctl.behaviours.chain.settings import first_stage
    from rotctl.config.loading import load, own_file, rebuilt, recorded
    from rotctl.log import LOG_NAME
    from rotctl.metrics.criteria.judge import settling
    from rotctl.runs.run import built, run

    row = None
    if arguments.again is None:
        config = load(arguments.overrides)
    elif arguments.overrides:
        raise InputError(f"--again repeats a run as it was: leave out {arguments.overrides[0]!r}")
    elif row := _row_at(arguments.again):
        config = rebuilt(arguments.again, lambda: row.config)
    else:
        config = recorded(opened_log(arguments.again))
    steps = round(config.duration * config.controller.rate)
    what = f"{config.behaviour.name} seed {config.seed}"
    with bar(what, "step", steps, hidden=arguments.quiet) as shown:
        try:
            again = arguments.again is not None
            result = run(config, arguments.out, arguments.force, shown.update, again=again)
        except InputError as error:
            where = own_file(arguments.overrides, str(error), built)
            raise InputError(f"{where}{error}") from None
    stage = first_stage(config.behaviour) if config.start.state else ""
    first = f"begins with its first stage, {stage}, however the body is then"
    begins = f"{config.behaviour.name} {first}" if stage else ""
    notices = [result.notice, begins]
    if result.already_there:
        notices.append(f"already there, not redone (--force redoes it): {result.folder}")
    if result.replaced:
        notices.append(f"simulated again, the log there could not be used: {result.replaced}")
    other = row is not None and result.trajectory != row.trajectory
    if row is not None and not other:
        notices.append(f"the same bits as in the sweep: run {row.run_id}")
    for notice in filter(None, notices if not arguments.quiet else []):
        print(one_line(notice), file=sys.stderr)
    picture = _filmstrip_beside(result.folder / LOG_NAME) if arguments.filmstrip else ""
    if arguments.json:
        import json

        print(json.dumps(result.summary))
    elif not arguments.quiet:
        print(readable(result.summary, settling(config.criteria)))
        print(f"log        {result.folder / LOG_NAME}")
        if picture:
            print(f"filmstrip  {picture}")
    if row is not None and other:
        from rotctl.results.code import code_of

        made_by = f"run {row.run_id}, made by {code_of(row.origin)}"
        print(f"rotctl: other bits than in the sweep: {one_line(made_by)}", file=sys.stderr)
    return 1 if result.broke_down or other else 0


def _row_at(path: Path) -> "Row | None":
    """The row of a run whose log was not kept; what is looked for, where nothing lies."""
    if path.is_file():
        return None
    from rotctl.results.index import row_at

    return row_at(path)


def _filmstrip_beside(log: Path) -> str:
    """Draw a filmstrip if this machine can; say why not otherwise."""
    from rotctl.log import RunLog
    from rotctl.report.filmstrip import filmstrip

    out = log.with_name("filmstrip.png")
    try:
        filmstrip(RunLog.open(log), out)
    except InputError as error:
        print(f"rotctl: no filmstrip: {error}", file=sys.stderr)
        return ""
    return str(out)


def add_list(commands: Commands) -> None:
    """Add `list`."""
    command = commands.add_parser(
        "list",
        help="config groups and their choices",
        description="List the config groups and the choices of each, or those of one group. Choose "
        "with GROUP=CHOICE, as in: rotctl run start=rest",
    )
    command.add_argument("group", nargs="?", metavar="GROUP", help="such as behaviour [all]")
    command.set_defaults(command=list_choices)


def list_choices(arguments: argparse.Namespace) -> int:
    """List config groups and their choices."""
    from rotctl.choices.describing import described, groups, strays
    from rotctl.choices.listing import EXPERIMENTS
    from rotctl.settings.checking import brief
    from rotctl.suggestion import instead, meant

    titles = {
        "catch": "catch (+catch=NAME)",
        "course": "course (+course=NAME)",
        "finish": "finish (+finish=NAME)",
        "motion": "motion (behaviour.reference.clip=NAME)",
        "tune": "tune (rotctl tune NAME)",
        EXPERIMENTS: "experiments (rotctl sweep +experiment=NAME)",
    }
    listed = groups() | {name: described(name) for name in titles}
    if arguments.group is not None:
        if arguments.group not in listed:
            near = instead(arguments.group, list(listed))
            raise InputError(f"{brief(arguments.group)}: no such group; {near}")
        listed = {arguments.group: listed[arguments.group]}
    for folder, choices in listed.items():
        if choices:
            print(titles.get(folder, folder))
            _print_choices(folder, choices)
    for name, path in strays().items() if arguments.group is None else ():
        near = meant(name, listed)
        print(f"{path}: is of no group, so that nobody reads it{near and '; '}{near.rstrip()}")
    print("\nchoose with GROUP=CHOICE, change a value with KEY=VALUE; see: rotctl show")
    return 0


def _print_choices(folder: str, choices: Mapping[str, str]) -> None:
    from rotctl.choices.listing import is_own, misnamed, named_files

    width = max(map(len, choices))
    places = misnamed(folder) | named_files(folder)
    for choice, description in choices.items():
        mine = f"  [yours: {places[choice]}]" if is_own(places[choice]) else ""
        print(f"  {choice:{width}}  {description}{mine}".rstrip())


def add_show(commands: Commands) -> None:
    """Add `show`."""
    command = commands.add_parser(
        "show",
        help="print the composed config as YAML",
        description="Print the config that a run with these overrides gets, as YAML: every key "
        "there can be overridden, as in: rotctl show controller.pose.damping=40. In their place "
        "a run may be named, by its folder or its id in runs/, to print the config that it had.",
    )
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUE", help=OVERRIDES_HELP
    )
    command.add_argument("--part", metavar="KEY", help="only what is under it, such as behaviour")
    command.set_defaults(command=show)


def show(arguments: argparse.Namespace) -> int:
    """Print the composed config."""
    from rotctl.config.loading import load, recorded
    from rotctl.settings.writing import part_to_yaml, to_yaml

    run = _only_run(arguments.overrides)
    config = recorded(opened_log(run)) if run else load(arguments.overrides)
    print(part_to_yaml(config, arguments.part) if arguments.part else to_yaml(config), end="")
    return 0


def _only_run(overrides: list[str]) -> Path | None:
    """The run that is named in place of overrides, if one is."""
    from rotctl.choices.override_files import MARK

    if len(overrides) != 1 or "=" in overrides[0] or overrides[0].startswith(MARK):
        return None
    path = run_folder(Path(overrides[0]))
    named = path.suffix == ".h5" or IS_ID.fullmatch(path.name)
    return path if named or os.path.lexists(path / LOG_NAME) else None


def add_bench(commands: Commands) -> None:
    """Add `bench`."""
    command = commands.add_parser(
        "bench",
        help="where the time goes",
        description="Measure where the time goes: a control step, whole processes, solvers, "
        "contacts and hinges, sweeps. Takes some minutes.",
    )
    command.add_argument(
        "--repeats", type=int, default=5, help="median over this many [%(default)s]"
    )
    command.add_argument(
        "--plot", type=path_name, metavar="OUT.svg", help="plot cost against contacts"
    )
    command.set_defaults(command=bench)


def bench(arguments: argparse.Namespace) -> int:
    """Measure where the time goes."""
    from rotctl.bench import bench

    if arguments.repeats < 1:
        raise InputError(f"--repeats={arguments.repeats}: must be at least 1")
    for table in bench(arguments.repeats, arguments.plot):
        print(table, end="\n\n", flush=True)
    return 0
