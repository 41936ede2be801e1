"""One run, and how long it takes: `run`, `bench`."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rotctl.bars import bar
from rotctl.cli.commands.arguments import (
    OVERRIDES_HELP,
    RUNS,
    Commands,
    opened_log,
    path_name,
)
from rotctl.cli.run_wording import readable
from rotctl.cli.wording import one_line
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
    from rotctl.behaviours.chain.settings import first_stage
    from rotctl.config.loading import load, own_file, rebuilt, recorded
    from rotctl.log import LOG_NAME
    from rotctl.metrics.criteria.kinds import settling
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
        by = _made_by(result.folder / LOG_NAME)
        notices.append(f"already there{by}, not redone (--force redoes it): {result.folder}")
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


def _made_by(log: Path) -> str:
    """Which code has made a log, if it is another than this one."""
    from rotctl.log import collect, read_attributes
    from rotctl.results.code import code_of

    there, here = code_of(read_attributes(log, linked=False)), code_of(collect())
    return "" if there == here else f", made by {there}"


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
