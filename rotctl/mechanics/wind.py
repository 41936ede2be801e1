"""Wind, and the drag of moving air on every limb."""

from math import cos, inf, nan, pi, radians, sin, sqrt
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, cross, dot
from rotctl.mechanics.bodies import ROOT_BODY, is_character
from rotctl.mechanics.hulls import hulls
from rotctl.mechanics.model import Model
from rotctl.mechanics.onset import SHORTEST, Time, far_from
from rotctl.settings.fields import STRICT, Drawn, NonNegative, Positive, ends


@validated(frozen=True, config=STRICT)
class Wind:
    """Wind, and the air's drag on all that moves in it.

    Attributes:
        speed: [m/s]; 0 is still air.
        direction: where it blows to, from forward towards left [deg]; a range to draw from, or
            a number.
        density: of the air [kg/m3].
        drag: coefficient of a capsule [-].
        time: when it begins to blow [s]; before and after it there is no air.
        duration: for so long [s]; null to the end.
    """

    name: str
    kind: Literal["wind"]
    speed: NonNegative
    direction: Drawn
    density: Positive
    drag: Positive
    time: Time = 0.0
    duration: Annotated[Positive, Field(ge=SHORTEST)] | None = None
    description: str = ""
    changes_model: ClassVar[bool] = False

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Air":
        """For one run whose forward, left and up are the rows of `axes`."""
        angle = radians(generator.uniform(*ends(self.direction)))
        velocity = self.speed * product(np.array([cos(angle), sin(angle), 0.0]), axes)
        begin = float(generator.uniform(*ends(self.time)))
        end = inf if self.duration is None else begin + self.duration
        return Air(model.mj, velocity, 0.5 * self.density * self.drag, begin, end)


class Air:
    """Drag of moving air on every solid capsule and sphere, by the area it shows."""

    remark = ""

    def __init__(
        self,
        mj: mujoco.MjModel,
        velocity: Array,
        factor: float,
        begin: float = 0.0,
        end: float = inf,
    ) -> None:
        """Air of that velocity (3,) [m/s].

        Args:
            factor: half the density times the drag coefficient [kg/m3].
            begin, end: between which there is air [s]; a control step that holds a part of that
                time gets that part of the force.
        """
        self._mj, self._wind, self._factor = mj, velocity, factor
        self._begin, self._end = begin, end
        solid = is_character(mj)[mj.geom_bodyid] & (mj.geom_contype > 0)
        self._geoms = np.flatnonzero(solid).tolist()
        self._capsule = mj.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE
        self._hulls = hulls(mj)

    def awaited(self, time: float) -> str:
        """See `rotctl.mechanics.disturbance.Disturbance`."""
        return "the wind" if time <= self._begin else ""

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        mj = self._mj
        data.xfrc_applied[:] = 0.0
        motion, total = np.empty(6), np.zeros(6)
        overlap = min(data.time + period, self._end) - max(data.time, self._begin)
        share = min(max(overlap / period, 0.0), 1.0)
        if share == 0.0:
            return total
        for geom in self._geoms:
            mujoco.mj_objectVelocity(mj, data, mujoco.mjtObj.mjOBJ_GEOM, geom, motion, 0)
            flow = self._wind - motion[3:]
            speed = sqrt(dot(flow, flow))
            if speed == 0.0:
                continue
            axis = data.geom_xmat[geom].reshape(3, 3)[:, 2].copy()
            across = cross(axis, flow / speed)
            if geom in self._hulls:  # the side of the box around it that faces the wind
                x, y, z = mj.geom_size[geom].tolist()
                frame = data.geom_xmat[geom].reshape(3, 3)
                area = dot(np.abs(product(frame.T, flow / speed)), np.array([y * z, x * z, x * y]))
                area *= 4.0
            else:
                radius, half = mj.geom_size[geom, :2] * (1.0, self._capsule[geom])
                area = pi * radius**2 + 4.0 * radius * half * sqrt(dot(across, across))
            body = mj.geom_bodyid[geom]
            force = share * self._factor * area * speed * flow
            data.xfrc_applied[body, :3] += force
            data.xfrc_applied[body, 3:] += cross(data.geom_xpos[geom] - data.xipos[body], force)
            total[:3] += force
            total[3:] += cross(data.geom_xpos[geom] - data.subtree_com[ROOT_BODY], force)
        return total

    def idle(self, time: float, period: float) -> bool:
        """See `Disturbance`."""
        return far_from(time, period, self._begin, self._end)
