"""A roll over one shoulder, read off the contacts: hand, forearm, that shoulder, the other hip."""

import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.metrics.columns import Arrays, slots_taken
from rotctl.metrics.skeleton import Skeleton
from rotctl.rotations import Array

HEAD, SIDES = "head", ("_l", "_r")
BEARING = 0.05  # [body weights] that a part bears, and does not only touch
HAND = 0.07  # [m] from the middle of a hand: contacts of a forearm that are the hand's
ASIDE = 0.03  # [m] from the middle of the back: nearer it is of no side
CROWN = 1.0  # [body weights] on the head: from there on the roll goes over it
TRUNK = {"shoulder": ("chest", "upper_arm"), "hip": ("pelvis", "thigh")}
ORDER = ("hand", "forearm", "shoulder", "hip")


def share(
    log: Arrays,
    mj: mujoco.MjModel,
    skeleton: Skeleton,
    body: Mapping[str, int],
    weight: float,
    revolutions: Sequence[slice],
) -> float:
    """Share of revolutions that go across the back; NaN without one.

    Of one side the hand bears first, then its forearm, then the shoulder (upper arm, or chest
    on that side), then the hip of the other (thigh, or pelvis on that side); and the head never
    bears a whole body's weight before that.

    Args:
        log: arrays by schema path.
        body: ids by name.
        weight: of the body [N].
        revolutions: rows of each.
    """
    if not revolutions:
        return math.nan
    loads = _loads(log, mj, skeleton, body, weight)
    gone = [any(_goes(loads, rows, side) for side in (0, 1)) for rows in revolutions]
    return sum(gone) / len(gone)


def _goes(loads: Mapping[str, Array], rows: slice, side: int) -> bool:
    """Whether a revolution goes from the arm of a side, 0 left, over to the other hip."""
    came = [_first(loads[part][rows, 1 - side if part == "hip" else side]) for part in ORDER]
    hand, forearm, shoulder, hip = came
    head = loads[HEAD][rows][:hip].max(initial=0.0)
    return bool(hand <= forearm <= shoulder < hip < rows.stop - rows.start and head < CROWN)


def _first(load: Array) -> int:
    """The first row that bears; the number of rows, if none does."""
    bears = load >= BEARING
    return int(np.argmax(bears)) if bears.any() else len(bears)


def _loads(
    log: Arrays, mj: mujoco.MjModel, skeleton: Skeleton, body: Mapping[str, int], weight: float
) -> dict[str, Array]:
    """What hands, forearms, shoulders and hips of both sides bear (n, 2), and the head (n,).

    In body weights.
    """
    which = np.asarray(log["contacts/body"])[:, : slots_taken(log)]
    found = {part: np.zeros((len(which), 2)) for part in ORDER} | {HEAD: np.zeros(len(which))}
    axes = log["trajectory/trunk_axes"]

    def of(name: str) -> tuple[NDArray[np.int64], Array, Array]:
        """Rows, upward forces and places (k, 3) of a body's contacts."""
        rows, slots = np.nonzero(which == body[name])
        up = np.asarray(log["contacts/force_realised"][rows, slots, 2], dtype=float) / weight
        return rows, up, np.asarray(log["contacts/position"][rows, slots], dtype=float)

    for side, name in enumerate(SIDES):
        hand = mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_GEOM, "hand" + name)
        rows, up, place = of("forearm" + name)
        off = place - skeleton.capsules([hand]).ends[0, 0][rows]
        near = (off**2).sum(axis=1) < HAND**2
        np.add.at(found["hand"][:, side], rows[near], up[near])
        np.add.at(found["forearm"][:, side], rows[~near], up[~near])
        for part, (_, limb) in TRUNK.items():
            rows, up, _ = of(limb + name)
            np.add.at(found[part][:, side], rows, up)
    for part, (middle, _) in TRUNK.items():
        rows, up, place = of(middle)
        left = np.asarray(axes[rows, :, 1], dtype=float)
        aside = ((place - skeleton.origin(body[middle])[rows]) * left).sum(axis=1)
        for side, there in enumerate((aside > ASIDE, aside < -ASIDE)):
            np.add.at(found[part][:, side], rows[there], up[there])
    rows, up, _ = of(HEAD)
    np.add.at(found[HEAD], rows, up)
    return found
