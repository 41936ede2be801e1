"""Water that a body falls into: it bears what is under its surface, and slows what moves there.

Beside whatever else disturbs a run. Each limb is taken as the box around what is solid of it: it
is under water by the share of its height that is, displaces as much of its volume, and drags at
the area that it shows, little along its length: a body that enters long and straight glides, its
limbs in the wake of one another.
"""

from math import pi, sqrt
from typing import NamedTuple

import mujoco
import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, cross, dot
from rotctl.mechanics.bodies import ROOT_BODY, is_character
from rotctl.mechanics.disturbance import Disturbance
from rotctl.mechanics.hulls import hulls
from rotctl.mechanics.terrain import Basin

ROUND = 0.25 * pi  # [-] of a box's face that the limb in it fills
FLAT = 0.5  # [-] a limb so much less tall than long, such as a foot, has its length along its x


class Limb(NamedTuple):
    """A body as a box in its own frame.

    Attributes:
        body: MuJoCo id.
        displaced: mass that it was made with, to which its volume goes [kg].
        middle, half: (3,) of the box [m].
        face: (3,) areas shown along its axes [m2].
        along: number of the axis of its length.
    """

    body: int
    displaced: float
    middle: Array
    half: Array
    face: Array
    along: int


class Water:
    """Buoyancy and drag below a height, with what disturbs besides."""

    def __init__(self, mj: mujoco.MjModel, pool: Basin, besides: Disturbance) -> None:
        """The water of a pool; `besides` acts first."""
        self._pool, self._besides = pool, besides
        self._weight = -mj.opt.gravity * (pool.density / pool.body)
        found = [_limb(mj, body) for body in np.flatnonzero(is_character(mj)).tolist()]
        self._limbs = [limb for limb in found if limb]
        self._mj = mj

    @property
    def remark(self) -> str:
        """Of what disturbs besides."""
        return self._besides.remark

    def awaited(self, time: float) -> str:
        """Of what disturbs besides."""
        return self._besides.awaited(time)

    def idle(self, time: float, period: float) -> bool:
        """See `rotctl.mechanics.disturbance.Disturbance`."""
        return False

    def apply(self, data: mujoco.MjData, period: float, phase: float) -> Array:
        """See `Disturbance`."""
        data.xfrc_applied[:] = 0.0
        total = self._besides.apply(data, period, phase)
        for limb in self._limbs:
            turn = data.xmat[limb.body].reshape(3, 3).copy()
            place = data.xpos[limb.body] + (turn * limb.middle).sum(axis=1)
            tall = float((np.abs(turn[2]) * limb.half).sum())
            share = (self._pool.water - float(place[2]) + tall) / (2.0 * tall)
            if share <= 0.0:
                continue
            borne = limb.displaced * self._weight
            force = min(share, 1.0) * (borne + self._drag(data, limb, period))
            middle = data.xipos[limb.body]
            data.xfrc_applied[limb.body, :3] += force
            total[:3] += force
            total[3:] += cross(middle - data.subtree_com[ROOT_BODY], force)
        return total

    def _drag(self, data: mujoco.MjData, limb: Limb, period: float) -> Array:
        """Force (3,) on a limb all under water, at its centre of mass [N].

        As at the end of a control period in which it slows the limb: it can stop it, not throw
        it back.
        """
        pool, motion = self._pool, np.empty(6)
        mujoco.mj_objectVelocity(
            self._mj, data, mujoco.mjtObj.mjOBJ_BODY, limb.body, motion, 0
        )  # of the centre of mass, along the world's axes
        flow = -motion[3:]
        speed = sqrt(dot(flow, flow))
        if speed == 0.0:
            return flow
        turn = data.xmat[limb.body].reshape(3, 3)
        way = np.abs((turn * (flow / speed)[:, None]).sum(axis=0))  # in the limb's frame
        length = float(way[limb.along])
        coefficient = pool.drag + (pool.ends - pool.drag) * length * length
        rate = 0.5 * pool.density * coefficient * float((limb.face * way).sum()) * speed  # [kg/s]
        mass = float(self._mj.body_mass[limb.body])  # now: it may have taken up a load
        return flow * (rate / (1.0 + rate * period / mass))


def _limb(mj: mujoco.MjModel, body: int) -> Limb | None:
    """The box around a body's solid shapes; None where it has none."""
    solid = np.flatnonzero((mj.geom_bodyid == body) & (mj.geom_contype > 0))
    if not len(solid):
        return None
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for geom in solid.tolist():
        radius, half = mj.geom_size[geom, :2].tolist()
        axis = np.zeros(9)
        mujoco.mju_quat2Mat(axis, mj.geom_quat[geom])
        if geom in hulls(mj):
            corners = mj.geom_pos[geom] + product(hulls(mj)[geom], axis.reshape(3, 3).T)
            low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
            continue
        capsule = mj.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE
        reach = radius + (half * np.abs(axis[2::3]) if capsule else 0.0)
        low = np.minimum(low, mj.geom_pos[geom] - reach)
        high = np.maximum(high, mj.geom_pos[geom] + reach)
    x, y, z = (high - low).tolist()
    face = ROUND * np.array([y * z, x * z, x * y])
    along = 0 if z < FLAT * x else 2
    displaced, middle, half = float(mj.body_mass[body]), 0.5 * (low + high), 0.5 * (high - low)
    return Limb(body, displaced, middle, half, face, along)
