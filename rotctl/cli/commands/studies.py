"""Many runs: `sweep`, `judge`, `summarise`, `report`."""

import argparse
import sys
from pathlib import Path

from rotctl.bars import bar, bars, following
from rotctl.cli.commands.arguments import (
    OVERRIDES_HELP,
    Commands,
    keys,
    name_and_text,
    path_name,
    run_folder,
)
from rotctl.cli.wording import one_line, printable
from rotctl.errors import InputError


def add_sweep(commands: Commands) -> None:
    """Add `sweep`."""
    command = commands.add_parser(
        "sweep",
        help="simulate many runs, and go on where it ended",
        description="Simulate every point of a grid into DIR, in Hydra's sweep "
        "syntax: a=x,y  'seed=range(0,100)'  'start=glob(*)'  or +experiment=NAME. Runs that are "
        "there are not redone, so that the same command goes on where it was cut off.",
    )
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUES", help=OVERRIDES_HELP
    )
    command.add_argument(
        "--out",
        type=path_name,
        metavar="DIR",
        help="folder of runs [sweeps/NAME of an experiment]",
    )
    command.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    command.add_argument(
        "--retries", type=int, default=2, help="for a run whose worker died [%(default)s]"
    )
    command.add_argument(
        "--keep",
        default="all",
        metavar="WHAT",
        help="logs: all, failures, sample:N or rows, as rows are kept of all runs [%(default)s]",
    )
    command.add_argument("--dry-run", action="store_true", help="only say what there is to do")
    command.add_argument("--strict", action="store_true", help="redo what other code has made")
    command.add_argument("--quiet", action="store_true", help="no progress, no notices")
    command.set_defaults(command=sweep, interrupted="the same command does what is left")


def sweep(arguments: argparse.Namespace) -> int:
    """Simulate a grid of runs, or what is left of it."""
    from contextlib import closing

    from rotctl.results import experiments, manifest
    from rotctl.sweep import keep
    from rotctl.sweep.claimed import require_claims
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.messages import at_the_end, at_the_start, failures, without_running
    from rotctl.sweep.plan import plan, planned
    from rotctl.sweep.points import count, points
    from rotctl.sweep.progress import shown
    from rotctl.sweep.workers import make_engine

    if arguments.retries < 0:
        raise InputError(f"--retries={arguments.retries}: must be at least 0")
    experiment = experiments.named(arguments.overrides)
    if arguments.out is None and not experiment:
        raise InputError("no folder for the runs; give --out DIR, such as --out sweeps/mine")
    out = arguments.out or Path("sweeps", experiment)
    kept = keep.read(arguments.keep)
    watched = None if not arguments.quiet else True  # None: only on a terminal
    matrix, tqdm = experiments.matrix(arguments.overrides), bars()
    with closing(make_engine(arguments.jobs, arguments.scheduler)) as engine:
        with tqdm(points(matrix), desc="planning", unit="point", delay=1.0, disable=watched) as bar:
            runs = planned(bar)
        require_claims(arguments.overrides, runs)
        if arguments.dry_run:
            print(without_running(runs, out, engine.workers, kept, count(matrix)))
            return 0
        with locked(out) as notice:
            if notice:
                print(f"rotctl: {one_line(notice)}", file=sys.stderr)
            if experiment:
                experiments.copy_into(out, experiment)
            with tqdm(total=len(runs), desc="checking", delay=1.0, disable=watched) as looking:
                there = plan(runs, out, arguments.strict, looking.update, kept)
            if not arguments.quiet:
                mine = {run.run_id for run in runs}
                others = len(manifest.read(out).keys() - mine) if experiment else 0
                print(
                    at_the_start(there, out, engine.where, count(matrix), len(runs), others),
                    file=sys.stderr,
                    flush=True,
                )
            with shown(len(runs), len(there.done), arguments.quiet) as progress:
                tally = launch(there, runs, out, engine, arguments.retries, progress)
    if tally.broken:
        print(printable(failures(tally, runs)), file=sys.stderr)
    if not arguments.quiet:
        print(at_the_end(tally, there, out))
    return 1 if tally.broken else 0


def add_judge(commands: Commands) -> None:
    """Add `judge`."""
    command = commands.add_parser(
        "judge",
        help="verdicts by other criteria, without simulation",
        description="Judge all runs below DIR that have logs by other criteria, such as "
        "criteria=landing or criteria.stall_time=2: verdicts and metrics again, one row a run, in "
        "DIR/judged.csv, beside the verdicts that were; and by metrics of your own, such as "
        "--metric 'top=max(com[:, 2])'. Logs and rows stay as they are.",
    )
    command.add_argument("folder", type=path_name, metavar="DIR")
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUE", help="of criteria alone"
    )
    command.add_argument(
        "--metric",
        type=name_and_text,
        action="append",
        default=[],
        metavar="NAME=EXPRESSION",
        help="a further column, of the log's arrays (docs/metrics.md); goes before one of the "
        "same name in FILE.yaml",
    )
    command.add_argument(
        "--metrics", type=path_name, metavar="FILE.yaml", help="NAME: EXPRESSION, one a line"
    )
    command.add_argument(
        "--by", type=keys, metavar="KEY,KEY", help="columns to group by, as in summarise"
    )
    command.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    command.set_defaults(command=judge, interrupted="nothing was judged")


def judge(arguments: argparse.Namespace) -> int:
    """Judge runs by other criteria."""
    from contextlib import closing

    from rotctl import files
    from rotctl.metrics.expressions.expression import file_of_metrics, read_all
    from rotctl.results.group_table import markdown
    from rotctl.results.groups import grouped
    from rotctl.sweep.judging import criteria, judge
    from rotctl.sweep.workers import make_engine

    folder = run_folder(arguments.folder)
    if not folder.exists():  # before what is missing besides
        raise InputError(f"{folder}: no such folder")
    texts: dict[str, str] = {}
    for name, text in arguments.metric:
        if name in texts:
            both = f"{texts[name]:.60} and {text:.60}"
            raise InputError(f"--metric {name:.60}: given twice, {both}; rename one")
        texts[name] = text
    if arguments.metrics is not None:
        texts = file_of_metrics(arguments.metrics) | texts
    metrics = read_all(texts)
    wanted = criteria(arguments.overrides, none=bool(metrics))
    with closing(make_engine(arguments.jobs, None)) as engine, bar("judging", "run") as shown:
        found = judge(folder, wanted, engine, shown.update, metrics)
    groups = grouped(found.table, arguments.by)
    path = folder / "judged.csv"
    files.replace(path, files.encoded(found.table.rows.to_csv(index=False)))
    print(printable(markdown(groups)), end="\n\n")
    if arguments.overrides:
        print(f"by these criteria: {found.lost} no longer a success, {found.won} newly one")
    print(path)
    for note in [*found.table.notes, *groups.notes]:
        print(one_line(note), file=sys.stderr)
    return 0


def add_summarise(commands: Commands) -> None:
    """Add `summarise`."""
    command = commands.add_parser(
        "summarise",
        help="tables of many runs",
        description="Tabulate all runs below DIR, one row a run, into summary.csv (and "
        "summary.parquet, if pyarrow is there), and print success rates with 95 % intervals and "
        "the quartiles of the metrics by group, also in groups.csv.",
    )
    command.add_argument("folder", type=path_name, metavar="DIR")
    command.add_argument(
        "--by",
        type=keys,
        metavar="KEY,KEY",
        help="columns to group by [the overridden keys but the seed]",
    )
    command.add_argument(
        "--mixed", action="store_true", help="average over runs of different code all the same"
    )
    command.set_defaults(command=summarise, interrupted="no table is written")


def summarise(arguments: argparse.Namespace) -> int:
    """Make tables of the runs below a folder."""
    from rotctl.results.group_table import markdown, written
    from rotctl.results.groups import grouped
    from rotctl.results.table import table

    found = table(arguments.folder)
    groups = grouped(found, arguments.by, arguments.mixed)
    paths = written(arguments.folder, found.rows, groups.rows)  # before a reader may hang up
    print(printable(markdown(groups)), end="\n\n")
    print(*paths, sep="\n")
    for note in [*found.notes, *groups.notes]:
        print(one_line(note), file=sys.stderr)
    return 0


def add_report(commands: Commands) -> None:
    """Add `report`."""
    command = commands.add_parser(
        "report",
        help="pages on many runs: claims with verdicts, pictures, replays",
        description="Make a static folder of pages out of the runs below DIR, a sweep or several: "
        "the claims of their experiments with verdicts, pictures and replays of the median and "
        "the worst run of each row, charts, and where it all comes from. Also claims.csv, "
        "junit.xml and summary.md. Nothing is simulated again.",
    )
    command.add_argument("folder", type=path_name, metavar="DIR")
    command.add_argument(
        "--out", type=path_name, default=Path("site"), help="folder for the pages [%(default)s]"
    )
    command.add_argument(
        "--against",
        type=path_name,
        metavar="OLD",
        help="an earlier report: print which verdicts changed, exit 1 if one got worse",
    )
    command.set_defaults(command=report, interrupted="an unfinished picture is not written")


def report(arguments: argparse.Namespace) -> int:
    """Make the pages on many runs, and compare their claims with those of an earlier report."""
    from rotctl.report.site import against
    from rotctl.report.site.build import report
    from rotctl.report.site.study import untested

    # Before it is replaced, should it be the same folder.
    old = against.read(arguments.against) if arguments.against else None
    with bar("report", "part") as shown:
        claims = report(arguments.folder, arguments.out, following(shown))
    print(arguments.out / "index.html")
    for text in untested(claims):
        print(one_line(text))
    if old is None:
        return 0
    found = against.changes(old, claims)
    print(found.text)
    return 1 if found.worse else 0
