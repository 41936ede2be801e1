"""A roll over one shoulder, read off the contacts: hand, forearm, that shoulder, the other hip."""

import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays
from rotctl.metrics.loads import Loads
from rotctl.metrics.skeleton import Skeleton

HEAD, SIDES = "head", ("_l", "_r")
BEARING = 0.05  # [body weights] that a part bears, and does not only touch
HAND = 0.07  # [m] from the middle of a hand: contacts of a forearm that are the hand's
ELBOW = 0.07  # [m] from the elbow: contacts of an upper arm that are the forearm's
ASIDE = 0.03  # [m] from the middle of the back: nearer it is of no side
CROWN = 1.0  # [body weights] on the head: from there on the roll goes over it
TRUNK = {"shoulder": "chest", "hip": "pelvis"}
ORDER = ("hand", "forearm", "shoulder", "hip")


def share(
    log: Arrays,
    skeleton: Skeleton,
    all_of_them: Loads,
    hands: NDArray[np.bool_],
    body: Mapping[str, int],
    weight: float,
    revolutions: Sequence[slice],
) -> float:
    """Share of revolutions that go across the back; NaN without one.

    Of one side the hand bears first, then its forearm as far as the elbow, then the shoulder
    (the upper arm above the elbow, or chest on that side), then the hip of the other (thigh, or
    pelvis on that side); and the head never bears a whole body's weight before that.

    Args:
        log: arrays by schema path.
        all_of_them: its contacts.
        hands: which of them are a hand's, see `at_hands`.
        body: ids by name.
        weight: of the body [N].
        revolutions: rows of each.
    """
    if not revolutions:
        return math.nan
    loads = _loads(log, skeleton, all_of_them, hands, body, weight)
    gone = [any(_goes(loads, rows, side) for side in (0, 1)) for rows in revolutions]
    return sum(gone) / len(gone)


def _goes(loads: Mapping[str, Array], rows: slice, side: int) -> bool:
    """Whether a revolution goes from the arm of a side, 0 left, over to the other hip."""
    before = 0
    for part in ORDER:
        came = _first(loads[part][rows, 1 - side if part == "hip" else side])
        if came < before or part == "hip" and came == before:
            return False
        before = came
    head = loads[HEAD][rows][:before].max(initial=0.0)
    return bool(before < rows.stop - rows.start and head < CROWN)


def _first(load: Array) -> int:
    """The first row that bears; the number of rows, if none does."""
    bears = load >= BEARING
    first = int(bears.argmax())
    return first if bears[first] else len(bears)


def _loads(
    log: Arrays,
    skeleton: Skeleton,
    all_of_them: Loads,
    hands: NDArray[np.bool_],
    body: Mapping[str, int],
    weight: float,
) -> dict[str, Array]:
    """What hands, forearms, shoulders and hips of both sides bear (n, 2), and the head (n,).

    In body weights.
    """
    found = {part: np.zeros((all_of_them.steps, 2)) for part in ORDER}
    _, row, which, up, place = all_of_them
    load, axes = up / weight, log["trajectory/trunk_axes"]
    on = all_of_them.on
    for side, name in enumerate(SIDES):
        arm, lower = body["upper_arm" + name], body["forearm" + name]
        elbow = _near(all_of_them, which == arm, skeleton.origin(lower), ELBOW)
        found["hand"][:, side] += on(hands[side], load)
        found["forearm"][:, side] += on((which == lower) & ~hands[side] | elbow, load)
        found["shoulder"][:, side] += on((which == arm) & ~elbow, load)
        found["hip"][:, side] += on(which == body["thigh" + name], load)
    for part, middle in TRUNK.items():
        some = np.flatnonzero(which == body[middle])
        left = np.asarray(axes[row[some], :, 1], dtype=float)
        aside = ((place[some] - skeleton.origin(body[middle])[row[some]]) * left).sum(axis=1)
        for side, there in enumerate((aside > ASIDE, aside < -ASIDE)):
            np.add.at(found[part][:, side], row[some][there], load[some][there])
    return found | {HEAD: on(which == body[HEAD], load)}


def at_hands(mj: mujoco.MjModel, skeleton: Skeleton, all_of_them: Loads) -> NDArray[np.bool_]:
    """Which contacts (2, k) of either forearm, left first, are near the middle of its hand."""
    hands = [mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_GEOM, "hand" + side) for side in SIDES]
    middles = skeleton.capsules(hands).ends[:, 0]
    return np.stack(
        [
            _near(all_of_them, all_of_them.body == mj.geom_bodyid[hand], middle, HAND)
            for hand, middle in zip(hands, middles, strict=True)
        ]
    )


def _near(
    all_of_them: Loads, some: NDArray[np.bool_], middle: Array, reach: float
) -> NDArray[np.bool_]:
    """Which of some contacts (k,) are within reach [m] of a place (n, 3) of a limb.

    A contact is noted where it begins, at some time of its control step, in which a hand that
    comes down moves on by 8 cm: where the limb is as the step begins or as it ends counts.
    """
    found = np.zeros(len(some), dtype=bool)
    which = np.flatnonzero(some)
    row, place = all_of_them.row[which], all_of_them.place[which]
    for there in (middle[row], middle[np.minimum(row + 1, len(middle) - 1)]):
        found[which] |= ((place - there) ** 2).sum(axis=1) < reach**2
    return found
