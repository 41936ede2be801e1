"""What people see of a roll: who bears it, how tight it is, whether limbs keep out of the trunk."""

import math
from dataclasses import dataclass, fields

import mujoco
import numpy as np

from rotctl.caching import kept
from rotctl.maths.rotations import Array
from rotctl.metrics import across
from rotctl.metrics.across import BEARING, HEAD, SIDES, at_hands
from rotctl.metrics.capsules import overlap
from rotctl.metrics.columns import Arrays, Column, floats, in_frame, slots_taken
from rotctl.metrics.loads import loads
from rotctl.metrics.quantile import median, percentile
from rotctl.metrics.skeleton import ROUND, Skeleton

COLUMNS = (
    Column("head_share", "Head's share of the ground's upward impulse", ""),
    Column("head_peak", "Head's ground force, peak", "body weights"),
    Column("hands_bear", "Revolutions in which the hands bear as the head comes", ""),
    Column("across", "Revolutions from hand over shoulder to the other hip", ""),
    Column("force_p99", "Ground force, 99th percentile", "body weights"),
    Column("force_peak", "Ground force, peak", "body weights"),
    Column("force_sustained", "Ground force, largest mean over a control step", "body weights"),
    Column("tuck_hip", "Hips bent while upside down", "deg"),
    Column("tuck_knee", "Knees bent while upside down", "deg"),
    Column("knees_apart", "Knees apart, 95th percentile", "m"),
    Column("limb_overlap", "Deepest overlap of a limb and the trunk", "m"),
)
LIMBS = ("upper_arm", "forearm", "thigh", "shin")
TRUNK = ("pelvis", "waist", "chest", HEAD)
NEAR = 0.10  # [m] above the ground, where a head has come down
BEFORE = 0.1  # [s] before that, in which hands should bear
INVERTED = -0.5  # [-] the trunk's up along the world's: 120 degrees over
EVERY = 4  # rows, of which one is looked at for overlap: limbs are slow


@dataclass(frozen=True)
class Appearance:
    """What people see of a roll; NaN where a character or a roll has no such thing.

    Attributes:
        head_share: of the ground's upward impulse.
        head_peak: largest force on the head in a physics step [body weights].
        hands_bear: share of the whole revolutions in which hands bear 5 % of the weight, in the
            mean: of a forward roll over the 0.1 s before the head is 10 cm above the ground, of
            a backward roll while the trunk is upside down.
        across: share of the whole revolutions that go over one shoulder, see `metrics.across`.
        force_p99, force_peak: of the whole ground force, as in `RollingMetrics` [body weights].
        force_sustained: its largest mean over a control step: as a force plate shows it whose
            signal is filtered at about 27 Hz, for control at 60 Hz [body weights].
        tuck_hip, tuck_knee: bend of both sides where the trunk is most upside down, median over
            the revolutions [deg].
        knees_apart: from middle to middle, 95th percentile [m].
        limb_overlap: deepest of a limb and the trunk or head that it does not hang on [m].
    """

    head_share: float
    head_peak: float
    hands_bear: float
    across: float
    force_p99: float
    force_peak: float
    force_sustained: float
    tuck_hip: float
    tuck_knee: float
    knees_apart: float
    limb_overlap: float


NOTHING = Appearance(*[math.nan] * len(fields(Appearance)))


def measure(log: Arrays, mj: mujoco.MjModel | None, commanded: float, period: float) -> Appearance:
    """Look at a roll.

    Args:
        log: arrays by schema path; may have no rows.
        mj: what was simulated; without it nothing is seen.
        commanded: in-plane angular velocity [rev/s]; its sign is the direction of progress.
        period: of the control [s].
    """
    qpos = floats(log, "trajectory/qpos")
    body = _bodies(mj) if mj is not None else {}
    if mj is None or not len(qpos) or not body:
        return NOTHING
    skeleton = Skeleton(mj, qpos)
    weight = _weight(mj)
    ground = floats(log, "contacts/ground_force")
    force = np.sqrt((ground**2).sum(axis=1))
    upward = float(ground[:, 2].sum())
    head, head_peak = _load_of_head(log, body[HEAD])
    knees = skeleton.origin(body["shin_l"]) - skeleton.origin(body["shin_r"])
    return Appearance(
        head_share=float(head.sum()) / upward if upward > 0.0 else math.nan,
        head_peak=head_peak / weight,
        force_p99=percentile(force, 99) / weight,
        force_peak=float(floats(log, "contacts/ground_force_peak").max()) / weight,
        force_sustained=float(force.max()) / weight,
        knees_apart=percentile(np.sqrt((knees**2).sum(axis=1)), 95),
        limb_overlap=_overlap(mj, skeleton),
        **_over_the_head(log, mj, skeleton, -1.0 if commanded < 0 else 1.0, period),
    )


def _over_the_head(
    log: Arrays, mj: mujoco.MjModel, skeleton: Skeleton, direction: float, period: float
) -> dict[str, float]:
    """The members of `Appearance` that are about how the body goes over its head."""
    axes = floats(log, "trajectory/trunk_axes")
    up = axes[:, 2, 2]
    found = [
        rows
        for rows in _revolutions(direction * floats(log, "trajectory/phase"))
        if up[rows].min() < INVERTED
    ]
    if not found:
        return dict.fromkeys(("hands_bear", "across", "tuck_hip", "tuck_knee"), math.nan)
    all_of_them, height = loads(log), _height_of_head(log, mj, skeleton)
    at = at_hands(mj, skeleton, all_of_them)
    hands = all_of_them.on(at[0], all_of_them.up) + all_of_them.on(at[1], all_of_them.up)
    left = (axes[:, :, 1] * floats(log, "trajectory/trunk_axis")).sum(axis=1)
    forward = direction * median(left) > 0.0
    arms = []
    for rows in found:
        down = height[rows] < NEAR
        arrival = rows.start + int(np.argmax(down) if down.any() else np.argmin(height[rows]))
        before = slice(max(0, arrival - round(BEFORE / period)), arrival + 1)
        arms.append(float((hands[before] if forward else hands[rows][up[rows] < INVERTED]).mean()))
    lowest = [rows.start + int(np.argmin(up[rows])) for rows in found]
    return {
        "across": across.share(log, skeleton, all_of_them, at, _bodies(mj), _weight(mj), found),
        "hands_bear": sum(load >= BEARING * _weight(mj) for load in arms) / len(arms),
        "tuck_hip": _bend(log, "hip_y", lowest),
        "tuck_knee": _bend(log, "knee", lowest),
    }


@kept(most=8)
def _bodies(mj: mujoco.MjModel) -> dict[str, int]:
    """Ids of the bodies looked at, by name; none if the character lacks one."""
    names = (*TRUNK, *(limb + side for limb in LIMBS for side in SIDES))
    ids = {n: int(mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_BODY, n)) for n in names}
    hands = [mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_GEOM, "hand" + side) for side in SIDES]
    return ids if min(*ids.values(), *hands) >= 0 else {}


def _weight(mj: mujoco.MjModel) -> float:
    """Of the character [N]; that of its mass on Earth where nothing pulls it down."""
    return float(mj.body_subtreemass[1]) * (float(-mj.opt.gravity[2]) or 9.81)


def _revolutions(phase: Array) -> list[slice]:
    """Rows of every whole revolution from phase 0 [rad], where the pelvis is upright."""
    furthest = np.maximum.accumulate(phase) / (2 * math.pi)
    marks = np.arange(math.ceil(furthest[0]), math.floor(furthest[-1]) + 1)
    edges = np.searchsorted(furthest, marks).tolist()
    return [slice(a, b) for a, b in zip(edges, edges[1:], strict=False) if b > a]


def _load_of_head(log: Arrays, head: int) -> tuple[Array, float]:
    """Upward force (n,), and the largest of a contact in a physics step [N]."""
    some = slots_taken(log)
    there = np.asarray(log["contacts/body"])[:, :some] == head
    up = np.asarray(log["contacts/force_realised"])[:, :some, 2].astype(float)
    peak = np.asarray(log["contacts/force_peak"])[:, :some].astype(float)
    return np.where(there, up, 0.0).sum(axis=1), float(np.where(there, peak, 0.0).max(initial=0.0))


def _height_of_head(log: Arrays, mj: mujoco.MjModel, skeleton: Skeleton) -> Array:
    """Lowest point (n,) of the head above the ground [m].

    The ground under a head is what the log has below the centre of mass where that passed there.
    """
    head = mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_BODY, HEAD)
    shape = skeleton.capsules(_geoms(mj, [head]))
    lowest = (shape.ends[..., 2].min(axis=1) - shape.radius[:, None]).min(axis=0)
    ground = floats(log, "trajectory/ground_height")
    if (ground == ground[0]).all():
        return np.asarray(lowest - ground)
    way = np.maximum.accumulate(in_frame(log, "trajectory/com")[:, 0])
    forward = floats(log, "command/axes")[0, 0]
    along = (shape.ends[0, 0] * forward).sum(axis=1)
    return np.asarray(lowest - np.interp(along, way, ground))


def _overlap(mj: mujoco.MjModel, skeleton: Skeleton) -> float:
    limbs, trunk, pairs = _apart(mj)
    return overlap(skeleton.capsules(limbs, EVERY), skeleton.capsules(trunk, EVERY), pairs)


@kept(most=8)
def _apart(mj: mujoco.MjModel) -> tuple[list[int], list[int], list[tuple[int, int]]]:
    """Geoms of the limbs and of the trunk, and which of both should keep apart."""
    body = _bodies(mj)
    limbs = _geoms(mj, [body[limb + side] for limb in LIMBS for side in SIDES])
    trunk = _geoms(mj, [body[part] for part in TRUNK])
    hangs_on = mj.body_parentid[mj.geom_bodyid[limbs]]
    apart = hangs_on[:, None] != mj.geom_bodyid[trunk][None]
    return limbs, trunk, [(int(i), int(k)) for i, k in zip(*np.nonzero(apart), strict=True)]


def _geoms(mj: mujoco.MjModel, bodies: list[int]) -> list[int]:
    """The round geoms of bodies that touch things, others being only seen."""
    solid = np.isin(mj.geom_bodyid, bodies) & np.isin(mj.geom_type, ROUND)
    found: list[int] = np.flatnonzero(solid & (mj.geom_contype != 0)).tolist()
    return found


def _bend(log: Arrays, joint: str, rows: list[int]) -> float:
    """Median over rows of the mean of a joint's both sides [deg]; NaN if it is not there."""
    names = [name.decode() for name in np.asarray(log["model/joint"]).tolist()]
    if any(joint + side not in names for side in SIDES):
        return math.nan
    columns = [7 + names.index(joint + side) for side in SIDES]  # after the root's
    bend = floats(log, "trajectory/qpos")[rows][:, columns].mean(axis=1)
    return float(np.degrees(median(bend)))
