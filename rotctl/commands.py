"""What each command does with its arguments; each imports only what it needs."""

import argparse
import os
import sys
from pathlib import Path

from rotctl.errors import InputError
from rotctl.wording import described, one_line, printable, readable


def run(arguments: argparse.Namespace) -> int:
    """Simulate one run and say how it went."""
    from tqdm import tqdm

    from rotctl.config import load, recorded
    from rotctl.log import LOG_NAME, RunLog
    from rotctl.run import run

    if arguments.again is None:
        config = load(arguments.overrides)
    elif arguments.overrides:
        raise InputError(f"--again repeats a run as it was: leave out {arguments.overrides[0]!r}")
    else:
        config = recorded(RunLog.open(_log_file(arguments.again)))
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
        print(one_line(notice), file=sys.stderr)
    picture = _filmstrip_beside(result.folder / LOG_NAME) if arguments.filmstrip else ""
    if arguments.json:
        import json

        print(json.dumps(result.summary))
    elif not arguments.quiet:
        print(readable(result.summary))
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


def render(arguments: argparse.Namespace) -> int:
    """Draw a filmstrip, a video or both from a log."""
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


def replay(arguments: argparse.Namespace) -> int:
    """Write a page that plays a log in the browser."""
    from rotctl.log import RunLog
    from rotctl.report.replay import replay

    log = RunLog.open(_log_file(arguments.log))
    other = arguments.compare and RunLog.open(_log_file(arguments.compare))
    out = arguments.html or arguments.log.with_name("replay.html")
    replay(log, out, other)
    print(out)
    return 0


def plot(arguments: argparse.Namespace) -> int:
    """Plot a log on one page."""
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


def list_choices(arguments: argparse.Namespace) -> int:
    """List config groups and their choices."""
    from rotctl.listing import groups

    for group, choices in groups().items():
        print(group)
        width = max(map(len, choices))
        for choice, description in choices.items():
            print(f"  {choice:{width}}  {description}".rstrip())
    print("\nchoose with GROUP=CHOICE, change a value with KEY=VALUE; see: rotctl show")
    return 0


def show(arguments: argparse.Namespace) -> int:
    """Print the composed config."""
    from rotctl.config import load, to_yaml

    print(to_yaml(load(arguments.overrides)), end="")
    return 0


def inspect(arguments: argparse.Namespace) -> int:
    """Say what is inside a log, and whether it is whole."""
    from rotctl.log import RunLog

    log = RunLog.open(_log_file(arguments.log))
    print(printable(described(log)))
    log.verify()
    print("\nintegrity  complete, checksums match")
    return 0


def verify(arguments: argparse.Namespace) -> int:
    """Repeat a logged run, and say whether it came out the same."""
    import json
    from dataclasses import asdict

    from tqdm import tqdm

    from rotctl.log import RunLog
    from rotctl.verify import repeat
    from rotctl.wording import repeated

    log = RunLog.open(_log_file(arguments.log))
    with tqdm(
        total=log.steps, desc="again", unit="step", leave=False, disable=None, delay=0.2
    ) as bar:
        found = repeat(log, bar.update)
    if arguments.json:
        print(json.dumps({"same": found.same, **asdict(found)}))
    else:
        print(printable(repeated(log, found)))
    return 0 if found.same else 1


def bench(arguments: argparse.Namespace) -> int:
    """Measure where the time goes."""
    from rotctl.bench import bench

    if arguments.repeats < 1:
        raise InputError(f"--repeats={arguments.repeats}: must be at least 1")
    for table in bench(arguments.repeats, arguments.plot):
        print(table, end="\n\n", flush=True)
    return 0


def sweep(arguments: argparse.Namespace) -> int:
    """Simulate a grid of runs, or what is left of it."""
    from contextlib import closing

    from tqdm import tqdm

    from rotctl.results import experiments
    from rotctl.sweep.launch import launch
    from rotctl.sweep.lock import locked
    from rotctl.sweep.plan import plan, planned
    from rotctl.sweep.points import points
    from rotctl.sweep.progress import shown
    from rotctl.sweep.said import at_the_end, at_the_start, failures, without_running
    from rotctl.sweep.workers import make_engine

    if arguments.retries < 0:
        raise InputError(f"--retries={arguments.retries}: must be at least 0")
    runs = planned(points(experiments.matrix(arguments.overrides)))
    with closing(make_engine(arguments.jobs, arguments.scheduler)) as engine:
        if arguments.dry_run:
            print(without_running(runs, arguments.out, engine.workers))
            return 0
        with locked(arguments.out):
            if experiment := experiments.named(arguments.overrides):
                experiments.copy_into(arguments.out, experiment)
            watched = None if not arguments.quiet else True  # None: only on a terminal
            with tqdm(total=len(runs), desc="checking", delay=1.0, disable=watched) as bar:
                there = plan(runs, arguments.out, arguments.strict, bar.update)
            if not arguments.quiet:
                print(at_the_start(there, arguments.out, engine.where), file=sys.stderr, flush=True)
            with shown(len(runs), len(there.done), arguments.quiet) as progress:
                now = launch(there, runs, arguments.out, engine, arguments.retries, progress)
    if now.broken:
        print(printable(failures(now, runs)), file=sys.stderr)
    if not arguments.quiet:
        print(at_the_end(now, there, arguments.out))
    return 1 if now.broken else 0


def summarise(arguments: argparse.Namespace) -> int:
    """Make tables of the runs below a folder."""
    from rotctl.results.groups import grouped, markdown, written
    from rotctl.results.table import table

    found = table(arguments.folder)
    groups = grouped(found, arguments.by.split(",") if arguments.by else None, arguments.mixed)
    print(printable(markdown(groups)), end="\n\n")
    for path in written(arguments.folder, found.rows, groups.rows):
        print(path)
    for note in [*found.notes, *groups.notes]:
        print(one_line(note), file=sys.stderr)
    return 0


def report(arguments: argparse.Namespace) -> int:
    """Make the pages on many runs, and compare their claims with those of an earlier report."""
    from tqdm import tqdm

    from rotctl.report.site import against
    from rotctl.report.site.build import report

    # Before it is replaced, should it be the same folder.
    old = against.read(arguments.against) if arguments.against else None
    with tqdm(desc="report", unit="part", leave=False, disable=None, delay=0.2) as bar:

        def progress(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        claims = report(arguments.folder, arguments.out, progress)
    print(arguments.out / "index.html")
    if old is None:
        return 0
    found = against.changes(old, claims)
    print(found.text)
    return 1 if found.worse else 0


def tune(arguments: argparse.Namespace) -> int:
    """Search for config values."""
    from contextlib import closing

    from tqdm import tqdm

    from rotctl.sweep.workers import make_engine
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
