"""Torques that track a pose, [Brown2013] eq. 6, in the stable form of [Tan2011].

Eq. 6 with the composite inertia M_jj as I and gains fit for rolling is unstable when its
torque is held for 1/60 s: the largest eigenvalue of M^-1 diag(M) is about 100. The stable
form asks for the same spring and damper at the *end* of the control period, with the
acceleration predicted from the dynamics without contact. It stays linear in the pose, so
the blend of eq. 7 keeps its meaning.
"""

import mujoco
import numpy as np

from rotctl.control.settings import PoseGains
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State


class PoseTracker:
    """Stable PD torques towards several poses at once."""

    def __init__(self, model: Model, period: float) -> None:
        """Keep a scratch space for the factorisation.

        Args:
            period: the torque is held for this long [s].
        """
        self._model = model
        self._period = period
        self._scratch = mujoco.MjData(model.mj)

    def torques(self, state: State, poses: Array, gains: PoseGains) -> Array:
        """Torques (k, nu) [N m] towards poses (k, nu) [rad]."""
        mj, scratch = self._model.mj, self._scratch
        h = max(gains.horizon, self._period)
        joints = self._model.joints
        diagonal = self._model.diagonal[joints]
        inertia = state.data.M[diagonal] - self._model.armature
        stiffness = gains.stiffness * inertia
        damping = gains.damping * inertia
        velocity = state.velocity[joints]
        if gains.explicit:
            angles = state.position[self._model.angles]
            return np.asarray(stiffness * (poses - angles) - damping * velocity)
        predicted = state.position[self._model.angles] + h * velocity
        explicit = stiffness * (poses - predicted) - damping * velocity
        # (M + h Kd) qddot = explicit - C: same sparsity as M, so MuJoCo's factor serves.
        scratch.M[:] = state.data.M
        scratch.M[diagonal] += h * damping
        mujoco.mj_factorM(mj, scratch)
        force = np.repeat(-state.bias[None], len(poses), axis=0)
        force[:, joints] += explicit
        acceleration = np.empty_like(force)
        mujoco.mj_solveM(mj, scratch, acceleration, force)
        return np.asarray(explicit - h * damping * acceleration[:, joints])

    def accelerations(self, state: State, poses: Array, gains: PoseGains) -> Array:
        """Accelerations (k, nu) [rad/s2] towards poses (k, nu) [rad].

        Of the same spring and damper, at the end of the control period, too, each joint by itself.
        """
        h = 0.0 if gains.explicit else max(gains.horizon, self._period)
        velocity = state.velocity[self._model.joints]
        predicted = state.position[self._model.angles] + h * velocity
        spring = gains.stiffness * (poses - predicted) - gains.damping * velocity
        return np.asarray(spring / (1.0 + h * gains.damping))
