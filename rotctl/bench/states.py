"""States of a real forward roll, to be decided upon again and again."""

from dataclasses import dataclass

import mujoco

from rotctl.control import Desired
from rotctl.mechanics.model import Model
from rotctl.rotations import Array
from rotctl.scenario import Scenario
from rotctl.simulation.loop import INITIAL_BLEND
from rotctl.simulation.start import place


@dataclass(frozen=True)
class Recorded:
    """One control step's question: a state, a behaviour's wishes and the blend before."""

    position: Array
    velocity: Array
    desired: Desired
    blend: float


def record_roll(scenario: Scenario, steps: int) -> list[Recorded]:
    """Simulate `steps` control steps and keep what the controller was asked."""
    model, behaviour, controller = scenario.model, scenario.behaviour, scenario.controller
    data = mujoco.MjData(model.mj)
    place(model, data, scenario.start, behaviour.orientation, behaviour.pose(scenario.start.pitch))
    now, blend = behaviour.begin(scenario.start.pitch), INITIAL_BLEND
    recorded = []
    for _ in range(steps):
        scenario.stepper.evaluate(data)
        state = controller.read(data)
        now = behaviour.advance(now, state)
        desired = behaviour.desired(state, now)
        kept = Desired(
            com=desired.com.copy(),
            com_velocity=desired.com_velocity,
            excursion_error=desired.excursion_error,
            angular_velocity=desired.angular_velocity,
            pose_a=desired.pose_a,
            pose_b=desired.pose_b,
        )
        recorded.append(Recorded(data.qpos.copy(), data.qvel.copy(), kept, blend))
        decision = controller.decide(state, desired, blend)
        blend = decision.blend
        scenario.stepper.advance(data, decision.torque, state.contacts)
    return recorded


def restore(model: Model, data: mujoco.MjData, recorded: Recorded) -> None:
    """Put a recorded state into `data`, evaluated."""
    data.qpos[:] = recorded.position
    data.qvel[:] = recorded.velocity
    mujoco.mj_step1(model.mj, data)
