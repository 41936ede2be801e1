"""Where a foreign humanoid's right side is not the mirror image of its left.

A character has its limbs once, as the left ones are. What the right ones have otherwise is lost,
and told.
"""

from collections.abc import Iterator, Mapping

import mujoco
import numpy as np

from rotctl.adopting.tree import Segment
from rotctl.maths.rotations import dot, length

PLACE = 0.01  # [m] apart, from which it is told
TURN = 0.05  # [rad] of a range or an axis
SHARE = 0.05  # [-] of a mass or a torque


def unlike(mj: mujoco.MjModel, segments: Mapping[int, Segment]) -> list[str]:
    """One line on each pair of bodies that are no mirror images; empty where all are."""
    left = {s.name: s for s in segments.values() if s.side == "left"}
    right = {s.name: s for s in segments.values() if s.side == "right"}
    found = []
    for name, one in left.items():
        other = right.get(name)
        what = list(_differing(mj, segments, one, other)) if other else ["is not there"]
        if what:
            found.append(
                f"the right {name} differs from the left one ({', '.join(what)}): it is taken as "
                "the left one's mirror image"
            )
    return found


def _differing(
    mj: mujoco.MjModel, segments: Mapping[int, Segment], left: Segment, right: Segment
) -> Iterator[str]:
    mirror = np.array([1.0, -1.0, 1.0])
    masses = mj.body_mass[[left.body, right.body]]
    if _apart(*masses):
        yield "{:.2f} and {:.2f} kg".format(*masses)
    places = [s.origin - segments[s.parent].origin for s in (left, right) if s.parent >= 0]
    if len(places) == 2 and length(places[0] - mirror * places[1]) > PLACE:
        yield "another place"
    if len(left.hinges) != len(right.hinges):
        yield "other joints"
        return
    for one, other in zip(left.hinges, right.hinges, strict=True):
        axis = -mirror * one.axis  # a pseudo-vector: in a mirror its in-plane part changes sign
        way = 1.0 if dot(axis, other.axis) >= 0.0 else -1.0
        ends = sorted((way * other.low, way * other.high))
        if length(axis - way * other.axis) > TURN:
            yield f"the axis of {other.source}"
        elif max(abs(one.low - ends[0]), abs(one.high - ends[1])) > TURN:
            yield f"the range of {other.source}"
        elif one.torque and other.torque and _apart(one.torque, other.torque):
            yield f"the torque of {other.source}"


def _apart(one: float, other: float) -> bool:
    return abs(one - other) > SHARE * max(one, other)
