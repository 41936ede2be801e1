"""Hard contacts and joint limits in one LCP a step, the physics of [Brown2013] Appendix A.

Positions, contacts, Jacobian rows and bias come from MuJoCo; its constraint solver and its
integrator never act. One semi-implicit step of h:

    free velocity    v_free = v + h M^-1 (S' tau - C + f),      M includes h D, C includes D v
    rows             w = J v+ - t = A p + b,  A = J M^-1 J',  b = J v_free - t
    impulses p       complementary to w, see `rotctl.simulation.pgs`
    velocity         v+ = v_free + M^-1 J' p
    position         q+ = q integrated with v+ over h

An open contact or limit may close within the step and no more, t = -gap / h. One that is
overstepped is taken back a little, t = min(fastest, correction (depth - slop) / h).
"""

import mujoco
import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.pair_limit import crowded
from rotctl.mechanics.physics import LockstepPhysics
from rotctl.native.library import NOT_BUILT, library
from rotctl.simulation import pgs
from rotctl.simulation.ground_forces import GroundForces, ground_forces
from rotctl.simulation.pgs import Impulses, Rows, Solve
from rotctl.simulation.stepping import trouble

LIMIT = mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT


class LockstepStepper:
    """Steps by impulses; leaves them as forces in MuJoCo's `efc_force`.

    Attributes:
        backend: `lockstep compiled` or `lockstep reference`, whichever really works here.
        notice: what a user should know about that; mostly empty.
        solved: impulses of the steps of the last control period, in the order of MuJoCo's
            constraint rows.
    """

    def __init__(self, model: Model, settings: LockstepPhysics) -> None:
        """Step `model`, which was built with the same settings."""
        self._mj = model.mj
        self._settings = settings
        self._forces = ground_forces(model.mj)
        self._periods = 0
        wanted = settings.backend == "compiled"
        compiled = wanted and library() is not None
        self._solve: Solve = pgs.solve_compiled if compiled else pgs.solve
        self.backend = f"lockstep {'compiled' if compiled else 'reference'}"
        missing = "the compiled contact solver " + NOT_BUILT.format(slower="much")
        self.notice = missing if wanted and not compiled else ""
        self.solved: list[Impulses] = []
        self._crowd = ""

    def evaluate(self, data: mujoco.MjData) -> None:
        """Positions, contacts, rows and bias."""
        mujoco.mj_step1(self._mj, data)

    def advance(self, data: mujoco.MjData, torque: Array, contacts: Contacts) -> GroundForces:
        """One control period, from the state that `evaluate` saw."""
        data.ctrl[:] = torque
        self.solved.clear()
        self._forces.begin(contacts)
        self._crowd = ""
        self._step(data)
        for _ in range(self._settings.substeps - 1):
            self.evaluate(data)
            self._step(data)
        self._periods += 1
        return self._forces.result()

    def remark(self) -> str:
        """Of a crowded pair of geoms, and that the solver stopped far from a solution."""
        worst = max((impulses.residual for impulses in self.solved), default=0.0)
        if worst <= self._settings.alarm:
            return self._crowd
        far = f"contacts not solved after {self._settings.sweeps} sweeps: off by {worst:.2g} m/s"
        return "; ".join(filter(None, (self._crowd, far)))

    def complaint(self, data: mujoco.MjData) -> str:
        """See `trouble`."""
        period = self._settings.substeps * self._mj.opt.timestep
        return trouble(data, self._periods, period)

    def _step(self, data: mujoco.MjData) -> None:
        mj, h = self._mj, self._mj.opt.timestep
        mujoco.mj_fwdActuation(mj, data)
        mujoco.mj_fwdAcceleration(mj, data)
        velocity = data.qvel + h * data.qacc_smooth
        if data.nefc:
            jacobian = data.efc_J.reshape(-1, mj.nv)
            solved = np.empty_like(jacobian)
            mujoco.mj_solveM(mj, data, solved, jacobian)
            rows = self._rows(data, jacobian, solved, velocity)
            chosen = self._settings
            impulses = self._solve(rows, chosen.sweeps, chosen.tolerance, chosen.friction_follow)
            data.efc_force[:] = impulses.p / h
            velocity += product(impulses.p, solved)
            self.solved.append(impulses)
        data.qvel[:] = velocity
        mujoco.mj_integratePos(mj, data.qpos, data.qvel, h)
        data.time += h
        self._forces.add(data)
        self._crowd = self._crowd or crowded(mj, data)

    def _rows(self, data: mujoco.MjData, jacobian: Array, solved: Array, free: Array) -> Rows:
        n, contact = data.nefc, data.contact
        normal = np.full(n, pgs.NO_NORMAL, dtype=np.int32)
        friction = np.zeros(n)
        sliding = (contact.dim == 3) & (contact.efc_address >= 0)
        for tangent in (1, 2):
            row = contact.efc_address[sliding] + tangent
            normal[row] = row - tangent
            friction[row] = contact.friction[sliding, tangent - 1]
        target = np.where(normal == pgs.NO_NORMAL, self._targets(data), 0.0)
        return Rows(product(jacobian, solved.T), product(jacobian, free) - target, normal, friction)

    def _targets(self, data: mujoco.MjData) -> Array:
        """Slowest separation (n,) that each row may end the step with [m/s, rad/s]."""
        settings, h, gap = self._settings, self._mj.opt.timestep, data.efc_pos
        limit = data.efc_type == LIMIT
        depth = np.maximum(-gap - np.where(limit, 0.0, settings.slop), 0.0)
        fastest = np.where(limit, settings.limit_push_out, settings.push_out)
        back = np.minimum(settings.correction * depth / h, fastest)
        return np.asarray(np.where(gap > 0.0, -gap / h, back))
