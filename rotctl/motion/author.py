"""Key poses over the turn of the pelvis, written by hand, to a clip."""

from math import tau
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.clip import Clip, RollAbout
from rotctl.motion.cycle import SAMPLES, by_excursion
from rotctl.motion.turning import Motion, rolled_by, upright
from rotctl.motion.writing import make_clip
from rotctl.settings import checking
from rotctl.settings.fields import STRICT, Finite, Vector

DENSE = 720  # postures between the key poses, of which AE is measured


@validated(frozen=True, config=STRICT)
class Key:
    """One key pose.

    Attributes:
        turn: of the pelvis about the rolling axis [rev].
        pose: joint name to angle [rad]; a name without a side is both sides, a joint not
            named is at 0.
        tilt: of the pelvis from the plane of the roll, a rotation vector along its own
            forward, left and up axes [rad].
    """

    turn: Annotated[Finite, Field(ge=0, lt=1)]
    pose: dict[str, Finite]
    tilt: Vector = (0.0, 0.0, 0.0)


@validated(frozen=True, config=STRICT)
class Keys:
    """A cycle by its key poses; the fields beside `keys` are those of the clip."""

    name: str
    roll_about: RollAbout
    keys: Annotated[list[Key], Field(min_length=3, max_length=200)]
    description: str = ""
    source: str = ""
    licence: str = ""

    def __post_init__(self) -> None:
        for before, after in zip(self.keys[:-1], self.keys[1:], strict=True):
            if after.turn <= before.turn:
                raise ValueError(f"keys: turn {after.turn:g} must come after {before.turn:g}")


def load_keys(path: Path) -> Keys:
    """Read a file of key poses.

    Raises:
        InputError: one line that names the file, the bad value and what is valid.
    """
    return checking.read(Keys, path, linked=True)


def author(model: Model, keys: Keys, character: str) -> Clip:
    """The clip through the key poses, AE linear in its phase.

    The angles between are piecewise cubic and monotone (PCHIP): none overshoots a key.

    Raises:
        InputError: a key names a joint that the model has not.
    """
    turns = np.array([key.turn for key in keys.keys])
    values = np.hstack(
        [
            [_pose(model, key) for key in keys.keys],
            [key.tilt for key in keys.keys],
        ]
    )
    # Three cycles in a row: the middle one is periodic, as far as its slopes can tell.
    curve = PchipInterpolator(
        np.concatenate([turns - 1.0, turns, turns + 1.0]), np.tile(values, (3, 1))
    )
    places = np.arange(DENSE) / DENSE
    between = curve(places)
    tilt = Rotation.from_rotvec(between[:, -3:])
    dense = Motion(between[:, :-3], rolled_by(tau * places) * upright(keys.roll_about) * tilt)
    return make_clip(
        model,
        by_excursion(model, dense, keys.roll_about, SAMPLES),
        name=keys.name,
        roll_about=keys.roll_about,
        character=character,
        description=keys.description,
        source=keys.source,
        licence=keys.licence,
    )


def _pose(model: Model, key: Key) -> Array:
    where = f"the key at turn {key.turn:g}"
    for name, angle in key.pose.items():
        for low, high in model.joint_range[model.motors(name, where)].tolist():
            if not low <= angle <= high:
                raise InputError(f"{where} has {name}={angle:g}, valid: {low:g} to {high:g}")
    (pose,) = model.posed(key.pose, where, 1)
    return np.asarray(np.clip(pose, *model.joint_range.T))
