"""The log's groups as types: an attribute for each dataset of the schema that is filled in a run.

Frozen, so that ``buffer.trajectory.qpos = x`` (a forgotten index) is an error. A name that the
schema has and a group has not, or the other way round, is refused when a buffer is allocated.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
Singles = NDArray[np.float32]
Integers = NDArray[np.int32]
Bytes = NDArray[np.int8]
Flags = NDArray[np.bool_]
Names = NDArray[np.bytes_]


@dataclass(frozen=True, slots=True)
class TrajectoryRows:
    """The group ``trajectory``."""

    time: Doubles
    qpos: Doubles
    qvel: Doubles
    ctrl: Doubles
    com: Doubles
    ground_height: Doubles
    com_velocity: Doubles
    linear_momentum: Doubles
    angular_momentum: Doubles
    angular_velocity: Doubles
    angular_excursion: Doubles
    linear_momentum_rate_desired: Doubles
    linear_momentum_rate_predicted: Doubles
    angular_momentum_rate_desired: Doubles
    angular_momentum_rate_predicted: Doubles
    blend: Doubles
    phase: Doubles
    trunk_axis: Doubles
    trunk_axes: Doubles


@dataclass(frozen=True, slots=True)
class CommandRows:
    """The group ``command``."""

    axes: Doubles
    stage: Integers
    target: Doubles
    velocity: Doubles
    error: Doubles
    wanted: Doubles
    predicted: Doubles


@dataclass(frozen=True, slots=True)
class ContactRows:
    """The group ``contacts``."""

    count: Integers
    body: Integers
    position: Singles
    normal: Singles
    force_predicted: Singles
    force_realised: Singles
    force_peak: Singles
    used: Flags
    ground_force: Doubles
    ground_force_peak: Doubles
    penetration: Doubles


@dataclass(frozen=True, slots=True)
class DisturbanceRows:
    """The group ``disturbance``."""

    wrench: Doubles


@dataclass(frozen=True, slots=True)
class SolverRows:
    """The group ``solver``."""

    status: Bytes
    iterations: Integers
    residual: Doubles
    fallback: Bytes


@dataclass(frozen=True, slots=True)
class ModelEntries:
    """The group ``model``: one entry a joint, body or task, not one a step."""

    joint: Names
    body: Names
    task: Names
    torque_limit: Doubles
