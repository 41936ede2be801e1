"""What the ground does to the character over one control period: mean and peak forces.

A control period is several physics steps, in which contacts come and go. The forces of each step
are added to the contacts that the controller saw at the begin of the period, each to the nearest
one of the same body. A body that had none then gets a slot of its own where it first touches, so
that the mean forces always sum up to the momentum that the ground gave.
"""

import ctypes
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.errors import RotctlError
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts, read_contacts, realised_forces
from rotctl.native import library
from rotctl.native.layout import constant, structure

SLOTS = constant("SLOTS")  # what a log row can hold at most


class GroundForces(NamedTuple):
    """Forces on the character, world axes; loose things on the ground count as ground.

    Attributes:
        body: (k,) MuJoCo ids; first the contacts that the period began with, in their order,
            then those that came within it.
        position: (k, 3) where each began [m].
        normal: (k, 3) out of the ground, unit vectors.
        mean: (k, 3) mean over the period [N].
        peak: (k,) largest magnitude in a physics step [N].
        total: (3,) mean of the sum over all contacts [N].
        total_peak: largest magnitude of that sum in a physics step [N].
        penetration: deepest overlap of character and ground in a physics step [m].
    """

    body: NDArray[np.int32]
    position: Array
    normal: Array
    mean: Array
    peak: Array
    total: Array
    total_peak: float
    penetration: float


class Sums(Protocol):
    """Adds up the forces of one control period after the other."""

    def begin(self, contacts: Contacts) -> None:
        """A control period begins with these contacts."""
        ...

    def add(self, data: mujoco.MjData) -> None:
        """A physics step has been made; its contacts and forces are still in `data`."""
        ...

    def result(self) -> GroundForces:
        """Of the physics steps since `begin`; at least one."""
        ...


def ground_forces(mj: mujoco.MjModel) -> Sums:
    """The compiled sums where they are built, else their reference."""
    return Compiled(mj) if library() else Reference(mj)


class Reference:
    """`Sums` in numpy."""

    def __init__(self, mj: mujoco.MjModel) -> None:
        """For the first tree of `mj` as the character."""
        self._mj = mj

    def begin(self, contacts: Contacts) -> None:
        """See `Sums`."""
        self._body = contacts.body[:SLOTS].tolist()
        self._position = list(contacts.position[:SLOTS])
        self._normal = list(contacts.frame[:SLOTS, 0])
        self._force = [np.zeros(3) for _ in self._body]
        self._peak = [0.0 for _ in self._body]
        self._total, self._total_peak, self._penetration, self._steps = np.zeros(3), 0.0, 0.0, 0

    def add(self, data: mujoco.MjData) -> None:
        """See `Sums`."""
        contacts = read_contacts(self._mj, data, touch=np.inf)
        forces = realised_forces(self._mj, data, contacts)
        now: dict[int, Array] = {}
        for i in np.flatnonzero(forces.any(axis=1)):
            slot = self._slot(int(contacts.body[i]), contacts.position[i], contacts.frame[i, 0])
            if slot is not None:
                now[slot] = now.get(slot, np.zeros(3)) + forces[i]
        for slot, force in now.items():
            self._force[slot] += force
            self._peak[slot] = max(self._peak[slot], _length(force))
        total = forces.sum(axis=0)
        self._total += total
        self._total_peak = max(self._total_peak, _length(total))
        self._penetration = max(self._penetration, float(-contacts.gap.min(initial=0.0)))
        self._steps += 1

    def _slot(self, body: int, position: Array, normal: Array) -> int | None:
        """The nearest slot of that body; a new one if it has none; None if there is no room."""
        same = [i for i, other in enumerate(self._body) if other == body]
        if same:
            return min(same, key=lambda i: _length(self._position[i] - position))
        if len(self._body) == SLOTS:
            return None
        self._body.append(body)
        self._position.append(position)
        self._normal.append(normal)
        self._force.append(np.zeros(3))
        self._peak.append(0.0)
        return len(self._body) - 1

    def result(self) -> GroundForces:
        """See `Sums`."""
        return GroundForces(
            body=np.array(self._body, dtype=np.int32),
            position=np.array(self._position).reshape(-1, 3),
            normal=np.array(self._normal).reshape(-1, 3),
            mean=np.array(self._force).reshape(-1, 3) / self._steps,
            peak=np.array(self._peak),
            total=self._total / self._steps,
            total_peak=self._total_peak,
            penetration=self._penetration,
        )


def _length(vector: Array) -> float:
    return float(np.sqrt((vector**2).sum()))


class Compiled:
    """`Sums` in C; `library()` must be there."""

    def __init__(self, mj: mujoco.MjModel) -> None:
        """For the first tree of `mj` as the character."""
        self._add = _function()
        self._mj = mj  # keeps what the address points to
        self._sums = structure("Sums")()
        self._model, self._address = mj._address, ctypes.addressof(self._sums)
        view = {
            name: np.ctypeslib.as_array(getattr(self._sums, name))
            for name in ("position", "normal", "force", "now", "peak", "total", "body")
        }
        self._body, self._peak, self._total = view["body"], view["peak"], view["total"]
        self._position, self._normal = view["position"], view["normal"]
        self._force, self._now = view["force"], view["now"]
        self._steps = 0

    def begin(self, contacts: Contacts) -> None:
        """See `Sums`."""
        m = self._sums.count = min(len(contacts.body), SLOTS)
        self._body[:m] = contacts.body[:m]
        self._position[:m] = contacts.position[:m]
        self._normal[:m] = contacts.frame[:m, 0]
        for zeroed in (self._force, self._now, self._peak):
            zeroed[:m] = 0.0
        self._total[:] = 0.0
        self._sums.total_peak = self._sums.penetration = 0.0
        self._steps = 0

    def add(self, data: mujoco.MjData) -> None:
        """See `Sums`."""
        self._add(self._model, data._address, self._address)
        self._steps += 1

    def result(self) -> GroundForces:
        """See `Sums`."""
        k, n = self._sums.count, self._steps
        return GroundForces(
            body=self._body[:k].copy(),
            position=self._position[:k].copy(),
            normal=self._normal[:k].copy(),
            mean=self._force[:k] / n,
            peak=self._peak[:k].copy(),
            total=self._total / n,
            total_peak=self._sums.total_peak,
            penetration=self._sums.penetration,
        )


@lru_cache(maxsize=1)
def _function() -> Callable[[int, int, int], None]:
    built = library()
    if built is None:
        raise RotctlError("the compiled sums of ground forces are not built")
    function: Callable[[int, int, int], None] = built.rotctl_ground_add
    function.argtypes, function.restype = [ctypes.c_void_p] * 3, None  # type: ignore[attr-defined]
    return function
