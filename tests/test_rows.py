"""Table 1 rolls, and harder ground, a few revolutions here; `make reproduce` judges."""

import re
from itertools import islice

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.facing import FACING
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics import appearance
from rotctl.metrics.criteria.rolling import measure
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.metrics.skeleton import Skeleton
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

LEAST = 1.7  # [rev] in 5 s; the slowest row turns at 0.4 rev/s
ROWS = [
    "forward_roll_1",
    "forward_roll_2",
    "forward_roll_3",
    "backward_roll_1",
    "backward_roll_2",
    "sideways_roll",
    "uneven_terrain",
    "incline",
    "decline",
    "stairs",
]
HARDER = ["high_hills", "steep", "stairs_up", "hazards"]


def rolled(*overrides):
    config = load(["duration=5", *overrides])
    buffer, complaint = in_memory(build(config))
    assert not complaint
    arrays, period = buffer.arrays(), 1.0 / config.controller.rate
    metrics = measure(
        arrays, config.criteria, config.behaviour.angular_velocity, period, whole=True
    )
    return buffer, metrics, failure_reason(metrics, config.criteria, config.duration)


@pytest.mark.parametrize("row", ROWS + HARDER)
def test_it_rolls(row):
    """From three of four starts: single ones fail now and then."""

    def rolls(seed):
        _, metrics, reason = rolled(f"behaviour={row}", f"seed={seed}")
        return metrics.revolutions >= LEAST and not reason

    assert sum(1 for _ in islice(filter(rolls, range(4)), 3)) == 3


@pytest.mark.parametrize("row", ["backward_roll_1", "backward_roll_2"])
def test_who_rolls_backward_pushes_himself_up_over_the_hands(row):
    """Elbows straighten by 40 degrees from 0.5 to 0.74 rev (18 in a roll that only comes over).

    Its hips are 0.6 m over the ground on the way, at 0.6 rev.
    """
    buffer, metrics, _ = rolled(f"behaviour={row}", "seed=2001")
    log = buffer.arrays()
    names = np.asarray(log["model/joint"]).astype(str).tolist()
    elbows = [7 + i for i, name in enumerate(names) if name.startswith("elbow")]
    late = log["trajectory/time"] > 1.5
    turn = (log["trajectory/phase"] / (2.0 * np.pi) % 1.0)[late]
    bent = log["trajectory/qpos"][late][:, elbows].mean(axis=1)
    pelvis = log["trajectory/qpos"][late][:, 2]

    def about(values, phase):
        return float(np.median(values[np.abs(turn - phase) < 0.03]))

    assert metrics.revolutions > 3.0
    assert np.degrees(about(bent, 0.5) - about(bent, 0.74)) > 30.0
    assert about(pelvis, 0.6) > 0.54


@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_about_an_oblique_axis_it_goes_over_the_right_shoulder_to_the_left_loins(physics):
    buffer, _, _ = rolled("behaviour=forward_roll_3", f"physics={physics}", "seed=2000")
    model = build(load(["behaviour=forward_roll_3"])).model.mj
    up = buffer.contacts.force_realised[..., 2].astype(float)

    def on(name):
        return up * (buffer.contacts.body == model.body(name).id)

    def to_the_left(name):
        middle = Skeleton(model, buffer.trajectory.qpos).origin(model.body(name).id)
        left = buffer.trajectory.trunk_axes[:, None, :, 1]
        aside = ((buffer.contacts.position - middle[:, None]) * left).sum(axis=2)
        return float((on(name) * (aside > 0.0)).sum() / on(name).sum())

    assert to_the_left("chest") < 0.5  # of five starts at most 0.34
    assert to_the_left("waist") > to_the_left("chest") + 0.05  # at least 0.13; in lockstep 0.7
    assert on("head").sum() / up.sum() < 0.03
    assert on("forearm_r").sum() / up.sum() > 0.03
    seen = appearance.measure(buffer.arrays(), model, 1.5, 1.0 / 60.0)
    assert seen.across > 0.5  # 1 of all five; over the crown 0


@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_the_backward_roll_goes_over_its_hands(physics):
    """While the trunk is upside down; in backward_roll_1_on_head 0.05, and the head 0.60."""
    buffer, _, _ = rolled("behaviour=backward_roll_2", f"physics={physics}", "seed=2000")
    model = build(load(["behaviour=backward_roll_2"])).model.mj
    over = buffer.trajectory.trunk_axes[:, 2, 2] < -0.5
    assert over.sum() > 60
    up = buffer.contacts.force_realised[..., 2].astype(float)

    def borne(*names):
        there = np.isin(buffer.contacts.body, [model.body(name).id for name in names])
        return float((up * there)[over].sum() / up[over].sum())

    assert borne("forearm_l", "forearm_r") > 0.4
    assert borne("head") < 0.35
    hands = Skeleton(model, buffer.trajectory.qpos[over]).capsules(
        [model.geom(f"hand_{side}").id for side in "lr"]
    )
    assert np.median(hands.ends[..., 2].min(axis=1)) < 0.12


def test_the_backward_roll_sits_back_with_its_feet_down():
    """Without a contact as it does: 0.02 of the time, 0.5 where the height weighs all of 1."""

    def aloft(seed):
        buffer, _, _ = rolled("behaviour=backward_roll_2", f"seed={seed}")
        turned = np.abs(buffer.trajectory.phase) / (2.0 * np.pi)
        sits = (turned > 1.1) & (turned % 1.0 > 0.1) & (turned % 1.0 < 0.2)
        assert sits.sum() > 10
        return (buffer.contacts.count[sits] == 0).mean()

    assert np.mean([aloft(seed) for seed in range(4)]) < 0.25


def test_the_log_roll_stays_long():
    buffer, _, _ = rolled("behaviour=sideways_roll")
    joints = [str(np.char.decode(name)) for name in buffer.model.joint]
    knees = [7 + joints.index(f"knee_{side}") for side in "lr"]
    assert np.abs(buffer.trajectory.qpos[:, knees]).mean() < 0.35  # [rad]


def test_the_log_roll_keeps_its_legs_and_its_arms_together():
    """Between middles: knees touch at 0.15 m, shoulders are 0.45 m apart."""
    buffer, metrics, _ = rolled("behaviour=sideways_roll", "seed=2003")
    assert metrics.revolutions >= LEAST
    model = build(load(["behaviour=sideways_roll"])).model.mj
    skeleton = Skeleton(model, buffer.trajectory.qpos)
    shins = [skeleton.origin(model.body(f"shin_{side}").id) for side in "lr"]
    hands = skeleton.capsules([model.geom(f"hand_{side}").id for side in "lr"]).ends[:, 0]
    assert np.percentile(np.linalg.norm(shins[0] - shins[1], axis=1), 95) < 0.19
    assert np.percentile(np.linalg.norm(hands[0] - hands[1], axis=1), 95) < 0.35


def test_the_log_roll_is_laid_on_the_ground():
    """Its centre of mass is as high as that of who lies there: it is not dropped."""
    for seed in range(2000, 2004):
        buffer, _, _ = rolled("behaviour=sideways_roll", f"seed={seed}", "duration=0.1")
        assert buffer.trajectory.com[0, 2] < 0.27


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["behaviour=reference_roll", "behaviour.roll_about=right"],
            "behaviour.reference.clip=forward_roll_2: rolls about left, "
            "but behaviour.roll_about=right",
        ),
        (
            ["behaviour=reference_roll", "behaviour.reference.clip=no"],
            "no: no such clip; valid: backward_roll, ",
        ),
    ],
)
def test_a_clip_that_does_not_fit(overrides, message):
    with pytest.raises(InputError, match=re.escape(message)):
        build(load(overrides))


def test_poses_or_a_reference():
    with pytest.raises(InputError, match="give either poses or a reference, not both and not nei"):
        load(["behaviour=reference_roll", "~behaviour.reference"])


@pytest.mark.parametrize(
    "row", ["forward_roll_2", "backward_roll_2", "sideways_roll", "incline", "decline"]
)
def test_the_phase_keeps_to_the_trunk(row):
    """Against the turn of the spine's bodies, from the logged positions alone."""
    scenario = build(load([f"behaviour={row}", "duration=10"]))
    model, buffer = scenario.model, in_memory(scenario)[0]
    data = mujoco.MjData(model.mj)
    facing = FACING[scenario.config.behaviour.roll_about]
    upright = Rotation.from_quat(facing.orientation, scalar_first=True)
    missing = []
    for position, phase in zip(
        buffer.trajectory.qpos[-200:], buffer.trajectory.phase[-200:], strict=True
    ):
        data.qpos[:] = position
        mujoco.mj_kinematics(model.mj, data)
        spine = [data.body(name).xmat.reshape(3, 3) for name in ("pelvis", "waist", "chest")]
        turned = (Rotation.from_matrix(spine).mean() * upright.inv()).as_matrix()
        pitch = np.arctan2(turned[0, 2] - turned[2, 0], turned[0, 0] + turned[2, 2])
        missing.append(np.exp(1j * (phase - model.ground.slope - pitch)))
    assert abs(np.angle(np.mean(missing))) < 0.5  # 0.6 without the pull, uphill and downhill
