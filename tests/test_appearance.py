"""What people see of a roll, on logs made by hand and against MuJoCo's own kinematics."""

from functools import cache

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics import appearance
from rotctl.metrics import capsules as capsule_module
from rotctl.metrics import skeleton as skeletons
from rotctl.metrics.capsules import Capsules, overlap
from rotctl.metrics.skeleton import Skeleton, _compiled, _reference
from rotctl.native import library
from rotctl.runs.scenario import model_of

PERIOD = 1.0 / 60.0
WEIGHT = 70.0 * 9.81
RNG = np.random.default_rng(3)


@cache
def adult():
    return model_of(load(["behaviour=forward_roll_1"])).mj


def body(name):
    return adult().body(name).id


def random_states(rows):
    mj = adult()
    qpos = RNG.uniform(-1.0, 1.0, (rows, mj.nq))
    qpos[:, 3:7] /= np.sqrt((qpos[:, 3:7] ** 2).sum(axis=1, keepdims=True))
    return qpos


# ---------------------------------------------------------------- kinematics


def test_bodies_are_where_mujoco_has_them():
    mj, qpos = adult(), random_states(5)
    data, skeleton = mujoco.MjData(mj), Skeleton(mj, qpos)
    capsules = [g for g in range(mj.ngeom) if mj.geom_contype[g] and mj.geom_bodyid[g]]
    found = skeleton.capsules(capsules)
    for row, state in enumerate(qpos):
        data.qpos[:] = state
        mujoco.mj_kinematics(mj, data)
        for number in range(1, mj.nbody):
            origin = skeleton.origin(number)[row]
            np.testing.assert_allclose(origin, data.xpos[number], atol=1e-12)
        middles = found.ends[:, :, row].mean(axis=1)
        np.testing.assert_allclose(middles, data.geom_xpos[capsules], atol=1e-12)
        along = found.ends[:, 0, row] - middles
        half = np.where(mj.geom_type[capsules] == 3, mj.geom_size[capsules, 1], 0.0)
        axis = data.geom_xmat[capsules].reshape(-1, 3, 3)[:, :, 2]
        np.testing.assert_allclose(along, half[:, None] * axis, atol=1e-12)


@pytest.mark.skipif(not library(), reason="there is no C compiler")
@pytest.mark.parametrize("terrain", ["flat", "hazards"])  # which has loose boxes
def test_compiled_places_and_turns_have_the_bits_of_the_reference(terrain):
    mj = model_of(load(["behaviour=forward_roll_1", f"terrain={terrain}"])).mj
    qpos = RNG.uniform(-3.0, 3.0, (7, mj.nq))
    for found, wanted in zip(_compiled(mj, qpos), _reference(mj, qpos), strict=True):
        np.testing.assert_array_equal(found, wanted)


@pytest.mark.skipif(not library(), reason="there is no C compiler")
@pytest.mark.parametrize("every", [1, 4])
def test_compiled_ends_and_overlaps_have_the_bits_of_the_reference(monkeypatch, every):
    mj, qpos = adult(), RNG.uniform(-1.5, 1.5, (30, adult().nq))
    limbs, trunk, pairs = appearance._apart(mj)
    both = []
    for there in (library(), None):
        for module in (skeletons, capsule_module):
            monkeypatch.setattr(module, "library", lambda there=there: there)
        body = Skeleton(mj, qpos)
        both.append([body.capsules(geoms, every) for geoms in (limbs, trunk)])
        both[-1].append(
            [overlap(*both[-1], [pair]) for pair in pairs] + [overlap(*both[-1], pairs)]
        )
    (*compiled, deep), (*reference, wanted) = both
    for found, known in zip(compiled, reference, strict=True):
        np.testing.assert_array_equal(found.ends, known.ends)
    assert deep == wanted
    assert 0 < sum(each > 0.0 for each in deep) < len(deep)


def test_some_rows_are_those_rows():
    qpos = random_states(9)
    few, all_of_them = (Skeleton(adult(), qpos).capsules([5], every) for every in (4, 1))
    np.testing.assert_array_equal(few.ends, all_of_them.ends[:, :, ::4])


def capsule(start, end, radius):
    return Capsules(np.zeros(1, dtype=np.int32), np.array([[[start], [end]]]), np.array([radius]))


@pytest.mark.parametrize(
    ("one", "other", "deep"),
    [
        (([0.0, 0, 0], [2.0, 0, 0]), ([1.0, 0.3, -1], [1.0, 0.3, 1]), 0.1),  # crossing
        (([0.0, 0, 0], [2.0, 0, 0]), ([0.5, 0.2, 0], [1.0, 0.2, 0]), 0.2),  # side by side
        (([0.0, 0, 0], [2.0, 0, 0]), ([2.3, 0, 0], [5.0, 0, 0]), 0.1),  # end to end
        (([1.0, 1, 0], [1.0, 1, 0]), ([0.0, 0.7, 0], [2.0, 0.7, 0]), 0.1),  # a sphere
        (([1.0, 1, 0], [1.0, 1, 0]), ([1.0, 1.1, 0], [1.0, 1.1, 0]), 0.3),  # two of them
        (([0.0, 0, 0], [2.0, 0, 0]), ([0.0, 0.5, 0], [2.0, 0.5, 0]), 0.0),  # apart
        (([0.0, 0, 0], [1.0, 0, 0]), ([1.2, 0.1, 0], [1.2, 3.0, 0]), 0.4 - 0.05**0.5),
    ],
)
def test_overlap_of_capsules(one, other, deep):
    first, second = capsule(*one, 0.15), capsule(*other, 0.25)
    assert overlap(first, second, [(0, 0)]) == pytest.approx(deep)
    assert overlap(second, first, [(0, 0)]) == pytest.approx(deep)
    assert overlap(first, second, []) == 0.0


def test_the_nearest_points_of_capsules_are_those_of_a_search():
    ends = RNG.uniform(-1.0, 1.0, (2, 40, 2, 1, 3))
    body = np.zeros(40, dtype=np.int32)
    one, other = (Capsules(body, part, np.full(40, 2.0)) for part in ends)
    share = np.linspace(0.0, 1.0, 201)[:, None]
    for i in range(40):
        p, q = ((1 - share) * part.ends[i, 0] + share * part.ends[i, 1] for part in (one, other))
        nearest = np.sqrt(((p[:, None] - q[None]) ** 2).sum(axis=2).min())
        assert overlap(one, other, [(i, i)]) == pytest.approx(4.0 - nearest, abs=1e-2)


# ---------------------------------------------------------------- who bears it


def roll(steps=240, turns=4.0, contacts=(), height=0.85, about="left"):
    """A rigid body that turns `turns` times forwards, its pelvis at a height [m].

    Contacts are (body, rows, upward force [N]); a forearm's is at its hand.
    """
    mj = adult()
    phase = 2 * np.pi * turns * np.arange(steps) / (steps - 1)
    sign = 1.0 if about == "left" else -1.0
    qpos = np.zeros((steps, mj.nq))
    qpos[:, 2] = height
    qpos[:, 3], qpos[:, 5] = np.cos(phase / 2), sign * np.sin(phase / 2)
    axes = np.zeros((steps, 3, 3))
    axes[:, 0, 0], axes[:, 2, 0] = np.cos(phase), -sign * np.sin(phase)
    axes[:, 0, 2], axes[:, 2, 2] = sign * np.sin(phase), np.cos(phase)
    axes[:, 1, 1] = 1.0
    slots = max(len(contacts), 1)
    bodies = np.full((steps, slots), -1, dtype=np.int32)
    force = np.zeros((steps, slots, 3), dtype=np.float32)
    place = np.zeros((steps, slots, 3), dtype=np.float32)
    skeleton = Skeleton(mj, qpos)
    for slot, (name, rows, up) in enumerate(contacts):
        bodies[rows, slot] = body(name)
        force[rows, slot, 2] = up
        if name.startswith("forearm"):
            hand = mj.geom("hand" + name[-2:]).id
            place[rows, slot] = skeleton.capsules([hand]).ends[0, 0][rows]
    joints = [mj.joint(i).name.encode() for i in range(1, mj.njnt)]
    return {
        "trajectory/qpos": qpos,
        "trajectory/phase": phase,
        "trajectory/trunk_axes": axes,
        "trajectory/trunk_axis": np.tile([0.0, sign, 0.0], (steps, 1)),
        "trajectory/com": qpos[:, :3],
        "trajectory/ground_height": np.zeros(steps),
        "command/axes": np.tile(np.eye(3), (steps, 1, 1)),
        "contacts/body": bodies,
        "contacts/force_realised": force,
        "contacts/force_peak": 2.0 * force[:, :, 2],
        "contacts/position": place,
        "contacts/ground_force": force.sum(axis=1).astype(float) + [0.0, 0.0, 100.0],
        "contacts/ground_force_peak": 3.0 * force.sum(axis=1)[:, 2].astype(float) + 300.0,
        "model/joint": np.array(joints),
    }


def looks(log):
    return appearance.measure(log, adult(), 1.0, PERIOD)


def test_the_head_s_share_and_peak():
    found = looks(roll(contacts=[("head", slice(0, 240), 25.0), ("chest", slice(0, 240), 75.0)]))
    assert found.head_share == pytest.approx(25.0 / 200.0)
    assert found.head_peak == pytest.approx(50.0 / WEIGHT, rel=1e-4)
    assert found.force_peak == pytest.approx(600.0 / WEIGHT, rel=1e-4)
    assert found.force_p99 == pytest.approx(200.0 / WEIGHT, rel=1e-4)


def test_the_sustained_force_is_the_largest_of_the_means():
    """A blow of one row: a percentile does not see it, and the peak is a physics step's."""
    found = looks(
        roll(contacts=[("chest", slice(120, 121), 900.0), ("chest", slice(0, 240), 50.0)])
    )
    assert found.force_sustained == pytest.approx(1050.0 / WEIGHT, rel=1e-4)
    assert found.force_p99 < found.force_sustained < found.force_peak


def arrivals(log):
    """Rows in which the head comes within 10 cm of the ground, one a revolution."""
    skull = adult().geom("head").id
    skeleton = Skeleton(adult(), log["trajectory/qpos"])
    height = skeleton.capsules([skull]).ends[0, 0, :, 2] - 0.105
    down = height < 0.1
    return np.flatnonzero(down[1:] & ~down[:-1]) + 1


@pytest.mark.parametrize(
    ("before", "after", "load", "share"),
    [
        (6, 0, 0.06 * WEIGHT, 1.0),
        (6, 0, 0.04 * WEIGHT, 0.0),  # they only touch
        (30, -10, 0.5 * WEIGHT, 0.0),  # they were there and have left
        (-1, 20, 0.5 * WEIGHT, 0.0),  # they come after the head
        (2, 0, 0.12 * WEIGHT, 1.0),  # half of the time, and twice as much
    ],
)
def test_hands_bear_before_the_head_of_a_forward_roll(before, after, load, share):
    bare = roll()
    rows = np.concatenate([np.arange(a - before, a + after + 1) for a in arrivals(bare)])
    assert len(arrivals(bare)) == 4
    assert looks(bare).hands_bear == 0.0
    found = looks(roll(contacts=[("forearm_l", rows, load)]))
    assert found.hands_bear == pytest.approx(share)


def test_each_revolution_counts_for_itself():
    rows = np.concatenate([np.arange(a - 6, a + 1) for a in arrivals(roll())[:1]])
    log = roll(contacts=[("forearm_l", rows, 30.0), ("forearm_r", rows, 30.0)])
    assert looks(log).hands_bear == pytest.approx(1 / 4)


def test_an_elbow_is_no_hand():
    log = roll(contacts=[("forearm_l", slice(0, 240), 500.0)])
    assert looks(log).hands_bear == 1.0
    log["contacts/position"] = log["contacts/position"] + np.float32([0.0, 0.1, 0.0])
    assert looks(log).hands_bear == 0.0


def test_hands_of_a_backward_roll_bear_while_it_is_upside_down():
    upside_down = np.cos(roll()["trajectory/phase"]) < -0.5
    for rows, share in ((upside_down, 1.0), (~upside_down, 0.0)):
        log = roll(contacts=[("forearm_r", rows, 0.06 * WEIGHT)], about="right")
        assert looks(log).hands_bear == share


@pytest.mark.parametrize("fall", [0.0, 0.2, -0.2])
def test_a_head_s_height_is_above_the_ground_that_it_is_over(fall):
    """Down or up a slope, half a metre ahead of where it is logged, and as high as on the level."""
    log = roll()
    phase, way = log["trajectory/phase"], np.linspace(0.0, 8.0, 240)
    ahead = 0.69 * np.sin(phase)  # of the head, before the pelvis
    for name in ("trajectory/qpos", "trajectory/com"):
        log[name] = log[name].copy()
        log[name][:, 0] += way
    log["trajectory/qpos"][:, 2] -= fall * (way + ahead)
    log["trajectory/ground_height"] = -fall * way
    level, skeleton = roll()["trajectory/qpos"], Skeleton(adult(), log["trajectory/qpos"])
    wanted = appearance._height_of_head(roll(), adult(), Skeleton(adult(), level))
    found = appearance._height_of_head(log, adult(), skeleton)
    inside = (way + ahead > 0.0) & (way + ahead < 8.0)
    np.testing.assert_allclose(found[inside], wanted[inside], atol=0.003 + 0.02 * abs(fall))


# ---------------------------------------------------------------- how tight it is


def test_the_tuck_is_that_of_the_moment_upside_down():
    log = roll()
    names = [name.decode() for name in log["model/joint"]]
    upside_down = np.cos(log["trajectory/phase"]) < -0.99
    for name, angle in {"hip_y_l": 1.0, "hip_y_r": 2.0, "knee_l": 2.2, "knee_r": 2.2}.items():
        log["trajectory/qpos"][upside_down, 7 + names.index(name)] = angle
    found = looks(log)
    assert found.tuck_hip == pytest.approx(np.degrees(1.5))
    assert found.tuck_knee == pytest.approx(np.degrees(2.2))


def test_knees_hang_below_the_hips():
    assert looks(roll()).knees_apart == pytest.approx(0.2)


def test_a_thigh_in_the_belly():
    log = roll()
    names = [name.decode() for name in log["model/joint"]]
    for side in ("_l", "_r"):  # arms that hang touch the hips
        log["trajectory/qpos"][:, 7 + names.index("shoulder_x" + side)] = 0.5
    assert looks(log).limb_overlap == 0.0
    log["trajectory/qpos"][120:128, 7 + names.index("hip_y_l")] = 2.9
    assert looks(log).limb_overlap > 0.05


# ---------------------------------------------------------------- what is not there


def test_a_log_roll_goes_over_no_head():
    log = roll()
    log["trajectory/trunk_axes"][:, 2, 2] = 0.0
    found = looks(log)
    assert np.isnan([found.hands_bear, found.tuck_hip, found.tuck_knee]).all()
    assert found.head_share == 0.0


def test_without_a_model_or_rows_or_such_limbs_nothing_is_seen():
    empty = {name: rows[:0] for name, rows in roll().items()}
    bare = mujoco.MjModel.from_xml_string("<mujoco><worldbody><body/></worldbody></mujoco>")
    for log, mj in ((roll(), None), (empty, adult()), (roll(), bare)):
        found = appearance.measure(log, mj, 1.0, PERIOD)
        assert np.isnan(list(vars(found).values())).all()


# ---------------------------------------------------------------- over one shoulder


ACROSS = (
    ("forearm_r", slice(125, 130), 0.2 * WEIGHT),  # at its hand
    ("elbow", slice(130, 136), 0.2 * WEIGHT),  # of the same forearm
    ("chest", slice(138, 146), 0.8 * WEIGHT),
    ("pelvis", slice(150, 160), 0.8 * WEIGHT),
)


def crossing(parts=ACROSS, shoulder=-0.1, hip=0.1, above=0.0, moved=0.0):
    """A revolution in which parts bear one after the other, at so much to the left [m].

    An upper arm bears so far above its elbow; as its hand comes down, the body moves on [m].
    """
    named = [("forearm_r" if name == "elbow" else name, rows, up) for name, rows, up in parts]
    log = roll(steps=240, turns=2.0, contacts=named, height=0.85)
    landing = ACROSS[0][1].start
    log["trajectory/qpos"][landing + 1 :, 0] += moved
    log["contacts/position"][landing:, :, 0] += moved  # noted in the middle of its step
    skeleton = Skeleton(adult(), log["trajectory/qpos"])
    elbow = skeleton.origin(body("forearm_r"))
    upwards = skeleton.origin(body("upper_arm_r")) - elbow
    upwards /= np.sqrt((upwards**2).sum(axis=1, keepdims=True))
    for slot, (name, rows, _) in enumerate(parts):
        place = log["contacts/position"]
        if name in ("elbow", "upper_arm_r"):
            place[rows, slot] = (elbow + above * upwards)[rows]
        elif name in ("chest", "pelvis"):
            aside = {"chest": shoulder, "pelvis": hip}[name]
            place[rows, slot] = skeleton.origin(body(name))[rows] + [0.0, aside, 0.0]
    return 2.0 * looks(log).across  # nothing bears in the first of two revolutions


def swapped(first, second):
    parts = list(ACROSS)
    rows = [part[1] for part in parts]
    rows[first], rows[second] = rows[second], rows[first]
    return [(name, at, up) for (name, _, up), at in zip(parts, rows, strict=True)]


def test_across_the_back_is_from_an_arm_to_the_other_hip():
    assert crossing() == 1.0
    assert crossing(hip=-0.1) == 0.0, "down one side"
    assert crossing(shoulder=0.1) == 0.0, "the other shoulder"
    assert crossing(shoulder=0.0) == 0.0, "down the middle"
    for pair in ((0, 1), (1, 2), (2, 3)):
        assert crossing(swapped(*pair)) == 0.0, pair
    for missing in range(4):
        assert crossing([part for i, part in enumerate(ACROSS) if i != missing]) == 0.0
    assert crossing([*ACROSS, ("head", slice(137, 139), 1.1 * WEIGHT)]) == 0.0, "over the crown"
    assert crossing([*ACROSS, ("head", slice(137, 139), 0.5 * WEIGHT)]) == 1.0


def test_the_end_of_an_upper_arm_is_the_elbow_and_no_shoulder():
    leaning = [("upper_arm_r" if part[0] == "elbow" else part[0], *part[1:]) for part in ACROSS]
    assert crossing(leaning, above=0.05) == 1.0
    assert crossing(leaning, above=0.09) == 0.0, "the shoulder, and never the forearm"
    both = [("upper_arm_r", slice(128, 130), 0.2 * WEIGHT), *ACROSS]
    assert crossing(both, above=0.09) == 0.0, "the shoulder before the forearm"


def test_a_hand_that_comes_down_quickly_is_no_forearm():
    assert crossing(moved=0.09) == 1.0, "in its first row it is where the hand will be"
    assert crossing(moved=0.2) == 1.0
