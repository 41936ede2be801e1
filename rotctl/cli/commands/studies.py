"""Many runs that are there: `judge`, `summarise`, `report`."""

import argparse
import sys
from pathlib import Path

from rotctl.bars import bar, following
from rotctl.cli.commands.arguments import Commands, keys, name_and_text, path_name, run_folder
from rotctl.cli.wording import one_line, printable
from rotctl.errors import InputError


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
    from rotctl.sweep.criteria import criteria
    from rotctl.sweep.engine_choice import make_engine
    from rotctl.sweep.judging import judge

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
