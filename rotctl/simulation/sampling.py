"""A start state, drawn from the seed: on the ground, falling, aloft, or beside a known one."""

from dataclasses import replace
from math import sqrt

import numpy as np

from rotctl.errors import InputError
from rotctl.maths.rotations import Array, dot
from rotctl.mechanics.model import Model
from rotctl.simulation import aloft as spawned
from rotctl.simulation import falling as falls
from rotctl.simulation.aloft import AloftSettings
from rotctl.simulation.falling import FallingSettings
from rotctl.simulation.known import Known, StateSettings
from rotctl.simulation.start import Start, StartSettings
from rotctl.simulation.suited import suited

WAYS = {
    "left": "faces along the way",
    "right": "faces back along the way",
    "head": "lies across the way",
}
SAME = 1e-3  # [-] of a mass, in a file that somebody may round


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
    (pose,) = model.posed(posture.pose, f"start.postures.{roll_about}.pose", 1)
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
    (pose,) = model.posed(aloft.pose, "start.aloft.pose", 1)
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
    (pose,) = model.posed(state.pose, "start.state.pose", 1)
    (speeds,) = model.posed(state.speeds, "start.state.speeds", 1)
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
