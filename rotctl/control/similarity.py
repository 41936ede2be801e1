"""Gains for a body of another size: those of the drawn one by the law of `mechanics.stature`.

Errors are in N, N m, m/s2 and rad/s2, gains in 1/s and 1/s2: each has its power of the ratios of
mass, length and time, so that the problem that is solved is the same one.
"""

from dataclasses import replace
from typing import TypeVar

from rotctl.control.settings import (
    ContactGains,
    ControllerSettings,
    Gains,
    PoseGains,
    TaskGains,
)
from rotctl.control.supervisor import Thresholds
from rotctl.maths.rotations import scaled
from rotctl.mechanics.merging import Merging
from rotctl.mechanics.stature import Likeness

G = TypeVar("G", ControllerSettings, Gains)
# By the kind of a task, of what its rows are in: N, N m; an acceleration is the same for all.
FORCES, TORQUES = ("linear",), ("spin", "angular_momentum")


def similar(
    settings: ControllerSettings, by: Likeness, kinds: dict[str, str]
) -> ControllerSettings:
    """The settings for a body of other ratios.

    Args:
        kinds: of the tasks whose gains there are, by their names.
    """
    if by.same:
        return settings
    merging = Merging(settings.merging.distance * by.size, settings.merging.angle)
    return replace(similar_gains(settings, by, kinds), merging=merging)


def similar_gains(settings: G, by: Likeness, kinds: dict[str, str]) -> G:
    """The same of what a behaviour brings along."""
    return replace(
        settings,
        thresholds=_thresholds(settings.thresholds, by),
        contact=_contact(settings.contact, by),
        contacts={name: _contact(gains, by) for name, gains in settings.contacts.items()},
        pose=_pose(settings.pose, by),
        poses={name: _pose(gains, by) for name, gains in settings.poses.items()},
        tasks={
            name: _task(gains, by, kinds.get(name, name)) for name, gains in settings.tasks.items()
        },
    )


def _thresholds(known: Thresholds, by: Likeness) -> Thresholds:
    return replace(
        known,
        force=known.force * by.mass,
        torque=known.torque * by.torque,
        separation=known.separation * by.time,  # a velocity: length over time
    )


def _contact(gains: ContactGains, by: Likeness) -> ContactGains:
    return replace(gains, damping=gains.damping / by.time, force=gains.force / by.mass**2)


def _pose(gains: PoseGains, by: Likeness) -> PoseGains:
    return replace(
        gains,
        stiffness=gains.stiffness / by.time**2,
        damping=gains.damping / by.time,
        horizon=gains.horizon * by.time,
        weight=gains.weight / by.torque**2,
        blend=gains.blend * by.time**2,
    )


def _task(gains: TaskGains, by: Likeness, kind: str) -> TaskGains:
    unit = by.mass if kind in FORCES else by.torque if kind in TORQUES else 1.0
    turning = by.size if kind in ("attitude", "limits", "joints") else 1.0  # rad/s2: m/s2 over m
    return TaskGains(
        weight=scaled(gains.weight, turning**2 / unit**2),
        stiffness=scaled(gains.stiffness, by.time**-2),
        damping=scaled(gains.damping, 1.0 / by.time),
    )
