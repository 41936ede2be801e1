"""One control step as a row of the log."""

from rotctl.log import TrajectoryBuffer
from rotctl.simulation.episode import Moment


def record(buffer: TrajectoryBuffer, i: int, moment: Moment) -> None:
    """Write row `i` of the log."""
    truth, command, signals = moment.truth, moment.command, moment.signals
    decision, forces = moment.decision, moment.forces
    trajectory, momentum = buffer.trajectory, truth.momentum
    trajectory.time[i] = truth.time
    trajectory.qpos[i] = truth.position
    trajectory.qvel[i] = truth.velocity
    trajectory.ctrl[i] = moment.torque
    trajectory.com[i] = momentum.com
    trajectory.ground_height[i] = moment.ground_height
    trajectory.com_velocity[i] = momentum.com_velocity
    trajectory.linear_momentum[i] = momentum.linear
    trajectory.angular_momentum[i] = momentum.angular
    trajectory.angular_velocity[i] = momentum.angular_velocity
    trajectory.angular_excursion[i] = signals.angle
    trajectory.linear_momentum_rate_desired[i] = decision.rates_wanted[:3]
    trajectory.angular_momentum_rate_desired[i] = decision.rates_wanted[3:]
    trajectory.linear_momentum_rate_predicted[i] = decision.rates_predicted[:3]
    trajectory.angular_momentum_rate_predicted[i] = decision.rates_predicted[3:]
    trajectory.blend[i] = decision.blend
    trajectory.phase[i] = signals.phase
    trajectory.trunk_axis[i] = signals.axis
    trajectory.trunk_axes[i] = truth.trunk_axes
    commanded = buffer.command
    commanded.axes[i] = signals.axes
    commanded.stage[i] = signals.stage
    slots = slice(None) if command.slots is None else command.slots
    commanded.target[i, slots] = command.tasks["target"]
    commanded.velocity[i, slots] = command.tasks["velocity"]
    commanded.error[i, slots] = decision.error
    commanded.wanted[i, slots] = decision.wanted
    commanded.predicted[i, slots] = decision.predicted
    seen = moment.state.contacts.count
    contacts, capacity = buffer.contacts, buffer.contacts.body.shape[1]
    m, k = min(seen, capacity), min(len(forces.body), capacity)
    contacts.count[i] = seen
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
    buffer.disturbance.wrench[i] = moment.wrench
    solver = buffer.solver
    solver.status[i] = decision.status
    solver.iterations[i] = decision.iterations
    solver.residual[i] = decision.residual
    solver.fallback[i] = decision.fallback
