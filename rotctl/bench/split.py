"""Where the time of a control step goes that Python makes, on a real forward roll.

Times on a shared machine wander; ratios taken in one run, medians over repeats, do not.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from statistics import median

from rotctl.config.loading import load
from rotctl.control import Controller
from rotctl.log import TrajectoryBuffer
from rotctl.maths.rotations import Array
from rotctl.qp import Problem, Solution, Solver, make_solver
from rotctl.runs.scenario import Scenario, build
from rotctl.simulation.episode import Episode
from rotctl.simulation.record import record

SECONDS = 10.0  # simulated time of one repeat
STAGES = ("physics", "kinematics", "assembly", "solve", "log")
STAGE_OF = {  # of the episode's marks
    "physics": "physics",
    "state": "kinematics",
    "command": "assembly",
    "decision": "assembly",
    "log": "log",
}
EXPLAINED = {
    "physics": "MuJoCo's steps, and a look at its warnings",
    "kinematics": "reading state, contacts, momentum",
    "assembly": "excursion, targets, pose torques, matrices of both passes",
    "solve": "the quadratic programs of both passes",
    "log": "one row of every dataset",
}


@dataclass
class Split:
    """Seconds spent in each stage over one simulated roll."""

    steps: int = 0
    seconds: dict[str, float] = field(default_factory=lambda: dict.fromkeys(STAGES, 0.0))

    @property
    def control(self) -> float:
        """All that is not physics or log [s]."""
        return sum(self.seconds[stage] for stage in ("kinematics", "assembly", "solve"))

    @property
    def total(self) -> float:
        """Everything [s]."""
        return sum(self.seconds.values())


class TimedSolver:
    """A solver that adds up the time it takes."""

    def __init__(self, solver: Solver) -> None:
        """Wrap `solver`."""
        self.name, self.shape = solver.name, solver.shape
        self.seconds = 0.0
        self._solver = solver

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve and note the time."""
        begin = time.perf_counter()
        solution = self._solver.solve(problem, start)
        self.seconds += time.perf_counter() - begin
        return solution


def split(repeats: int) -> str:
    """The split of a control step; medians over `repeats` rolls of each setting, in turn."""
    columns: dict[tuple[str, int], list[Split]] = {
        (backend, substeps): [] for backend in ("compiled", "reference") for substeps in (1, 4)
    }
    for _ in range(repeats):
        for (backend, substeps), rolls in columns.items():
            overrides = [f"controller.backend={backend}", f"physics.substeps={substeps}"]
            rolls.append(roll(build(load(overrides))))
    width = 58

    def row(label: str, form: str, value: Callable[[Split], float]) -> str:
        cells = (format(median(map(value, rolls)), form) for rolls in columns.values())
        return f"{label:{width}}" + "".join(cell.rjust(11) for cell in cells)

    lines = [
        f"forward_roll_1, {SECONDS:g} s step by step in Python, median of {repeats} rolls",
        "",
        f"{'':{width}}" + "".join(backend.rjust(11) for backend, _ in columns),
        f"{'microseconds a control step, with substeps':{width}}"
        + "".join(str(substeps).rjust(11) for _, substeps in columns),
    ]
    for stage in STAGES:
        label = f"{stage}: {EXPLAINED[stage]}"
        lines.append(row(label, ".0f", partial(_per_step, stage)))
    lines += [
        "(the compiled step assembles and solves in one call, counted as assembly)",
        "",
        row("control / physics", ".2f", lambda one: one.control / one.seconds["physics"]),
        row("real-time factor", ".1f", lambda one: SECONDS / one.total),
        row("  of physics alone", ".1f", lambda one: SECONDS / one.seconds["physics"]),
    ]
    return "\n".join(lines)


def _per_step(stage: str, one: Split) -> float:
    return 1e6 * one.seconds[stage] / one.steps


def roll(scenario: Scenario) -> Split:
    """Simulate `SECONDS` with a clock between the stages."""
    settings = scenario.controller.settings
    clock = TimedSolver(make_solver(settings.solver))
    timed = replace(scenario, controller=Controller(scenario.model, settings, clock))
    steps = round(SECONDS * settings.rate)
    mj, tasks = scenario.model.mj, scenario.behaviour.tasks
    buffer = TrajectoryBuffer.allocate(steps, mj.nq, mj.nv, mj.nu, 64, len(tasks), mj.nbody)
    taken = Split(steps)
    seconds = taken.seconds
    since = time.perf_counter()

    def mark(stage: str) -> None:
        nonlocal since
        now = time.perf_counter()
        seconds[STAGE_OF[stage]] += now - since
        since = now

    for i, moment in enumerate(islice(Episode(timed, mark), steps)):
        since = time.perf_counter()
        record(buffer, i, moment)
        mark("log")
    seconds["assembly"] -= clock.seconds
    seconds["solve"] += clock.seconds
    return taken
