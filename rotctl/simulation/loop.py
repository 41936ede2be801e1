"""A whole run: an episode of a given duration, recorded."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.log import TrajectoryBuffer
from rotctl.log.buffer import whole_letters
from rotctl.simulation.compiled_periods import compiled_periods
from rotctl.simulation.episode import Episode, Parts
from rotctl.simulation.record import record


@dataclass(frozen=True)
class Outcome:
    """How a simulation ended.

    Attributes:
        buffer: every control step whose state could be trusted.
        breakdown: what broke down, so that it ended early; empty if nothing did.
        left: where the character left the ground, so that it ended early; empty if it did not.
    """

    buffer: TrajectoryBuffer
    breakdown: str
    left: str = ""


Look = Callable[[TrajectoryBuffer, int], bool | None]


def nobody(buffer: TrajectoryBuffer, done: int) -> None:
    """Looks at nothing."""


def simulate(
    parts: Parts,
    duration: float,
    capacity: int,
    progress: Callable[[], object] = lambda: None,
    look: Look = nobody,
) -> Outcome:
    """Run one simulation.

    Args:
        duration: simulated time [s], a whole number of control periods.
        capacity: contacts a log row can hold.
        progress: called after every control step.
        look: called after every control step with the rows and how many of them are written;
            True ends the run there, as nothing broke.

    Raises:
        InputError: the duration is no whole number of control periods, or the start is beside the
            ground.
    """
    mj, rate = parts.model.mj, parts.controller.settings.rate
    steps = round(duration * rate)
    if abs(steps - duration * rate) > 1e-6 or steps < 1:
        raise InputError(
            f"duration={duration:g} s is no whole number of control steps of 1/{rate:g} s; "
            f"nearest: {max(1, steps) / rate:.10g}"
        )
    tasks = parts.behaviour.tasks
    buffer = TrajectoryBuffer.allocate(steps, mj.nq, mj.nv, mj.nu, capacity, len(tasks), mj.nbody)
    _name(buffer.model.body, [mj.body(i).name for i in range(mj.nbody)])
    _name(buffer.model.task, list(tasks))
    _name(buffer.model.joint, parts.model.joint_names)
    buffer.model.torque_limit[:] = parts.model.torque_limit
    episode = Episode(parts)
    compiled = compiled_periods(parts, episode, buffer)
    for i in range(steps):
        if compiled is not None and compiled.make(i):
            events: tuple[str, ...] = (compiled.remark,)
        else:
            moment = episode.step()
            if moment is None:
                buffer.add_event(i / rate, episode.breakdown or episode.left)
                return Outcome(buffer.trimmed(i), episode.breakdown, episode.left)
            record(buffer, i, moment)
            events = (*moment.decision.reasons[-1:], moment.remark)
            if compiled is not None:
                compiled.follow(moment)
        for event in filter(None, events):
            buffer.add_event(buffer.trajectory.time[i], event)
        progress()
        if look(buffer, i + 1):
            steps = i + 1
            break
    if missed := parts.disturbance.awaited(steps / rate):
        buffer.add_event(buffer.trajectory.time[steps - 1], f"to the end it never came: {missed}")
    return Outcome(buffer.trimmed(steps), parts.stepper.complaint(episode.data))


def _name(column: NDArray[Any], names: Iterable[str]) -> None:
    """Write names into a log's column, as long as it has room for."""
    column[:] = [whole_letters(name, column.dtype.itemsize) for name in names]
