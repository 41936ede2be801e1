"""Limbs that come down alight where they can bear a roll that goes aside.

Who is pushed from the side rolls on askew, its trunk leant over the feet to the side that it goes
to, for many revolutions. Its poses set the limbs beside the trunk, so that they come down on the
other side, and no force of such contacts rights it. So a limb that sinks is brought to where it
would be under a trunk that is not askew, and further by what the centre of mass goes aside in the
meantime, at most as far as to the capture point, whose time is the pendulum's, sqrt(h / g).
"""

from typing import Annotated

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.maths.rotations import Array, crossed, dotted
from rotctl.mechanics.bodies import ROOT_BODY, SIDES, body_ids
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.settings.fields import STRICT, NonNegative, Positive

Joints = Annotated[tuple[str, ...], Field(min_length=1, max_length=8)]  # of a limb, in C, too


@validated(frozen=True, config=STRICT)
class AlightingSettings:
    """Which limbs are brought aside as they come down, and how far.

    Attributes:
        limbs: bodies that come down and the joints that bring them aside, all without a side.
        lead: how far ahead the centre of mass is where they alight, by how fast it goes aside [s].
        sinking: speed of sinking from which on they go all the way, slower ones by their share
            [m/s]: one that stands does not sink.
        reach: of a limb over a joint's axis below which the joint moves less than it would have
            to [m].
        most: that a joint turns for it [rad].
    """

    limbs: Annotated[dict[str, Joints], Field(min_length=1)]
    lead: NonNegative
    sinking: Positive
    reach: Positive
    most: Positive


class Alighting:
    """The limbs of one run.

    Attributes:
        settings: of it.
        limbs: of each limb its body and its joints, as pairs of a motor and MuJoCo's joint.
        low, high: (nu,) ends of all joints [rad].
    """

    def __init__(self, settings: AlightingSettings, model: Model) -> None:
        """For both sides of a body.

        Raises:
            InputError: there is no such limb or joint, or the joint does not move the limb.
        """
        self.settings, mj = settings, model.mj
        joints = mj.actuator_trnid[:, 0].tolist()
        self.limbs: list[tuple[int, list[tuple[int, int]]]] = []
        for limb, names in settings.limbs.items():
            key = f"behaviour.alighting.limbs.{limb}"
            pairs = [self._pair(name, model, key) for name in names if model.motors(name, key)]
            both = body_ids(mj, [limb], key)
            if len(both) < len(SIDES):
                raise InputError(f"{key}: {limb} is one body; name a limb that both sides have")
            for i, body in enumerate(both):
                own = [(pair[i], joints[pair[i]]) for pair in pairs]
                for motor, joint in own:
                    if joint not in _moving(mj, body):
                        raise InputError(f"{key}: {model.joint_names[motor]} does not move it")
                self.limbs.append((body, own))
        self.low, self.high = np.ascontiguousarray(model.joint_range.T)

    @staticmethod
    def _pair(joint: str, model: Model, key: str) -> tuple[int, int]:
        known = {name: motor for motor, name in enumerate(model.joint_names)}
        left, right = (known.get(joint + side) for side in SIDES)
        if left is None or right is None:
            raise InputError(f"{key}: {joint} is of no limb on either side")
        return left, right

    def turns(self, state: State, axis: Array, left: Array) -> list[tuple[int, float]]:
        """By how much which motors turn for it [rad].

        Args:
            axis: (3,) the trunk's axis that should be `left`, unit.
            left: (3,) of the way, unit.
        """
        s, data, momentum = self.settings, state.data, state.momentum
        com, along = momentum.com.tolist(), left.tolist()
        ahead = s.lead * dotted(along, momentum.com_velocity.tolist())
        lean, middle = _from(along, axis.tolist()), data.subtree_com[ROOT_BODY].tolist()
        found: list[tuple[int, float]] = []
        for body, joints in self.limbs:
            place = data.xipos[body].tolist()
            turning, moving = data.cvel[body].reshape(2, 3).tolist()
            sinks = -(moving[2] + crossed(turning, _from(middle, place))[2])
            share = min(max(sinks / s.sinking, 0.0), 1.0)
            missing = share * (ahead + dotted(_from(com, place), lean))
            arms, scale = [], s.reach * s.reach
            for _, joint in joints:
                off = _from(data.xanchor[joint].tolist(), place)
                arms.append(dotted(along, crossed(data.xaxis[joint].tolist(), off)))
                scale += arms[-1] * arms[-1]
            for (motor, _), arm in zip(joints, arms, strict=True):
                found.append((motor, min(max(arm * missing / scale, -s.most), s.most)))
        return found

    def moved(self, pose: Array, turns: list[tuple[int, float]]) -> Array:
        """A pose (nu,) with those motors turned, within their joints' ranges."""
        moved = pose.copy()
        for motor, by in turns:
            angle = moved[motor]
            low, high = min(self.low[motor], angle), max(self.high[motor], angle)
            moved[motor] = min(max(angle + by, low), high)
        return moved


def _moving(mj: mujoco.MjModel, body: int) -> list[int]:
    """The joints between a body and the world."""
    joints: list[int] = []
    while body:
        first = int(mj.body_jntadr[body])
        joints += range(first, first + int(mj.body_jntnum[body]))
        body = int(mj.body_parentid[body])
    return joints


def _from(start: list[float], end: list[float]) -> list[float]:
    return [b - a for a, b in zip(start, end, strict=True)]
