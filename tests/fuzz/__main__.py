"""`make fuzz`: give many inputs, and say what they found; exit 1 if that is anything."""

import argparse
import os
import signal
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))  # the tests' own modules

from here import Here
from tqdm import tqdm

from fuzz import child, kinds, samples

PATIENCE = 10.0  # [s] of CPU, after which a simulation is interrupted as if by Ctrl-C
MOST_TASKS = 6  # of a search or a sweep that are carried out


class Few(Here):
    """Carries some tasks out and gives the others up."""

    def map(self, task, items, retries):
        self.fails = dict.fromkeys(range(max(0, MOST_TASKS - self.asked), len(items)), "given up")
        yield from super().map(task, items, retries)


def command(case):
    """What the child calls: the command, with what would take long cut short."""

    def call():
        from rotctl import listing
        from rotctl.cli import main
        from rotctl.report.site import build
        from rotctl.sweep import cluster, workers

        engine, connect = Few(), cluster.connect
        build.MOST_DRAWN = int(case.drawn)
        cluster.PATIENCE = 0.2

        def chosen(jobs, scheduler):
            connect(scheduler) if scheduler is not None else workers.LocalEngine(jobs)
            return engine

        workers.make_engine = chosen
        if case.conf:
            listing.__file__ = str(case.conf.parent / "package" / "listing.py")
        if case.simulates:
            signal.signal(signal.SIGPROF, signal.default_int_handler)
            signal.setitimer(signal.ITIMER_PROF, PATIENCE)
        return main(case.argv)

    return call


def given(made, seed, number, folder, some=kinds.KINDS):
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
    pages = [p for p in here.rglob("*") if p.suffix in (".html", ".md", ".csv") and p.is_file()]
    return "".join(p.read_text(errors="replace") for p in pages if not p.is_symlink())


def main():
    """Parse the command line and do it."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="number to begin with")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", metavar="SEED:NUMBER", help="one input; its folder is kept")
    arguments = parser.parse_args()
    os.environ["CANARY"] = "canary"
    os.environ.setdefault("MUJOCO_GL", "osmesa")
    base = Path(tempfile.mkdtemp(prefix="fuzz-"))
    for name in ("TMPDIR", "MPLCONFIGDIR", "HOME"):
        os.environ[name] = str(base / name)
        (base / name).mkdir()
    made = samples.make(base)
    import_all()
    if arguments.only:
        seed, number = map(int, arguments.only.split(":"))
        found, case = given(made, seed, number, base / "only")
        print(case, found.code, f"{found.cpu:.1f} s, {found.memory / 1e6:.0f} MB")
        print(found.fault, found.details, base / "only", sep="\n")
        return bool(found.fault)
    return _many(arguments, made, base)


def _many(arguments, made, base):
    begin, faults, most_cpu, most_memory, codes = time.monotonic(), [], 0.0, 0, {}
    tqdm.monitor_interval = 0  # no thread beside those who fork
    numbers = range(arguments.first, arguments.first + arguments.count)
    for number in tqdm(numbers, unit="input", disable=None):
        folder = base / "case"
        found, case = given(made, arguments.seed, number, folder)
        os.rename(folder, base / "done")
        _remove(base / "done")
        most_cpu, most_memory = max(most_cpu, found.cpu), max(most_memory, found.memory)
        codes[found.code] = codes.get(found.code, 0) + 1
        if found.fault:
            faults.append(found.fault)
            print(f"{arguments.seed}:{number}: {found.fault}\n  {_short(case.argv)}", flush=True)
            print("  " + "\n  ".join(found.details.strip().splitlines()[-6:]), flush=True)
    print(
        f"{arguments.count} inputs, seed {arguments.seed}: {len(faults)} faults; exit codes "
        f"{dict(sorted(codes.items(), key=str))}; at most {most_cpu:.1f} s of CPU and "
        f"{most_memory / 1e6:.0f} MB; {time.monotonic() - begin:.0f} s"
    )
    return bool(faults)


def _short(argv):
    return " ".join(word if len(word) < 120 else f"{word[:117]}..." for word in argv)


def _remove(folder):
    import shutil

    shutil.rmtree(folder, ignore_errors=True)


def import_all():
    """Once here, so that no child needs to."""
    import pkgutil

    import rotctl

    for module in pkgutil.walk_packages(rotctl.__path__, "rotctl."):
        if not module.name.rpartition(".")[2].startswith("_"):  # a script, a native library
            __import__(module.name)
    for name in ("optuna", "optuna.storages", "distributed", "hydra", "matplotlib.figure",
                 "matplotlib.backends.backend_svg", "matplotlib.backends.backend_agg"):  # fmt: skip
        __import__(name)


if __name__ == "__main__":
    sys.exit(main())
