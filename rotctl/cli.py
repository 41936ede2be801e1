"""The command line: subcommands that import only what they need."""

import argparse
import io
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rotctl import __version__
from rotctl.errors import InputError, RotctlError

if TYPE_CHECKING:
    from rotctl.log import RunLog

EPILOG = """\
examples:
  rotctl run                                      Forward Roll 1, 20 s, into runs/<run id>/
  rotctl run seed=3 duration=5 --filmstrip        another start, a picture of it
  rotctl run controller.weights.angular_momentum=8
  rotctl sweep 'seed=range(0,50)' --out sweeps/a  fifty starts; the same again resumes
  rotctl summarise sweeps/a                       success rate with its interval, quartiles
  rotctl list                                     what can be chosen
  rotctl show behaviour=forward_roll_1            the whole config, with these choices
  rotctl replay runs/<run id>/run.h5              a page that plays it in the browser
  rotctl render runs/<run id>/run.h5 --filmstrip roll.png --video roll.mp4
  rotctl plot runs/<run id>/run.h5 --out roll.pdf
  rotctl inspect runs/<run id>/run.h5             what is in a log

exit codes: 0 simulated (a roll that stalls is a result: success false), 1 the physics or
the solver broke down, or a run of a sweep could not be run, 2 bad input, 130 interrupted
"""
OVERHEAD_RUNS = 1000  # of a sweep that rotctl bench times
OVERRIDES_HELP = "config overrides in Hydra's syntax, such as seed=3 (see rotctl list and show)"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    # One BLAS thread: matrices here are small, and runs in parallel are worth more.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # any path can be printed
    arguments = _parse(argv)
    try:
        with _terminated_like_interrupted():
            code = int(arguments.command(arguments))
            if sys.stdout:  # None where the shell has closed it
                sys.stdout.flush()
            return code
    except RotctlError as error:
        print(f"rotctl: {_one_line(str(error))}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print(f"rotctl: interrupted; {arguments.interrupted}", file=sys.stderr)
        return 130
    except BrokenPipeError:  # whoever read our output has seen enough
        _drop_stdout()
        return 0
    except OSError as error:
        _drop_stdout()
        what = f"{error.filename or 'output'}: {error.strerror or error}"
        print(f"rotctl: {_one_line(what)}", file=sys.stderr)
        return 2


@contextmanager
def _terminated_like_interrupted() -> Iterator[None]:
    """While it lasts, SIGTERM ends a run as cleanly as Ctrl-C does."""

    def interrupt(signum: int, frame: object) -> NoReturn:
        raise KeyboardInterrupt

    try:
        before = signal.signal(signal.SIGTERM, interrupt)
    except ValueError:  # not the main thread, which alone gets signals
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _drop_stdout() -> None:
    """Keep the interpreter from flushing to a closed or full stdout once more."""
    with suppress(OSError, AttributeError):  # it is no file, or None
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _one_line(text: str) -> str:
    return _printable(" ".join(text.split()))


def _printable(text: str) -> str:
    """Text from files and shells, without what could steer a terminal."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)


class _Parser(argparse.ArgumentParser):
    """One line an error, and no abbreviations that a later option would break."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {_one_line(message)}; see {self.prog} --help\n")


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Arguments, where overrides and options may be mixed: argparse takes one block alone."""
    arguments, others = _parser().parse_known_args(argv)
    takes_more = "overrides" in arguments
    unknown = [text for text in others if text.startswith("-") or not takes_more]
    if unknown:
        arguments.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    if takes_more:
        arguments.overrides = [*arguments.overrides, *others]
    return arguments


def _folder(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="rotctl",
        description="Physics-based rotational character control: a simulated human that rolls.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"rotctl {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    run = commands.add_parser(
        "run",
        help="simulate one run and log it",
        description="Simulate one run into OUT/<run id>/run.h5 and summary.json. The run id is "
        "a hash of the config: a run that is already there is reported, not redone.",
    )
    run.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    run.add_argument(
        "--out", type=_folder, default=Path("runs"), help="folder for runs [%(default)s]"
    )
    run.add_argument("--json", action="store_true", help="print the summary row as JSON on stdout")
    run.add_argument("--quiet", action="store_true", help="no progress, no notices")
    run.add_argument("--force", action="store_true", help="redo a run that is already there")
    run.add_argument("--filmstrip", action="store_true", help="also draw filmstrip.png beside it")
    run.set_defaults(command=_run)

    render = commands.add_parser(
        "render",
        help="draw pictures of a logged run",
        description="Draw a run from its log alone; nothing is simulated again.",
    )
    render.add_argument("log", type=Path, metavar="RUN.h5")
    render.add_argument(
        "--filmstrip",
        type=Path,
        metavar="OUT.png",
        help="side view that follows the character, frame beside frame",
    )
    render.add_argument(
        "--video",
        type=Path,
        metavar="OUT.mp4",
        help="the same view as a film, 30 frames/s; needs ffmpeg (pip install 'rotctl[video]')",
    )
    render.add_argument(
        "--frames", type=int, default=12, help="number of frames of the filmstrip [%(default)s]"
    )
    _add_window(render)
    render.set_defaults(command=_render)

    replay = commands.add_parser(
        "replay",
        help="make a page that plays a logged run in the browser",
        description="Write one HTML file that works offline: the run in 3D with its contact "
        "forces, beside its plots. Nothing is simulated again.",
    )
    replay.add_argument("log", type=Path, metavar="RUN.h5")
    replay.add_argument(
        "--html", type=Path, metavar="OUT.html", help="where to write it [replay.html by the log]"
    )
    replay.add_argument(
        "--compare", type=Path, metavar="OTHER.h5", help="another run, laid over as a ghost"
    )
    replay.set_defaults(command=_replay)

    plot = commands.add_parser(
        "plot",
        help="plot a logged run on one page",
        description="Plot rotation, momentum rates, blend, torques, contacts and solver of a run "
        "on one page, from its log alone.",
    )
    plot.add_argument("log", type=Path, metavar="RUN.h5")
    plot.add_argument(
        "--out",
        type=Path,
        metavar="OUT.png|.svg|.pdf",
        help="where to write it [plot.png by the log]",
    )
    _add_window(plot)
    plot.set_defaults(command=_plot)

    listing = commands.add_parser(
        "list",
        help="config groups and their choices",
        description="List the config groups and the choices of each. Choose with GROUP=CHOICE, "
        "as in: rotctl run start=rest",
    )
    listing.set_defaults(command=_list)

    show = commands.add_parser(
        "show",
        help="print the composed config as YAML",
        description="Print the config that a run with these overrides gets, as YAML: every key "
        "there can be overridden, as in: rotctl show controller.gains.pose_damping=40",
    )
    show.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    show.set_defaults(command=_show)

    inspect = commands.add_parser(
        "inspect",
        help="what is inside a log, and is it whole",
        description="List a log's datasets with units, its outcome and provenance, and verify "
        "its checksums.",
    )
    inspect.add_argument("log", type=Path, metavar="RUN.h5")
    inspect.set_defaults(command=_inspect)

    bench = commands.add_parser(
        "bench",
        help="where the time goes",
        description="Measure where the time goes: a control step, whole processes, solvers, "
        "contacts and hinges, sweeps. Takes some minutes.",
    )
    bench.add_argument("--repeats", type=int, default=5, help="median over this many [%(default)s]")
    bench.add_argument("--plot", type=Path, metavar="OUT.svg", help="plot cost against contacts")
    bench.set_defaults(command=_bench)

    sweep = commands.add_parser(
        "sweep",
        help="simulate many runs, and go on where it ended",
        description="Simulate every point of a grid into DIR/<run id>/run.h5, in Hydra's sweep "
        "syntax: a=x,y  'seed=range(0,100)'  'start=glob(*)'  or +experiment=NAME. Runs that are "
        "there are not redone, so that the same command goes on where it was cut off.",
    )
    sweep.add_argument("overrides", nargs="*", metavar="KEY=VALUES", help=OVERRIDES_HELP)
    sweep.add_argument("--out", type=_folder, required=True, metavar="DIR", help="folder of runs")
    sweep.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    sweep.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    sweep.add_argument(
        "--retries", type=int, default=2, help="for a run whose worker died [%(default)s]"
    )
    sweep.add_argument("--dry-run", action="store_true", help="only say what there is to do")
    sweep.add_argument("--strict", action="store_true", help="redo what other code has made")
    sweep.add_argument("--quiet", action="store_true", help="no progress, no notices")
    sweep.set_defaults(command=_sweep)

    summarise = commands.add_parser(
        "summarise",
        help="tables of many runs",
        description="Tabulate all runs below DIR, one row a run, into summary.csv (and "
        "summary.parquet, if pyarrow is there), and print success rates with 95 %% intervals and "
        "the quartiles of the metrics by group, also in groups.csv.",
    )
    summarise.add_argument("folder", type=Path, metavar="DIR")
    summarise.add_argument(
        "--by", metavar="KEY,KEY", help="columns to group by [the overridden keys but the seed]"
    )
    summarise.add_argument(
        "--mixed", action="store_true", help="average over runs of different code all the same"
    )
    summarise.set_defaults(command=_summarise)

    tune = commands.add_parser(
        "tune",
        help="search for poses or gains over many starts",
        description="Search what conf/tune/NAME.yaml declares, in whole generations, each on "
        "fresh training starts. The same command again goes on where the last one ended.",
    )
    tune.add_argument("name", metavar="NAME", help="a space in conf/tune/, or a .yaml file")
    tune.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    tune.add_argument(
        "--out", type=_folder, required=True, metavar="DIR", help="holds the search and its result"
    )
    budget = tune.add_mutually_exclusive_group()
    budget.add_argument("--trials", type=int, metavar="N", help="candidates in all [the space's]")
    budget.add_argument("--minutes", type=float, metavar="M", help="time for this call instead")
    tune.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    tune.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    tune.add_argument("--sampler", choices=("cmaes", "tpe"), help="instead of the space's")
    tune.add_argument("--seed", type=int, default=0, metavar="S", help="of the search [0]")
    tune.set_defaults(command=_tune)

    for command in commands.choices.values():
        command.set_defaults(parser=command, interrupted="an unfinished run leaves no log")
    for command in (render, replay, plot):
        command.set_defaults(interrupted="an unfinished picture is not written")
    for command in (sweep, tune):
        command.set_defaults(interrupted="the same command does what is left")
    return parser


def _add_window(command: argparse.ArgumentParser) -> None:
    command.add_argument("--from", type=float, metavar="S", dest="start", help="first time [s]")
    command.add_argument("--to", type=float, metavar="S", dest="end", help="last time [s]")


def _run(arguments: argparse.Namespace) -> int:
    from tqdm import tqdm

    from rotctl.config import load
    from rotctl.run import LOG_NAME, run

    config = load(arguments.overrides)
    steps = round(config.duration * config.controller.rate)
    with tqdm(
        total=steps,
        desc=f"{config.behaviour.name} seed {config.seed}",
        unit="step",
        disable=arguments.quiet or None,  # None: only where somebody watches
        leave=False,
        delay=0.2,
    ) as bar:
        result = run(config, arguments.out, arguments.force, bar.update)
    notices = [result.notice]
    if result.already_there:
        notices.append(f"already there, not redone (--force redoes it): {result.folder}")
    if result.replaced:
        notices.append(f"simulated again, the log there could not be used: {result.replaced}")
    for notice in filter(None, notices if not arguments.quiet else []):
        print(_one_line(notice), file=sys.stderr)
    picture = _filmstrip_beside(result.folder / LOG_NAME) if arguments.filmstrip else ""
    if arguments.json:
        import json

        print(json.dumps(result.summary))
    elif not arguments.quiet:
        print(_readable(result.summary))
        print(f"log        {result.folder / LOG_NAME}")
        if picture:
            print(f"filmstrip  {picture}")
    return 1 if result.broke_down else 0


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


def _render(arguments: argparse.Namespace) -> int:
    from rotctl.log import RunLog

    if arguments.filmstrip is None and arguments.video is None:
        raise InputError("nothing to draw: give --filmstrip OUT.png, --video OUT.mp4 or both")
    log, window = RunLog.open(_log_file(arguments.log)), (arguments.start, arguments.end)
    if arguments.filmstrip is not None:
        from rotctl.report.filmstrip import filmstrip

        filmstrip(log, arguments.filmstrip, arguments.frames, *window)
        print(arguments.filmstrip, flush=True)
    if arguments.video is not None:
        from tqdm import tqdm

        from rotctl.report.video import video

        with tqdm(desc="video", unit="frame", leave=False, disable=None, delay=0.2) as bar:

            def progress(done: int, total: int) -> None:
                bar.total = total
                bar.update(done - bar.n)

            video(log, arguments.video, *window, progress)
        print(arguments.video)
    return 0


def _replay(arguments: argparse.Namespace) -> int:
    from rotctl.log import RunLog
    from rotctl.report.replay import replay

    log = RunLog.open(_log_file(arguments.log))
    other = arguments.compare and RunLog.open(_log_file(arguments.compare))
    out = arguments.html or arguments.log.with_name("replay.html")
    replay(log, out, other)
    print(out)
    return 0


def _plot(arguments: argparse.Namespace) -> int:
    from rotctl.log import RunLog
    from rotctl.report.plot import plot

    log = RunLog.open(_log_file(arguments.log))
    out = arguments.out or arguments.log.with_name("plot.png")
    plot(log, out, arguments.start, arguments.end)
    print(out)
    return 0


def _log_file(path: Path) -> Path:
    if os.path.isdir(path):
        raise InputError(f"{path}: is a folder; name the log in it, such as {path / 'run.h5'}")
    return path


def _list(arguments: argparse.Namespace) -> int:
    from rotctl.listing import groups

    for group, choices in groups().items():
        print(group)
        width = max(map(len, choices))
        for choice, description in choices.items():
            print(f"  {choice:{width}}  {description}".rstrip())
    print("\nchoose with GROUP=CHOICE, change a value with KEY=VALUE; see: rotctl show")
    return 0


def _show(arguments: argparse.Namespace) -> int:
    from rotctl.config import load, to_yaml

    print(to_yaml(load(arguments.overrides)), end="")
    return 0


def _inspect(arguments: argparse.Namespace) -> int:
    from rotctl.log import RunLog

    log = RunLog.open(_log_file(arguments.log))
    print(_printable(_described(log)))
    log.verify()
    print("\nintegrity  complete, checksums match")
    return 0


def _bench(arguments: argparse.Namespace) -> int:
    from rotctl.bench import bench
    from rotctl.sweep import overhead

    if arguments.repeats < 1:
        raise InputError(f"--repeats={arguments.repeats}: must be at least 1")
    for table in bench(arguments.repeats, arguments.plot):
        print(table, end="\n\n", flush=True)
    sizes = ((OVERHEAD_RUNS, 1.0, 2), (OVERHEAD_RUNS // 8, 20.0, 1), (OVERHEAD_RUNS // 8, 20.0, 2))
    print(overhead.table([overhead.measure(*size) for size in sizes]))
    return 0


def _sweep(arguments: argparse.Namespace) -> int:
    from contextlib import closing

    from tqdm import tqdm

    from rotctl.sweep.engines import make_engine
    from rotctl.sweep.experiments import matrix
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.plan import plan, planned
    from rotctl.sweep.points import points
    from rotctl.sweep.progress import shown
    from rotctl.sweep.said import at_the_end, at_the_start, failures, without_running

    if arguments.retries < 0:
        raise InputError(f"--retries={arguments.retries}: must be at least 0")
    runs = planned(points(matrix(arguments.overrides)))
    with closing(make_engine(arguments.jobs, arguments.scheduler)) as engine:
        if arguments.dry_run:
            print(without_running(runs, arguments.out, engine.workers))
            return 0
        with locked(arguments.out):
            watched = None if not arguments.quiet else True  # None: only on a terminal
            with tqdm(total=len(runs), desc="checking", delay=1.0, disable=watched) as bar:
                there = plan(runs, arguments.out, arguments.strict, bar.update)
            if not arguments.quiet:
                print(at_the_start(there, arguments.out, engine.where), file=sys.stderr, flush=True)
            with shown(len(runs), len(there.done), arguments.quiet) as progress:
                now = launch(there, runs, arguments.out, engine, arguments.retries, progress)
    if now.broken:
        print(_printable(failures(now, runs)), file=sys.stderr)
    if not arguments.quiet:
        print(at_the_end(now, there, arguments.out))
    return 1 if now.broken else 0


def _summarise(arguments: argparse.Namespace) -> int:
    from rotctl.sweep.groups import grouped, markdown, written
    from rotctl.sweep.table import table

    found = table(arguments.folder)
    groups = grouped(found, arguments.by.split(",") if arguments.by else None, arguments.mixed)
    print(_printable(markdown(groups)), end="\n\n")
    for path in written(arguments.folder, found.rows, groups.rows):
        print(path)
    for note in [*found.notes, *groups.notes]:
        print(_one_line(note), file=sys.stderr)
    return 0


def _tune(arguments: argparse.Namespace) -> int:
    from contextlib import closing

    from tqdm import tqdm

    from rotctl.sweep.engines import make_engine
    from rotctl.tune import result
    from rotctl.tune.search import Watch, prepare, tune

    search, budget = prepare(
        arguments.name,
        arguments.overrides,
        arguments.seed,
        arguments.sampler,
        arguments.trials,
        arguments.minutes,
    )
    with (
        closing(make_engine(arguments.jobs, arguments.scheduler)) as engine,
        tqdm(desc=search.space.name, unit="run", leave=False, disable=None, delay=0.2) as bar,
    ):
        watch = Watch(lambda text: bar.write(text, file=sys.stderr), bar.update)
        found = tune(search, arguments.out, budget, engine, watch)
    written = result.write(found, arguments.out)
    print(result.comparison(found), *written, sep="\n")
    print(result.how_to_judge(found, written, arguments.out))
    return 0


def _readable(summary: dict[str, Any]) -> str:
    def number(key: str, form: str = ".2f") -> str:
        value = summary[key]
        return "-" if value is None else format(value, form)

    verdict = "success" if summary["success"] else f"FAILED: {summary['failure_reason']}"
    return "\n".join(
        [
            f"{summary['behaviour']}  seed {summary['seed']}  run {summary['run_id']}  {verdict}",
            f"  rolled       {number('revolutions', '.1f')} rev in {number('duration', '.1f')} s, "
            f"{number('angular_velocity_mean')} rev/s "
            f"(commanded {number('angular_velocity_commanded')})",
            f"  speed        {number('speed_mean')} m/s (commanded {number('speed_commanded')})",
            f"  heading      {number('heading_error_end', '.0f')} deg off at the end, "
            f"drift {number('lateral_drift')} m",
            f"  stall        {number('longest_stall')} s at most",
            f"  torque       {number('torque_p99_fraction')} of the limit (99th percentile), "
            f"{summary['solver_failures']} solver failures",
            f"  real time    x {number('real_time_factor', '.1f')}",
        ]
    )


def _described(log: "RunLog") -> str:
    from rotctl.log import SCHEMA

    attributes = log.attributes
    lines = [f"{log.path}  run {attributes['run_id']}  schema {attributes['schema_version']}", ""]
    for name in SCHEMA:
        shape = " x ".join(map(str, log[name].shape)) or "scalar"
        lines.append(f"{name:44} {shape:>16}  [{log.units(name)}]  {log.description(name)}")
    lines += ["", "outcome"]
    lines += [f"  {key:28} {value}" for key, value in log.outcome.items()]
    lines += ["", "provenance"]
    lines += [
        f"  {key:28} {attributes[key]}"
        for key in ("seed", "git_commit", "git_dirty", "versions", "machine", "wall_time")
    ]
    events = log.events
    lines += ["", f"events     {len(events) or 'none'}"]
    lines += [f"  {time:8.3f} s  {text}" for time, text in events[:20]]
    if len(events) > 20:
        lines.append(f"  ... and {len(events) - 20} more")
    return "\n".join(lines)
