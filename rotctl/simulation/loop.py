"""The simulation loop: read, decide, record, step, sixty times a second."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import mujoco

from rotctl.control import Controller, Decision, Desired
from rotctl.errors import InputError
from rotctl.log import TrajectoryBuffer
from rotctl.mechanics.excursion import Excursion
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.rotations import Array
from rotctl.simulation.ground_forces import GroundForces
from rotctl.simulation.start import Start, place
from rotctl.simulation.stepping import Stepper

INITIAL_BLEND = 0.5  # gamma before the first decision: no preference


class Behaviour(Protocol):
    """What the loop asks of a behaviour; see `rotctl.behaviours.rolling` for one."""

    @property
    def orientation(self) -> Array:
        """Of the trunk at phase 0 on level ground (4,), unit quaternion."""
        ...

    def trunk_axis(self, state: State) -> Array:
        """The trunk's axis (3,) that should stay on the axis of rotation, unit, world."""
        ...

    def pose(self, phase: float) -> Array:
        """Pose (nu,) [rad] to start in."""
        ...

    def begin(self, phase: float) -> Excursion:
        """Excursion at the start."""
        ...

    def advance(self, before: Excursion, state: State) -> Excursion:
        """Excursion now."""
        ...

    def phase(self, now: Excursion) -> float:
        """Phase angle [rad]."""
        ...

    def desired(self, state: State, now: Excursion) -> Desired:
        """Wishes at this instant."""
        ...


@dataclass(frozen=True)
class Outcome:
    """How a simulation ended.

    Attributes:
        buffer: every control step whose state could be trusted.
        breakdown: why it ended early; empty if it ran to its end.
        last_fallback: the last reason a solver gave for failing; empty if none did.
    """

    buffer: TrajectoryBuffer
    breakdown: str
    last_fallback: str


def simulate(
    model: Model,
    behaviour: Behaviour,
    controller: Controller,
    stepper: Stepper,
    start: Start,
    duration: float,
    capacity: int,
    progress: Callable[[], object] = lambda: None,
    stop: Callable[[State, Excursion], bool] = lambda state, now: False,
) -> Outcome:
    """Run one simulation.

    Args:
        duration: simulated time [s], a whole number of control periods.
        capacity: contacts a log row can hold.
        progress: called after every control step.
        stop: asked after every control step; True ends the run there, as nothing broke.

    Raises:
        InputError: the duration is no whole number of control periods.
    """
    mj, rate = model.mj, controller.settings.rate
    steps = round(duration * rate)
    if abs(steps - duration * rate) > 1e-6 or steps < 1:
        raise InputError(
            f"duration={duration:g} s is no whole number of control steps of 1/{rate:g} s; "
            f"nearest: {max(1, steps) / rate:.10g}"
        )
    data = mujoco.MjData(mj)
    place(model, data, start, behaviour.orientation, behaviour.pose(start.pitch))
    buffer = TrajectoryBuffer.allocate(steps, mj.nq, mj.nv, mj.nu, capacity)
    buffer.model.joint[:] = model.joint_names
    buffer.model.torque_limit[:] = model.torque_limit
    now = behaviour.begin(start.pitch)
    blend, last_fallback = INITIAL_BLEND, ""
    for i in range(steps):
        stepper.evaluate(data)
        complaint = stepper.complaint(data)
        if complaint:
            buffer.add_event(i / rate, complaint)
            return Outcome(buffer.trimmed(i), complaint, last_fallback)
        state = controller.read(data)
        now = behaviour.advance(now, state)
        decision = controller.decide(state, behaviour.desired(state, now), blend)
        blend = decision.blend
        if decision.reasons:
            last_fallback = decision.reasons[-1]
            buffer.add_event(state.time, last_fallback)
        forces = stepper.advance(data, decision.torque, state.contacts)
        x, y, _ = state.momentum.com.tolist()
        record(buffer, i, state, now, behaviour, decision, forces, model.ground.height(x, y))
        progress()
        remark = stepper.remark()
        if remark:
            buffer.add_event(state.time, remark)
        if stop(state, now):
            buffer = buffer.trimmed(i + 1)
            break
    return Outcome(buffer, stepper.complaint(data), last_fallback)


def record(
    buffer: TrajectoryBuffer,
    i: int,
    state: State,
    now: Excursion,
    behaviour: Behaviour,
    decision: Decision,
    forces: GroundForces,
    ground_height: float,
) -> None:
    """Write row `i` of the log.

    Args:
        forces: what the physics gave in this control step.
        ground_height: below the centre of mass [m].
    """
    trajectory, momentum = buffer.trajectory, state.momentum
    trajectory.time[i] = state.time
    trajectory.qpos[i] = state.position
    trajectory.qvel[i] = state.velocity
    trajectory.ctrl[i] = decision.torque
    trajectory.com[i] = momentum.com
    trajectory.ground_height[i] = ground_height
    trajectory.com_velocity[i] = momentum.com_velocity
    trajectory.linear_momentum[i] = momentum.linear
    trajectory.angular_momentum[i] = momentum.angular
    trajectory.angular_velocity[i] = momentum.angular_velocity
    trajectory.angular_excursion[i] = now.angle
    trajectory.linear_momentum_rate_desired[i] = decision.rates_wanted[:3]
    trajectory.angular_momentum_rate_desired[i] = decision.rates_wanted[3:]
    trajectory.linear_momentum_rate_predicted[i] = decision.rates_predicted[:3]
    trajectory.angular_momentum_rate_predicted[i] = decision.rates_predicted[3:]
    trajectory.blend[i] = decision.blend
    trajectory.phase[i] = behaviour.phase(now)
    trajectory.trunk_axis[i] = behaviour.trunk_axis(state)
    contacts, capacity = buffer.contacts, buffer.contacts.body.shape[1]
    m, k = min(state.contacts.count, capacity), min(len(forces.body), capacity)
    contacts.count[i] = state.contacts.count
    contacts.body[i, :k] = forces.body[:k]
    contacts.position[i, :k] = forces.position[:k]
    contacts.normal[i, :k] = forces.normal[:k]
    contacts.force_predicted[i, :m] = decision.force[:m]
    contacts.force_realised[i, :k] = forces.mean[:k]
    contacts.force_peak[i, :k] = forces.peak[:k]
    contacts.used[i, :m] = decision.used[:m]
    contacts.ground_force[i] = forces.total
    contacts.ground_force_peak[i] = forces.total_peak
    contacts.penetration[i] = forces.penetration
    solver = buffer.solver
    solver.status[i] = decision.status
    solver.iterations[i] = decision.iterations
    solver.residual[i] = decision.residual
    solver.fallback[i] = decision.fallback
