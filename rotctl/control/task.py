"""What a behaviour wants of one control step: tasks, two poses, and how they are pursued."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rotctl.control.settings import ContactGains, PoseGains, TaskGains
from rotctl.control.supervisor import SupervisorName, Thresholds
from rotctl.maths.rotations import Array
from rotctl.mechanics.state import State

# One task: an objective over the acceleration. Mirrored by `Task` in native/layout.h.
TASK = np.dtype(
    [
        ("kind", "<i4"),  # place in `rotctl.control.kinds.KINDS`
        ("body", "<i4"),  # MuJoCo id, where the kind is about one body
        ("axes", "<f8", (3, 3)),  # rows: directions it acts along, unit, world
        ("point", "<f8", 3),  # [m] in the body's frame
        ("target", "<f8", 4),  # a place [m], a missing rotation [rad] or an orientation
        ("velocity", "<f8", 3),  # [m/s, rad/s] world
        ("acceleration", "<f8", 3),  # [m/s2, rad/s2] world
        ("stiffness", "<f8", 3),  # [1/s2] along `axes`
        ("damping", "<f8", 3),  # [1/s]
        ("weight", "<f8", 3),  # see the kind for its unit
    ],
    align=True,
)

Tasks = NDArray[np.void]


class Command(NamedTuple):
    """A behaviour's wishes at one instant.

    Attributes:
        tasks: (k,) of dtype TASK; only rows of non-zero weight count.
        pose_a, pose_b: (nu,) the two poses r_a and r_b of eq. 7 [rad].
        forward: (3,) the friction pyramids' edges lie along it, unit, world.
        pose: how the poses are tracked.
        contact: how contacts are held.
        supervisor, thresholds: which contacts may be used.
        held_out: (nbody,) True where a body's contacts may not be used.
        behind: (nbody,) contacts that lie further back along their body's own x may not be used,
            either [m]; None where all may.
        slots: places of these tasks among the behaviour's, in the log; None where they are all.
    """

    tasks: Tasks
    pose_a: Array
    pose_b: Array
    forward: Array
    pose: PoseGains
    contact: ContactGains
    supervisor: SupervisorName
    thresholds: Thresholds
    held_out: NDArray[np.bool_]
    behind: Array | None = None
    slots: list[int] | None = None

    def candidates(self, state: State) -> NDArray[np.bool_]:
        """Contacts of a state (m,) that may be used."""
        body, data = state.contacts.body, state.data
        may = ~self.held_out[body]
        if self.behind is not None:
            front = data.xmat[body].reshape(-1, 3, 3)[:, :, 0]
            x, y, z = ((state.contacts.position - data.xpos[body]) * front).T
            may &= x + y + z >= self.behind[body]
        return may

    def copy(self) -> "Command":
        """One that later steps of the behaviour leave alone."""
        return self._replace(
            tasks=self.tasks.copy(),
            pose_a=self.pose_a.copy(),
            pose_b=self.pose_b.copy(),
            forward=self.forward.copy(),
        )


def task(
    kind: int, gains: TaskGains, axes: Array, body: int = 0, point: tuple[float, ...] = (0, 0, 0)
) -> Tasks:
    """One task (1,) with its gains; targets and velocities are zero so far.

    Args:
        axes: (3, 3) rows are the directions that the gains are meant along.
        body: MuJoCo id.
        point: [m] in the body's frame.
    """
    made = np.zeros(1, TASK)
    made["kind"], made["body"], made["axes"], made["point"] = kind, body, axes, point
    made["stiffness"], made["damping"] = gains.stiffness, gains.damping
    made["weight"] = gains.weight
    return made
