"""Poses to track: key poses or a reference clip over the phase of a cycle."""

from rotctl.motion.clip import Clip, RollAbout, load_clip
from rotctl.motion.pose_pair import (
    Angle,
    FourierSeries,
    PosePair,
    Poses,
    Turn,
    make_pose,
    make_pose_pair,
    over_phase,
)
from rotctl.motion.reference import ReferencePair, ReferenceSettings, make_reference_pair

__all__ = [
    "FourierSeries",
    "Angle",
    "Clip",
    "PosePair",
    "Poses",
    "ReferencePair",
    "ReferenceSettings",
    "RollAbout",
    "Turn",
    "load_clip",
    "make_pose",
    "make_pose_pair",
    "make_reference_pair",
    "over_phase",
]
