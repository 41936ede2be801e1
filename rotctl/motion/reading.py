"""A motion file to a capture, by its ending and what the user says of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from rotctl.errors import InputError
from rotctl.motion.asf_amc import RATE, read_amc, skeleton_of
from rotctl.motion.bvh import read_bvh
from rotctl.motion.capture import Capture
from rotctl.motion.deepmimic import read_deepmimic
from rotctl.motion.joint_files import read_joints
from rotctl.motion.smpl import read_smpl

FORMATS = (
    ".bvh, .amc (with --skeleton FILE.asf), .txt or .json (DeepMimic), .npz (SMPL, or joints of a "
    "--model), .csv (joints of a --model)"
)
PICKLES = (".pkl", ".pickle", ".joblib", ".p")


@dataclass(frozen=True)
class Wishes:
    """What the user says of a capture.

    Attributes:
        skeleton: of an .amc; without it the .asf of the same name.
        rate: [Hz] instead of the file's own.
        up: axis of the file, `x`, `y` or `z`; without it, it is guessed where the file leaves it
            open.
        joints: role, such as `left_hip`, to joint.
        model: MJCF file of the robot whose joints the file has.
    """

    skeleton: Path | None = None
    rate: float | None = None
    up: str | None = None
    joints: Mapping[str, str] = field(default_factory=dict)
    model: Path | None = None


NOTHING = Wishes()


def read_capture(path: Path, wishes: Wishes = NOTHING) -> Capture:
    """Read a motion file by its ending.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    rate, ending = wishes.rate, path.suffix.lower()
    if rate is not None and not 1.0 <= rate <= 10_000.0:
        raise InputError(f"--rate={rate:g}: valid: 1 to 10000 Hz")
    if wishes.up and ending != ".bvh":
        raise InputError(f"--up={wishes.up}: is for .bvh; other files leave no doubt")
    if wishes.skeleton and ending != ".amc":
        raise InputError(f"--skeleton={wishes.skeleton}: is for .amc; others have their own")
    if wishes.model and ending not in (".npz", ".csv"):
        raise InputError(f"--model={wishes.model}: is for .npz and .csv")
    if ending == ".bvh":
        capture = read_bvh(path, wishes.joints)
    elif ending == ".amc":
        capture = read_amc(path, wishes.skeleton or skeleton_of(path), rate or RATE)
    elif ending in (".txt", ".json"):
        capture = read_deepmimic(path)
    elif ending == ".npz" and not wishes.model:
        capture = read_smpl(path)
    elif ending in (".npz", ".csv"):
        capture = read_joints(path, wishes.model, rate)
    elif ending in PICKLES:
        raise InputError(
            f"{path}: a pickle can run any program when it is read; save its arrays with "
            "numpy.savez and import the .npz"
        )
    else:
        raise InputError(f"{path}: unknown kind of file, valid: {FORMATS}")
    if rate is None:
        return capture
    return replace(capture, time=np.arange(len(capture.time)) / rate)
