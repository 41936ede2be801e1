"""Many runs are made: `sweep`."""

import argparse
import sys
from pathlib import Path

from rotctl.bars import bars
from rotctl.cli.commands.arguments import OVERRIDES_HELP, Commands, path_name
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
    from functools import partial

    from rotctl.results import experiments, manifest
    from rotctl.sweep import keep
    from rotctl.sweep.asked import asked
    from rotctl.sweep.claimed import require_claims
    from rotctl.sweep.engine_choice import make_engine
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.messages import at_the_end, at_the_start, failures, without_running
    from rotctl.sweep.plan import plan
    from rotctl.sweep.points import count
    from rotctl.sweep.progress import shown

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
        bar = partial(tqdm, desc="planning", unit="point", delay=1.0, disable=watched)
        runs = asked(arguments.overrides, bar)
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
