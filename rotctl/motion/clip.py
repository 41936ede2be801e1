"""A clip: one cycle of a reference motion, indexed by the in-plane excursion instead of time.

Sample k of n is the pose at phase 2 pi k / n, and the cycle closes. The phase is that of the
rolling behaviour: how far the body has turned about the world's +y since its pelvis was
upright (log roll: supine), while it travels to +x. So a forward roll is face down at pi/2
and on the upper back at pi; a backward roll lies on its back at pi/2.
"""

from functools import lru_cache
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl import files
from rotctl.choices.listing import instead_of, named_file, named_files
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.settings import checking, documents
from rotctl.settings.fields import STRICT, Finite
from rotctl.suggestion import instead

MAX_SAMPLES = 3600
MAX_JOINTS = 500

RollAbout = Literal["left", "right", "head"]
TurnAbout = RollAbout | Literal["face"]  # what is captured; no behaviour turns cartwheels
Samples = Annotated[list[Finite], Field(min_length=12, max_length=MAX_SAMPLES)]
Quaternion = tuple[Finite, Finite, Finite, Finite]


@validated(frozen=True, config=STRICT)
class Clip:
    """One cycle of a reference motion.

    Attributes:
        name: what it is called.
        roll_about: the trunk axis along world +y: `left` rolls forwards, `right` backwards,
            `head` sideways, as a log, `face` sideways over hands and feet, as a cartwheel.
        joints: joint name to n samples over the phase [rad]; a name without a side is both
            sides, a joint not named is held at 0.
        pelvis: n orientations (w, x, y, z) of the pelvis in the world; without them it turns
            evenly and does not tilt.
        character: what the angles were made for.
        source: where the motion comes from.
        licence: and on what terms.
        rate: of the source [rev/s]; a clip has no time of its own.
        loop_gap: what was distributed over the cycle to close it, the largest joint's [rad].
    """

    name: str
    roll_about: TurnAbout
    joints: Annotated[dict[str, Samples], Field(min_length=1, max_length=MAX_JOINTS)]
    pelvis: Annotated[list[Quaternion], Field(max_length=MAX_SAMPLES)] | None = None
    character: str = ""
    source: str = ""
    licence: str = ""
    description: str = ""
    rate: Finite | None = None
    loop_gap: Finite | None = None

    def __post_init__(self) -> None:
        tracks: dict[str, list[Finite] | list[Quaternion]] = {
            f"joints.{name}": samples for name, samples in self.joints.items()
        }
        if self.pelvis is not None:
            tracks["pelvis"] = self.pelvis
            if min(sum(x * x for x in q) for q in self.pelvis) < 0.25:
                raise ValueError("pelvis: a quaternion must have length 1")
        for where, samples in tracks.items():
            if len(samples) != self.samples:
                raise ValueError(
                    f"{where} has {len(samples)} samples, {next(iter(tracks))} has {self.samples}"
                )

    @property
    def samples(self) -> int:
        """Number n of samples over the cycle."""
        return len(next(iter(self.joints.values())))

    def poses(self, model: Model) -> Array:
        """The samples (n, nu) in the model's motor order, within the joint ranges [rad].

        Raises:
            InputError: the clip names a joint that the model has not.
        """
        poses = model.posed(self.joints, f"clip {self.name!r}", self.samples)
        return np.asarray(np.clip(poses, *model.joint_range.T))


def names() -> list[str]:
    """The clips that come with rotctl, and those of the user's folder."""
    return sorted(named_files("motion"))


def load_clip(name: str) -> Clip:
    """Read a clip: one of `names()`, or the path of any file (a slash or .yaml in it).

    Raises:
        InputError: one line that names the file, the bad value and what is valid.
    """
    if "/" in name or name.endswith(".yaml"):
        return _read(Path(name))
    if name not in names():
        valid = f"{instead(name, names())}, or the path of a .yaml file"
        raise InputError(f"{name}: no such clip; {instead_of('motion', name, valid)}")
    return _read(named_file("motion", name))


def _read(path: Path) -> Clip:
    return _parsed(str(path), files.text(path, documents.LARGEST, linked=True))


@lru_cache(maxsize=8)  # all runs of a sweep ask for the same text, and parsing it takes a while
def _parsed(where: str, text: str) -> Clip:
    return checking.from_yaml(Clip, where, text)
