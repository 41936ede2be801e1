"""A compiled model with the indices control needs, and joints by their names.

The character's bodies and degrees of freedom come first. After them come those of loose
things on the ground, if there are any. MuJoCo's arrays are of the whole world; its mass matrix
is block diagonal in the two, so that control can work on full vectors and leave the rest at 0.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import ROOT_BODY, SIDES
from rotctl.mechanics.terrain import Ground
from rotctl.suggestion import instead

ROOT_DOFS = 6


@dataclass(frozen=True)
class Model:
    """A compiled model and the numbers around it that do not change during a run.

    Attributes:
        mj: the MuJoCo model.
        mjcf: the self-contained text that it was compiled from.
        joint_names: actuated joints in motor order.
        joints: the actuated joints' degrees of freedom, in motor order.
        angles: their entries in `qpos`.
        joint_range: (nu, 2) [rad].
        torque_limit: (nu,) [N m].
        armature: (nu,) of the motors, and what the physics adds for damping [kg m2].
        diagonal: (nv,) addresses of the mass matrix's diagonal in `data.M`.
        mass: of the character [kg].
        gravity: (3,) [m/s2].
        trunk: body ids whose axes, averaged, are compared with the rolling axis.
        trunk_weights: (len(trunk), 1) their shares of the trunk's mass.
        excluded: (nbody,) True where a body's contacts are held out of control.
        touch: control sees the contacts whose gap is below this [m],
        look_ahead: and those that would close within this time [s]; 0 where it does not look.
        ground: what it stands on.
        absent: joints that this character has not, and poses may name all the same.
    """

    mj: mujoco.MjModel
    mjcf: str
    joint_names: tuple[str, ...]
    joints: slice
    angles: slice
    joint_range: Array
    torque_limit: Array
    armature: Array
    diagonal: NDArray[np.int64]
    mass: float
    gravity: Array
    trunk: NDArray[np.int64]
    trunk_weights: Array
    excluded: NDArray[np.bool_]
    touch: float
    look_ahead: float
    ground: Ground
    absent: tuple[str, ...] = ()

    def hinges(self, body: int) -> tuple[int, int]:
        """First motor of a body's own joints, and how many it has; none of the root."""
        return self._hinges[body]

    @cached_property
    def _hinges(self) -> list[tuple[int, int]]:
        """Of all bodies."""
        firsts = (self.mj.body_dofadr - self.joints.start).tolist()
        found = list(zip(firsts, self.mj.body_dofnum.tolist(), strict=True))
        return [(0, 0)] * (ROOT_BODY + 1) + found[ROOT_BODY + 1 :]

    def motors(self, joint: str, key: str) -> list[int]:
        """Motors of a joint's name; one without a side stands for both.

        Raises:
            InputError: there is no such joint; `key` says where it stands.
        """
        named = (joint, *(joint + side for side in SIDES))
        motors = [i for i, name in enumerate(self.joint_names) if name in named]
        if not motors and _bare(joint) in self.absent:
            return []
        if not motors:
            left, right = SIDES
            bases = sorted(set(map(_bare, self.joint_names)))
            raise InputError(
                f"{key} names the unknown joint {joint!r}; {instead(joint, bases)}, "
                f"limb joints also with {left} or {right}"
            )
        return motors

    def bending(self, joint: str, key: str) -> list[int]:
        """Motors that bend as a joint does: its own, or a waist's for a chest that is not there.

        Raises:
            InputError: there is no such joint; `key` says where it stands.
        """
        motors = self.motors(joint, key)
        group, _, axis = joint.partition("_")
        if motors or group != "chest":
            return motors
        return [i for i, name in enumerate(self.joint_names) if name == f"waist_{axis}"]

    def posed(self, angles: Mapping[str, float | Sequence[float]], key: str, rows: int) -> Array:
        """Angles by joint name as rows (rows, nu) in motor order; joints not named are at 0.

        What a chest would bend that this character has not, its waist bends beside its own.

        Raises:
            InputError: there is no such joint; `key` says where it stands.
        """
        found = np.zeros((rows, len(self.joint_names)))
        absent = [name for name in angles if not self.motors(name, key)]
        for name in angles:
            found[:, self.motors(name, key)] = np.asarray(angles[name]).reshape(-1, 1)
        for name in absent:
            found[:, self.bending(name, key)] += np.asarray(angles[name]).reshape(-1, 1)
        return found


def _bare(joint: str) -> str:
    """A joint's name without its side."""
    return joint.removesuffix(SIDES[0]).removesuffix(SIDES[1])
