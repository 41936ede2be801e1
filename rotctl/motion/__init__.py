"""Poses to track: key poses over the phase of a cycle."""

from rotctl.motion.pose_pair import Angle, PosePair, make_pose_pair

__all__ = ["Angle", "PosePair", "make_pose_pair"]
