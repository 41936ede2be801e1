"""Two key poses r_a and r_b, constant or varying with the phase of a cycle.

Each joint of a pose is a number [rad], or (mean, cosine, sine) [rad] over the phase theta:
mean + cosine cos(theta) + sine sin(theta); cosine and sine of twice the phase may follow, and so
on. A joint name without a side stands for both sides; joints not named are held at 0. A pose over
the phase is clipped to the joints' ranges, which it may well pass; a single one must keep to them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import Annotated, TypeVar

import numpy as np
from pydantic import AfterValidator, Discriminator, Field, Tag
from pydantic.dataclasses import dataclass as validated

from rotctl.caching import kept
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.native.layout import constant
from rotctl.settings.fields import STRICT, Finite

ROUNDING = 1e-6  # [rad] of a limit that somebody copied
Turn = Annotated[Finite, Field(ge=-10, le=10)]  # [rad]; no joint turns half as far


def _pairs_after_a_mean(waves: tuple[float, ...]) -> tuple[float, ...]:
    """A mean and pairs of cosine and sine, as they are.

    Raises:
        ValueError: they are not.
    """
    if len(waves) % 2 == 0:
        raise ValueError(f"must be a mean with pairs of cosine and sine, not {len(waves)} numbers")
    return waves


Number = TypeVar("Number")
FourierSeries = Annotated[
    tuple[Number, ...],
    Field(min_length=1, max_length=constant("WAVES")),
    AfterValidator(_pairs_after_a_mean),
]
"""Of a number over the phase: mean, cosine and sine, and those of multiples of the phase."""


def over_phase(waves: Sequence[float], phase: float) -> float:
    """What a `FourierSeries` is at a phase [rad], in the unit of its numbers."""
    total = waves[0]
    for n in range(1, len(waves) // 2 + 1):
        total += waves[2 * n - 1] * cos(n * phase) + waves[2 * n] * sin(n * phase)
    return total


def _form(angle: object) -> str:
    return "waves" if isinstance(angle, list | tuple) else "turn"


Waves = Annotated[
    tuple[Turn, ...],
    Field(min_length=3, max_length=constant("WAVES")),
    AfterValidator(_pairs_after_a_mean),
]
Angle = Annotated[
    Annotated[Turn, Tag("turn")] | Annotated[Waves, Tag("waves")], Discriminator(_form)
]


@validated(frozen=True, config=STRICT)
class Poses:
    """Key poses r_a and r_b by joint name; without r_b there is one pose."""

    a: dict[str, Angle]
    b: dict[str, Angle] | None = None


@dataclass(frozen=True)
class PosePair:
    """The two poses of blend tracking, [Brown2013] section 4.3.

    Attributes:
        coefficients: (2, n, nu) mean, cosine and sine of pose a and pose b, and of multiples of
            the phase [rad].
        low, high: (nu,) joint ranges [rad].
    """

    coefficients: Array
    low: Array
    high: Array

    def start(self, phase: float) -> Array:
        """The pose (nu,) [rad] to begin in at a phase [rad]: r_a, the tighter one."""
        return np.asarray(self.at(phase)[0])

    def at(self, phase: float) -> Array:
        """Both poses (2, nu) [rad] at a phase [rad]."""
        turns = range(1, self.coefficients.shape[1] // 2 + 1)
        waves = [1.0, *(wave(n * phase) for n in turns for wave in (cos, sin))]
        poses = np.einsum("c,pcj->pj", waves, self.coefficients)
        return np.asarray(np.minimum(np.maximum(poses, self.low), self.high))


@kept(most=8)
def make_pose_pair(model: Model, poses: Poses, key: str = "behaviour.poses") -> PosePair:
    """Poses by joint name to arrays in motor order.

    Raises:
        InputError: a name is no joint of the model.
    """
    pairs = (poses.a, "a"), (poses.a if poses.b is None else poses.b, "b")
    waves = max((len(_waves(angle)) for pose, _ in pairs for angle in pose.values()), default=3)
    return PosePair(
        coefficients=np.array(
            [_coefficients(model, pose, waves, f"{key}.{name}") for pose, name in pairs]
        ),
        low=model.joint_range[:, 0],
        high=model.joint_range[:, 1],
    )


def make_pose(model: Model, angles: Mapping[str, float], key: str) -> Array:
    """One constant pose (nu,) [rad] by joint name, within the joints' ranges.

    Raises:
        InputError: a name is no joint of the model, or an angle is none of that joint.
    """
    (pose,) = model.posed(angles, key, 1)
    for name, angle in angles.items():
        for low, high in model.joint_range[model.motors(name, key)].tolist():
            if not low - ROUNDING <= angle <= high + ROUNDING:
                raise InputError(
                    f"{key}.{name}={angle:g}: this joint goes from {low:.4g} to {high:.4g} rad"
                )
    return np.asarray(
        np.minimum(np.maximum(pose, model.joint_range[:, 0]), model.joint_range[:, 1])
    )


def _coefficients(model: Model, pose: Mapping[str, Angle], waves: int, key: str) -> Array:
    full = {name: _waves(angle) for name, angle in pose.items()}
    padded = {name: (*angle, *[0.0] * (waves - len(angle))) for name, angle in full.items()}
    return model.posed(padded, key, waves)


def _waves(angle: Angle) -> tuple[float, ...]:
    return angle if isinstance(angle, tuple) else (angle, 0.0, 0.0)
