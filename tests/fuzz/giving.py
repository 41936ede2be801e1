"""An input, made and given to its command, with what would take long cut short."""

import os
import pkgutil
import signal

from here import Here

import rotctl
from fuzz import child, kinds

PATIENCE = 10.0  # [s] of CPU, after which a simulation is interrupted as if by Ctrl-C
LARGE = 50_000_000  # [bytes] nothing that a report writes is
MOST_TASKS = 6  # of a search or a sweep that are carried out


class Few(Here):
    """Carries some tasks out and gives the others up."""

    def map(self, task, items, retries):
        self.fails = dict.fromkeys(range(max(0, MOST_TASKS - self.asked), len(items)), "given up")
        yield from super().map(task, items, retries)


def command(case):
    """What the child calls: the command, with what would take long cut short."""

    def call():
        from rotctl.choices import config_folders
        from rotctl.cli.main import main
        from rotctl.report.site import build
        from rotctl.sweep import cluster, engine_choice

        os.environ.update(case.environ)
        engine, connect = Few(), cluster.connect
        build.MOST_DRAWN = int(case.drawn)
        cluster.PATIENCE = 0.2

        def chosen(jobs, scheduler):
            connect(scheduler) if scheduler is not None else engine_choice.LocalEngine(jobs)
            return engine

        engine_choice.make_engine = chosen
        if case.conf:
            config_folders.__file__ = str(case.conf.parent / "package/choices/here.py")
        if case.simulates:
            signal.signal(signal.SIGPROF, signal.default_int_handler)
            signal.setitimer(signal.ITIMER_PROF, PATIENCE)
        return main(case.argv)

    return call


def given(made, seed, number, folder, some):
    """Make an input in a folder and give it; what was found, and the case."""
    here, outside = folder / "in", folder / "outside"
    for path in (here, outside):
        path.mkdir(parents=True)
    (outside / "victim").write_text("precious")
    (outside / "secret").write_text("canary: [unclosed\n")
    case = kinds.make(made, seed, number, here, some)
    temporary = os.environ["TMPDIR"]
    found = child.give(command(case), here, [here, temporary, os.environ["MPLCONFIGDIR"]])
    kept = sorted(path.name for path in outside.iterdir()) == ["secret", "victim"]
    if not kept or (outside / "victim").read_text() != "precious":
        found = child.Found("outside", found.details, found.code, found.cpu, found.memory)
    if not found.fault and "canary" in _written(here):
        found = child.Found("canary", found.details, found.code, found.cpu, found.memory)
    return found, case


def _written(here):
    """All text that a report consists of."""
    pages = (p for p in here.rglob("*") if p.suffix in (".html", ".md", ".csv"))
    plain = (p for p in pages if p.is_file() and not p.is_symlink() and p.stat().st_size < LARGE)
    return "".join(page.read_text(errors="replace") for page in plain)


def import_all():
    """Once here, so that no child needs to."""
    for module in pkgutil.walk_packages(rotctl.__path__, "rotctl."):
        if not module.name.rpartition(".")[2].startswith("_"):  # a script, a native library
            __import__(module.name)
    for name in ("optuna", "optuna.storages", "distributed", "hydra", "matplotlib.figure",
                 "matplotlib.backends.backend_svg", "matplotlib.backends.backend_agg"):  # fmt: skip
        __import__(name)
