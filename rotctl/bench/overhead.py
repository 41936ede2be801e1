"""How much of a sweep's CPU time is not simulation, and what a second process brings."""

import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from rotctl.config.loading import load
from rotctl.runs.scenario import build, shared
from rotctl.simulation.loop import simulate

RUNS = 1000  # of short sweeps; of long ones an eighth
SAMPLE = 20  # runs whose simulation is timed alone


@dataclass(frozen=True)
class Overhead:
    """Cost of a sweep.

    Attributes:
        wall: of the whole command [s].
        cpu: of the driver and its workers, start-up included [s].
        simulation: of the simulation loops alone, from a sample in one process [s].
    """

    runs: int
    duration: float
    jobs: int
    wall: float
    cpu: float
    simulation: float

    @property
    def share(self) -> float:
        """Of the CPU time, what is not simulation."""
        return 1.0 - self.simulation / self.cpu


def measure(runs: int, duration: float, jobs: int) -> Overhead:
    """Time a sweep of the default behaviour over `runs` seeds, in a temporary folder.

    Args:
        duration: simulated time of each run [s].
    """
    overrides = [f"duration={duration:g}", f"seed=range(0,{runs})"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        command = [sys.executable, "-m", "rotctl", "sweep", *overrides, "--quiet"]
        out = str(Path(folder, "runs"))
        subprocess.run([*command, "--jobs", str(jobs), "--out", out], check=True)
        wall = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Overhead(runs, duration, jobs, wall, cpu, runs * _simulation(runs, duration))


def _simulation(runs: int, duration: float) -> float:
    """CPU time of one simulation loop in a worker [s], the mean of a few seeds."""
    total, seeds, making = 0.0, range(min(runs, SAMPLE)), shared()
    for seed in seeds:
        scenario = build(load([f"duration={duration:g}", f"seed={seed}"]), making)
        begin = time.process_time()
        simulate(scenario, duration, scenario.config.physics.contact_capacity)
        total += time.process_time() - begin
    return total / len(seeds)


def sweeps() -> str:
    """Sweeps of short and of long runs, with one process and with two."""
    return table([measure(RUNS, 1.0, 2), *(measure(RUNS // 8, 20.0, jobs) for jobs in (1, 2))])


def table(measured: list[Overhead]) -> str:
    """Measurements as a Markdown table."""
    lines = ["| runs | simulated [s] | processes | wall [s] | CPU [s] | outside simulation |"]
    lines.append("| --- | --- | --- | --- | --- | --- |")
    lines += [
        f"| {m.runs} | {m.duration:g} | {m.jobs} | {m.wall:.1f} | {m.cpu:.1f} | {m.share:.0%} |"
        for m in measured
    ]
    return "\n".join(lines)
