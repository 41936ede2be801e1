"""Start states, drawn from the seed."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import atan, cos, sin, sqrt, tan
from typing import Any

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.behaviour import Behaviour, Placement
from rotctl.errors import InputError
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, advance, cross, dot
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.mechanics.model import Model
from rotctl.settings.fields import SPARSE, STRICT, Finite, NonNegative, Range
from rotctl.simulation import aloft as spawned
from rotctl.simulation import falling as falls
from rotctl.simulation.aloft import AloftSettings
from rotctl.simulation.clearance import clearance
from rotctl.simulation.falling import FallingSettings
from rotctl.simulation.known import Known, StateSettings, pitch
from rotctl.simulation.suited import suited

WAYS = {
    "left": "faces along the way",
    "right": "faces back along the way",
    "head": "lies across the way",
}
SAME = 1e-3  # [-] of a mass, in a file that somebody may round
SINK = 1e-6  # [m] into the ground, so that whether a start touches does not hang on rounding


@validated(frozen=True, config=STRICT)
class Posture:
    """How a character waits for its roll: pitch of the pelvis [rad] and joint angles [rad].

    A joint name without a side stands for both sides; joints not named are at 0.
    """

    pitch: Finite
    pose: dict[str, Finite]
    description: str = ""


@validated(frozen=True, config=STRICT)
class StartSettings:
    """Uniform ranges that a start state is drawn from.

    Attributes:
        pitch: of the pelvis about world y [rad]; negative leans back.
        speed_x, speed_y: velocity of the centre of mass [m/s].
        angular_velocity_x, angular_velocity_y, angular_velocity_z: of the whole body,
            moving as one rigid piece [rad/s].
        postures: to start in, by the axis that is rolled about; `pitch` is then added to
            theirs. Without any a run starts in its behaviour's own pose.
        scatter: how far each joint may be from its posture, either way [rad].
        tilt: how far the whole body may be turned about any axis [rad].
        falling: in the air, instead of on the ground; or
        aloft: high in it; or
        state: known to the last number, to which the ranges above are added.
    """

    name: str
    pitch: Range
    speed_x: Range
    speed_y: Range
    angular_velocity_x: Range
    angular_velocity_y: Range
    angular_velocity_z: Range
    postures: dict[str, Posture] = field(default_factory=dict)
    scatter: NonNegative = 0.0
    tilt: NonNegative = 0.0
    falling: FallingSettings | None = None
    aloft: AloftSettings | None = None
    state: StateSettings | None = field(default=None, metadata=SPARSE)
    description: str = ""

    def __post_init__(self) -> None:
        own = [name for name in ("falling", "aloft", "state", "postures") if getattr(self, name)]
        if len(own) > 1:
            raise ValueError(f"{own[0]} has its own pose, and there is {own[1]}")
        if (self.scatter or self.tilt) and not own:
            raise ValueError("scatter and tilt are about postures, and there are none")


@dataclass(frozen=True)
class Start:
    """A drawn start.

    Attributes:
        pitch: of the pelvis [rad].
        velocity: (3,) of the centre of mass [m/s].
        angular_velocity: (3,) of the whole body [rad/s].
        pose: (nu,) [rad]; None leaves it to the behaviour.
        tilt: (3,) rotation vector of the whole body [rad].
        gap: between its lowest point and the ground [m].
        height: of the centre of mass over what is below it, instead of a gap [m].
        ahead: of the origin [m].
        known: a state that the rest is beside: turned by `pitch` and `tilt`, faster by `velocity`
            and `angular_velocity`, with the joints at `pose`.
    """

    pitch: float
    velocity: Array
    angular_velocity: Array
    pose: Array | None = None
    tilt: Array = field(default_factory=lambda: np.zeros(3))
    gap: float = 0.0
    height: float = 0.0
    ahead: float = 0.0
    known: Known | None = None


def draw(
    settings: StartSettings, model: Model, roll_about: str, generator: np.random.Generator
) -> Start:
    """Draw pitch, speeds and angular velocities, in the order the settings list them, then a pose.

    Raises:
        InputError: there is no posture for a roll about that axis, or it does not fit the model.
    """
    pitch, vx, vy, wx, wy, wz = (
        generator.uniform(*bounds)
        for bounds in (
            settings.pitch,
            settings.speed_x,
            settings.speed_y,
            settings.angular_velocity_x,
            settings.angular_velocity_y,
            settings.angular_velocity_z,
        )
    )
    start = Start(float(pitch), np.array([vx, vy, 0.0]), np.array([wx, wy, wz]))
    if roll_about != "left" and (settings.falling or settings.aloft):
        does = "falls onto the feet of who turns" if settings.falling else "turns"
        raise InputError(
            f"start={settings.name} {does} about the left axis, and "
            f"behaviour.roll_about={roll_about}; {suited(roll_about)}"
        )
    if settings.falling:
        return _falling(settings, settings.falling, model, start, generator)
    if settings.aloft:
        return _aloft(settings, settings.aloft, model, start, generator)
    if settings.state:
        return _known(settings, settings.state, model, start, generator)
    if not settings.postures:
        return start
    if roll_about not in settings.postures:
        there = " or ".join(f"{WAYS[about]} (roll_about={about})" for about in settings.postures)
        raise InputError(
            f"start={settings.name} is for who {there}, and the behaviour is for who "
            f"{WAYS[roll_about]} (behaviour.roll_about={roll_about}); {suited(roll_about)}"
        )
    posture = settings.postures[roll_about]
    pose = _pose(model, posture.pose, f"start.postures.{roll_about}.pose")
    placed = replace(start, pitch=start.pitch + posture.pitch)
    return _scattered(settings, model, placed, pose, generator)


def _falling(
    settings: StartSettings,
    falling: FallingSettings,
    model: Model,
    start: Start,
    generator: np.random.Generator,
) -> Start:
    x, y, _ = start.velocity.tolist()
    found = falls.draw(falling, model, x, generator)
    falls_so = replace(
        start,
        pitch=start.pitch + found.contact.attitude,
        velocity=np.array([x, y, -found.speed]),
        angular_velocity=start.angular_velocity + found.angular_velocity,
        gap=found.gap,
    )
    return _scattered(settings, model, falls_so, found.contact.pose, generator)


def _aloft(
    settings: StartSettings,
    aloft: AloftSettings,
    model: Model,
    start: Start,
    generator: np.random.Generator,
) -> Start:
    x, y, _ = start.velocity.tolist()
    pose = _pose(model, aloft.pose, "start.aloft.pose")
    found = spawned.draw(aloft, model, start.pitch, pose, generator)
    flies = replace(
        start,
        velocity=np.array([x, y, found.speed]),
        angular_velocity=start.angular_velocity + found.angular_velocity,
        height=aloft.height,
        ahead=aloft.ahead,
    )
    return _scattered(settings, model, flies, pose, generator)


def _known(
    settings: StartSettings,
    state: StateSettings,
    model: Model,
    start: Start,
    generator: np.random.Generator,
) -> Start:
    if state.mass is not None and abs(state.mass / model.mass - 1.0) > SAME:
        raise InputError(
            f"start={settings.name} is a state of a character of {state.mass:.4g} kg, and this one "
            f"has {model.mass:.4g} kg; give the character of the run that it is from, or "
            "start.state.mass=null to start so all the same"
        )
    pose = _pose(model, state.pose, "start.state.pose")
    speeds = _pose(model, state.speeds, "start.state.speeds")
    beside = _scattered(settings, model, start, pose, generator)
    return replace(beside, gap=state.gap, known=Known(state, speeds))


def _scattered(
    settings: StartSettings, model: Model, start: Start, pose: Array, generator: np.random.Generator
) -> Start:
    low, high = model.joint_range.T
    if settings.state:  # where a joint may be beyond its stop, which is soft
        low, high = np.minimum(low, pose), np.maximum(high, pose)
    pose = pose + generator.uniform(-settings.scatter, settings.scatter, len(pose))
    tilt = _tilt(settings.tilt, generator)
    return replace(start, pose=np.clip(pose, low, high), tilt=tilt)


def _tilt(largest: float, generator: np.random.Generator) -> Array:
    """A turn about any axis (3,), at most `largest` [rad]."""
    way = generator.normal(size=3)
    length = sqrt(dot(way, way))
    return way * (generator.uniform(0.0, largest) / length)


def _pose(model: Model, angles: Mapping[str, float], key: str) -> Array:
    """Angles by joint name to an array (nu,) in motor order."""
    pose = np.zeros(len(model.joint_names))
    for name, angle in angles.items():
        pose[model.motors(name, key)] = angle
    return pose


def beginning(start: Start, behaviour: Behaviour[Any]) -> float:
    """The pitch at which a behaviour begins [rad]."""
    known = start.known
    return start.pitch if known is None else start.pitch + pitch(known, behaviour)


def place(model: Model, data: mujoco.MjData, start: Start, usual: Placement, axes: Array) -> None:
    """Put the character on the ground, moving. On a slope, its velocity is along the slope.

    Args:
        usual: the behaviour's own, where the start does not say otherwise.
        axes: (3, 3) rows are the behaviour's forward, left and up; the start's velocities are
            along them.
    """
    mj, known = model.mj, start.known
    mujoco.mj_resetData(mj, data)
    data.qpos[model.angles] = usual.pose if start.pose is None else start.pose
    if known is None:
        data.qpos[3:7] = advance(usual.orientation, product(start.tilt, axes))
    else:
        turn = start.tilt + np.array([0.0, start.pitch, 0.0])
        data.qpos[:2] = known.settings.place
        data.qpos[3:7] = advance(known.orientation, product(turn, axes))
    mujoco.mj_kinematics(mj, data)
    if start.height:
        mujoco.mj_comPos(mj, data)
        place = start.ahead * axes[0]
        place[2] = model.ground.height(*place[:2].tolist()) + start.height
        data.qpos[:3] += place - data.subtree_com[ROOT_BODY]
    else:
        gap = (start.gap or -SINK) if known is None else start.gap
        data.qpos[2] += gap - clearance(model, data)
    mujoco.mj_kinematics(mj, data)
    mujoco.mj_comPos(mj, data)
    offset = data.xpos[ROOT_BODY] - data.subtree_com[ROOT_BODY]
    x, y, z = start.velocity
    slope = atan(tan(model.ground.slope) * axes[0, 0])  # along the way
    velocity = product(np.array([x * cos(slope), y, z + x * sin(slope)]), axes)
    spin = product(start.angular_velocity, axes)
    data.qvel[:3] = velocity + cross(spin, offset)
    data.qvel[3:6] = product(spin, data.xmat[ROOT_BODY].reshape(3, 3))
    if known is not None:
        data.qvel[:3] += known.settings.velocity
        data.qvel[3:6] += known.settings.angular_velocity
        data.qvel[model.joints] = known.speeds
