"""States of a real forward roll, to be decided upon again and again."""

from dataclasses import dataclass
from itertools import islice

import mujoco

from rotctl.control import Command
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.runs.scenario import Scenario
from rotctl.simulation.episode import Episode


@dataclass(frozen=True)
class Recorded:
    """One control step's question: a state, a behaviour's wishes and the blend before."""

    position: Array
    velocity: Array
    command: Command
    blend: float


def record_roll(scenario: Scenario, steps: int) -> list[Recorded]:
    """Simulate `steps` control steps and keep what the controller was asked."""
    return [
        Recorded(m.state.position, m.state.velocity, m.command.copy(), m.blend)
        for m in islice(Episode(scenario), steps)
    ]


def restore(model: Model, data: mujoco.MjData, recorded: Recorded) -> None:
    """Put a recorded state into `data`, evaluated."""
    data.qpos[:] = recorded.position
    data.qvel[:] = recorded.velocity
    mujoco.mj_step1(model.mj, data)
