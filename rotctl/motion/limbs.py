"""Where an arm or a leg can point, on a grid of its angles: starts that miss no pose."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array

LIMBS = tuple(f"{upper}_{side}" for upper in ("upper_arm", "thigh") for side in "lr")
LEVELS = (9, 7, 7, 6)  # of each joint's range, from the trunk on
STARTS = 8
APART = 0.6  # [rad] from one start to the next, in one of the angles at least
DOWN = np.array([0.0, 0.0, -1.0])  # along a segment, in its body's frame


@dataclass(frozen=True)
class Limb:
    """Two segments and the joints that point them.

    Attributes:
        parent: body of the trunk that it hangs on.
        bodies: upper and lower segment.
        motors: of their joints, k of them.
        angles: (g, k) of the grid [rad].
        pointing: (g, 2, 3) of both segments there, in the parent's frame.
    """

    parent: int
    bodies: tuple[int, int]
    motors: NDArray[np.int64]
    angles: Array
    pointing: Array

    def starts(self, wanted: Array, to_zero: float) -> list[Array]:
        """The angles (k,) whose directions are nearest to those wanted (2, 3), no two alike.

        Args:
            to_zero: [1/rad] weight of the angles themselves, which decides between equals.
        """
        missed = ((self.pointing - wanted) ** 2).sum(axis=(1, 2))
        missed = missed + to_zero**2 * (self.angles**2).sum(axis=1)
        found: list[Array] = []
        for _ in range(STARTS):
            found.append(self.angles[int(np.argmin(missed))])
            near = np.abs(self.angles - found[-1]).max(axis=1) < APART
            missed = np.where(near, np.inf, missed)
        return found


def limbs_of(mj: mujoco.MjModel, low: Array, high: Array) -> list[Limb]:
    """The limbs of a character whose joints have ranges `low` to `high` (nu,) [rad]."""
    found, data = [], mujoco.MjData(mj)
    for name in LIMBS:
        upper = mj.body(name).id
        lower = next(b for b in range(upper + 1, mj.nbody) if mj.body_parentid[b] == upper)
        dofs = [d for b in (upper, lower) for d in range(mj.nv) if mj.dof_bodyid[d] == b]
        motors = np.array(dofs) - 6
        levels = [
            np.linspace(low[m], high[m], count)
            for m, count in zip(motors, (*LEVELS, *LEVELS), strict=False)
        ]
        angles = np.stack(np.meshgrid(*levels, indexing="ij"), axis=-1).reshape(-1, len(motors))
        pointing = np.empty((len(angles), 2, 3))
        for place, row in zip(pointing, angles, strict=True):
            data.qpos[:] = mj.qpos0  # upright: the trunk's frames are the world's
            data.qpos[7 + motors] = row
            mujoco.mj_kinematics(mj, data)
            for segment, body in zip(place, (upper, lower), strict=True):
                segment[:] = data.xmat[body].reshape(3, 3) @ DOWN
        parent = int(mj.body_parentid[upper])
        found.append(Limb(parent, (upper, lower), motors, angles, pointing))
    return found
