"""The whole loop, as a run goes through it, beside the physics alone: the limit of any control.

The physics alone is MuJoCo's own `rollout` of the torques that the run logged.
"""

import time
from dataclasses import dataclass
from statistics import median

import mujoco
import numpy as np
from mujoco import rollout

from rotctl.config.loading import load
from rotctl.log import TrajectoryBuffer
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.runs.scenario import build
from rotctl.simulation.loop import simulate

RUNS = {
    "forward_roll_1, 1 substep": ("physics.substeps=1",),
    "forward_roll_1, 4 substeps": (),
    "forward_roll, which keeps a pace": ("behaviour=forward_roll",),
    "uneven_terrain, hills": ("behaviour=uneven_terrain",),
    "back_flip, made of stages": ("behaviour=back_flip", "duration=3"),
}
FULL = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)


@dataclass(frozen=True)
class Taken:
    """Microseconds of CPU a control step: of all, and of its physics steps alone."""

    whole: float
    physics: float
    period: float


def table(repeats: int) -> str:
    """Medians over `repeats` of each run, in turn."""
    found: dict[str, list[Taken]] = {name: [] for name in RUNS}
    for _ in range(repeats):
        for name, overrides in RUNS.items():
            found[name].append(_time(overrides))
    lines = [
        "microseconds of CPU a control step, 20 s at seed 0; a flip has four in the time of one",
        "",
        f"{'':34}{'whole':>8}{'physics':>9}{'control':>9}{'':3}real-time factor",
        f"{'':34}{'loop':>8}{'alone':>9}{'and log':>9}{'whole':>10}{'physics':>9}",
    ]
    for name, times in found.items():
        whole, physics = (median(getattr(t, part) for t in times) for part in ("whole", "physics"))
        period = 1e6 * times[0].period
        lines.append(
            f"{name:34}{whole:8.0f}{physics:9.0f}{whole - physics:9.0f}"
            f"{period / whole:10.0f}{period / physics:9.0f}"
        )
    return "\n".join(lines)


def _time(overrides: tuple[str, ...]) -> Taken:
    scenario = build(load(["seed=0", *overrides]))
    begin = time.process_time()
    capacity = scenario.config.physics.contact_capacity
    buffer = simulate(scenario, scenario.config.duration, capacity).buffer
    whole = time.process_time() - begin
    per_step = 1e6 / buffer.steps
    physics = _physics(scenario.model, buffer, scenario.config.physics.substeps)
    period = 1.0 / scenario.config.controller.rate
    return Taken(per_step * whole, per_step * physics, period)


def _physics(model: Model, buffer: TrajectoryBuffer, substeps: int) -> float:
    """CPU time of the logged torques in the physics alone [s]."""
    mj, rows = model.mj, buffer.trajectory
    data = mujoco.MjData(mj)
    data.qpos[:], data.qvel[:] = rows.qpos[0], rows.qvel[0]
    start: Array = np.empty(mujoco.mj_stateSize(mj, FULL))
    mujoco.mj_getState(mj, data, start, FULL)
    torques = np.repeat(rows.ctrl, substeps, axis=0)
    begin = time.process_time()
    rollout.rollout(mj, data, start, torques)
    return time.process_time() - begin
