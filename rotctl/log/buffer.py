"""Preallocated memory for one run: the loop writes rows, the writer takes the arrays.

A schema path becomes an attribute by turning its slash into a dot, so that names of different
groups cannot collide::

    buffer.trajectory.qpos[i] = data.qpos
    buffer.contacts.position[i, slot] = contact.pos
    buffer.solver.status[i] = 0
"""

from dataclasses import dataclass, field
from math import prod
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.log.rows import (
    CommandRows,
    ContactRows,
    DisturbanceRows,
    ModelEntries,
    SolverRows,
    TrajectoryRows,
)
from rotctl.log.schema import CONSTANTS, EVENT_BYTES, MAX_TOTAL_BYTES, SCHEMA, DatasetSpec

_ALLOCATED = {
    name: spec for name, spec in SCHEMA.items() if spec.shape and "events" not in spec.shape
}
# A run asks several times for all arrays: what their names have in common is worked out once.
_PARTS = {name: name.partition("/")[::2] for name in _ALLOCATED}
_PER_STEP = {name: leaf for name, (_, leaf) in _PARTS.items() if "steps" in SCHEMA[name].shape}
_all_of = attrgetter(*[name.replace("/", ".") for name in _ALLOCATED])


@dataclass(frozen=True)
class TrajectoryBuffer:
    """The rows of one run.

    Attributes:
        trajectory, command, contacts, disturbance, solver, model: arrays of the groups of that
            name, one attribute each.
        events: (time [s], text) in the order of their arrival.
    """

    trajectory: TrajectoryRows
    command: CommandRows
    contacts: ContactRows
    disturbance: DisturbanceRows
    solver: SolverRows
    model: ModelEntries
    events: list[tuple[float, str]] = field(default_factory=list)

    @classmethod
    def allocate(
        cls, steps: int, nq: int, nv: int, nu: int, capacity: int, tasks: int, bodies: int
    ) -> "TrajectoryBuffer":
        """Allocates every array whose size is known before the run.

        Args:
            steps: number of control steps.
            nq: size of ``qpos``.
            nv: size of ``qvel``.
            nu: size of ``ctrl``.
            capacity: recorded contacts a step.
            tasks: of the behaviour.
            bodies: of the model.

        Raises:
            InputError: a size is negative, or the log would be larger than a reader accepts.
        """
        sizes = {
            "steps": steps,
            "nq": nq,
            "nv": nv,
            "nu": nu,
            "capacity": capacity,
            "tasks": tasks,
            "bodies": bodies,
        }
        for name, size in sizes.items():
            if size < 0:
                raise InputError(f"{name} must be >= 0, got {size}")
        shapes = {name: _shape(spec, sizes) for name, spec in _ALLOCATED.items()}
        total = sum(
            np.dtype(spec.dtype).itemsize * prod(shapes[name]) for name, spec in _ALLOCATED.items()
        )
        if total > MAX_TOTAL_BYTES:
            raise InputError(
                f"{steps} steps with room for {capacity} contacts need {total / 2**30:.1f} GiB, "
                f"a log holds {MAX_TOTAL_BYTES / 2**30:g} GiB: choose a shorter run or a smaller "
                "capacity"
            )
        return _from_arrays({name: _allocate(name, shape) for name, shape in shapes.items()}, [])

    @property
    def steps(self) -> int:
        """Number of rows."""
        return len(self.trajectory.time)

    def add_event(self, time: float, text: str) -> None:
        """Notes that something happened.

        Args:
            time: simulated time [s].
            text: what happened; longer text is cut at 200 bytes of UTF-8.
        """
        self.events.append((float(time), text))

    def trimmed(self, steps: int) -> "TrajectoryBuffer":
        """Returns the first ``steps`` rows (views, not copies) and all events.

        Raises:
            InputError: there are not that many rows.
        """
        if not 0 <= steps <= self.steps:
            raise InputError(f"steps must be between 0 and {self.steps}, got {steps}")
        rows = {
            name: array[:steps] if name in _PER_STEP else array
            for name, array in self._allocated().items()
        }
        return _from_arrays(rows, list(self.events))

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Returns schema path -> array in schema order; the model's text is not ours."""
        times = np.array([time for time, _ in self.events], dtype=SCHEMA["events/time"].dtype)
        texts = np.array(
            [whole_letters(text, EVENT_BYTES) for _, text in self.events],
            dtype=SCHEMA["events/text"].dtype,
        )
        arrays = {**self._allocated(), "events/time": times, "events/text": texts}
        return {name: arrays[name] for name in SCHEMA if name in arrays}

    def per_step(self) -> dict[str, NDArray[Any]]:
        """Returns the arrays of one row a control step, by the last part of their paths."""
        arrays = self._allocated()
        return {leaf: arrays[name] for name, leaf in _PER_STEP.items()}

    def _allocated(self) -> dict[str, NDArray[Any]]:
        return dict(zip(_ALLOCATED, _all_of(self), strict=True))


def _allocate(name: str, shape: list[int]) -> NDArray[Any]:
    spec = _ALLOCATED[name]
    if not spec.fill:  # memory of long runs that nobody has touched yet costs nothing
        return np.zeros(shape, dtype=spec.dtype)
    return np.full(shape, spec.fill, dtype=spec.dtype)


def _shape(spec: DatasetSpec, sizes: dict[str, int]) -> list[int]:
    return [CONSTANTS[dim] if dim in CONSTANTS else sizes[dim] for dim in spec.shape]


def _from_arrays(
    arrays: dict[str, NDArray[Any]], events: list[tuple[float, str]]
) -> TrajectoryBuffer:
    members: dict[str, dict[str, NDArray[Any]]] = {}
    for name, array in arrays.items():
        group, leaf = _PARTS[name]
        members.setdefault(group, {})[leaf] = array
    return TrajectoryBuffer(
        trajectory=TrajectoryRows(**members["trajectory"]),
        command=CommandRows(**members["command"]),
        contacts=ContactRows(**members["contacts"]),
        disturbance=DisturbanceRows(**members["disturbance"]),
        solver=SolverRows(**members["solver"]),
        model=ModelEntries(**members["model"]),
        events=events,
    )


def whole_letters(text: str, size: int) -> bytes:
    """As much of the beginning of a text, in UTF-8, as has room in some bytes."""
    return text.encode("utf-8", "replace")[:size].decode("utf-8", "ignore").encode()
