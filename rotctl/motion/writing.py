"""A motion over a phase to a clip, and a clip to the text of its file."""

from typing import Any

import numpy as np
import yaml

from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.model import Model
from rotctl.motion.clip import Clip
from rotctl.motion.turning import Motion

DIGITS = 3  # a milliradian is finer than any controller follows


def make_clip(model: Model, motion: Motion, **about: Any) -> Clip:
    """A clip of a motion at even phases; `about` are the clip's other fields."""
    columns = dict(zip(model.joint_names, _rounded(motion.poses.T), strict=True))
    joints: dict[str, list[float]] = {}
    for name, samples in columns.items():
        bare = name.removesuffix(SIDES[0]).removesuffix(SIDES[1])
        if all(columns.get(bare + side) == samples for side in SIDES):
            joints.setdefault(bare, samples)
        else:
            joints[name] = samples
    quaternions = _rounded(motion.pelvis.as_quat(scalar_first=True), DIGITS + 1)
    bent = {name: samples for name, samples in joints.items() if any(samples)}
    return Clip(
        joints=bent or dict(list(joints.items())[:1]),  # straight all the way: one says how long
        pelvis=[(w, x, y, z) for w, x, y, z in quaternions],
        **about,
    )


def text(clip: Clip) -> str:
    """The clip as YAML, keys in the order of the class."""
    fields = {
        name: value
        for name in clip.__dataclass_fields__
        if (value := getattr(clip, name)) not in ("", None)
    }
    tracks = {"joints": fields.pop("joints")}
    if clip.pelvis is not None:
        tracks["pelvis"] = [list(quaternion) for quaternion in fields.pop("pelvis")]
    words = yaml.safe_dump(fields, sort_keys=False, allow_unicode=True, width=100)
    samples = yaml.safe_dump(tracks, sort_keys=False, default_flow_style=None, width=100)
    return f"{words}{samples}"


def _rounded(values: Any, digits: int = DIGITS) -> list[list[float]]:
    rounded: list[list[float]] = (np.round(values, digits) + 0.0).tolist()  # no -0.0
    return rounded
