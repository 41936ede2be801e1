"""Landing: where the feet should be, the pose for it, starts in the air, and who stands then."""

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.aerial.landing import Landing
from rotctl.behaviours.support import ends, middle
from rotctl.config.loading import composed, load
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise
from rotctl.simulation.placing import place

EXACT = ["start.scatter=0", "start.tilt=0", "start.falling.across=0"]
LAW = "start.falling.landing"


def made(*overrides):
    return build(load(["behaviour=land", "seed=2000", *overrides]))


def placed(scenario):
    """Data of its start."""
    data = mujoco.MjData(scenario.model.mj)
    behaviour = scenario.behaviour
    usual = behaviour.start(scenario.start.pitch)
    place(scenario.model, data, scenario.start, usual, behaviour.axes)
    mujoco.mj_forward(scenario.model.mj, data)
    mujoco.mj_subtreeVel(scenario.model.mj, data)
    return data


def feet(scenario):
    return [scenario.model.mj.body(name).id for name in ("foot_l", "foot_r")]


def law(scenario):
    return Landing(scenario.config.start.falling.landing, scenario.model, LAW)


# ---------------------------------------------------------------- the law


@pytest.mark.parametrize("momentum", [-30.0, 0.0, 25.0])
@pytest.mark.parametrize("speed", [-0.4, 0.5])
@pytest.mark.parametrize("time", [0.0, 0.2])
def test_gravity_takes_the_momentum_about_the_feet_in_time(momentum, speed, time):
    """By MuJoCo's sums over the bodies: what a start has about its feet is m g d T."""
    scenario = made(
        *EXACT,
        f"start.falling.momentum={[momentum] * 2}",
        f"start.speed_x={[speed] * 2}",
        f"{LAW}.share=1",
        f"{LAW}.time={time}",
    )
    data = placed(scenario)
    x, _ = middle(ends(scenario.model, data, feet(scenario)))
    sole = min(data.geom_xpos[g, 2] - 0.03 for g in solid(scenario, feet(scenario)))
    arm = data.subtree_com[1] - [x, 0.0, sole]
    about = data.subtree_angmom[1] + 70.0 * np.cross(arm, data.subtree_linvel[1])
    taken = 70.0 * 9.81 * arm[0] * time
    assert about[1] + taken == pytest.approx(0.0, abs=0.5)


def solid(scenario, bodies):
    mj = scenario.model.mj
    return np.flatnonzero(np.isin(mj.geom_bodyid, bodies) & (mj.geom_contype > 0))


@pytest.mark.parametrize("offset", [-0.3, -0.1, 0.0, 0.15, 0.3])
def test_feet_are_flat_and_the_centre_of_mass_is_where_it_was_asked_for(offset):
    scenario = made()
    mj, data = scenario.model.mj, mujoco.MjData(scenario.model.mj)
    contact = law(scenario).at(offset)
    data.qpos[3:7] = [np.cos(contact.attitude / 2), 0.0, np.sin(contact.attitude / 2), 0.0]
    data.qpos[scenario.model.angles] = contact.pose
    mujoco.mj_forward(mj, data)
    assert contact.offset == pytest.approx(offset, abs=2e-3)
    ankles = data.xpos[feet(scenario)].mean(axis=0)  # the foot's middle is 4.75 cm before them
    assert data.subtree_com[1, 0] - ankles[0] - 0.0475 == pytest.approx(contact.offset, abs=2e-3)
    for foot in feet(scenario):
        assert data.xmat[foot].reshape(3, 3)[2, 0] == pytest.approx(0.0, abs=1e-6)
    low = min(data.geom_xpos[g, 2] - mj.geom_size[g, 0] for g in solid(scenario, feet(scenario)))
    assert contact.height == pytest.approx(data.subtree_com[1, 2] - low, abs=2e-3)


def test_an_offset_out_of_reach_is_the_furthest():
    landing = law(made())
    assert landing.at(9.0).offset == pytest.approx(landing.at(0.32).offset, abs=5e-3)
    assert landing.offset(-1e4, 0.0, 2.7, 0.9) == 0.35
    assert landing.offset(1e4, 0.0, 2.7, 0.9) == -0.35


# ---------------------------------------------------------------- starts in the air


@pytest.mark.parametrize("seed", range(2000, 2005))
@pytest.mark.parametrize("heading", [0, 70])
def test_a_start_falls_as_was_drawn(seed, heading):
    scenario = made(
        *EXACT,
        f"seed={seed}",
        f"behaviour.heading={heading}",
        "start.speed_y=[0,0]",
        "start.falling.gap=[0.03,0.03]",
        "start.falling.momentum=[-33,-33]",
        "start.falling.speed=[2.6,2.6]",
    )
    mj, data = scenario.model.mj, placed(scenario)
    gaps = [
        mujoco.mj_geomDistance(mj, data, mj.geom("ground").id, int(geom), 10.0, None)
        for geom in solid(scenario, range(1, mj.nbody))
    ]
    assert min(gaps) == pytest.approx(0.03, abs=1e-6)
    forward, left, up = scenario.behaviour.axes
    assert data.subtree_angmom[1] == pytest.approx(-33.0 * left, abs=1e-6)
    velocity = data.subtree_linvel[1]
    assert velocity @ up == pytest.approx(-2.6)
    assert velocity @ left == pytest.approx(0.0, abs=1e-9)
    assert abs(velocity @ forward) <= 0.5


def test_what_cannot_fall():
    plain = composed(["behaviour=land"])
    plain["start"]["falling"]["gap"] = [-0.1, 0.0]
    with pytest.raises(InputError, match="gap must not be negative, and may be -0.1 m"):
        check(plain)
    plain["start"]["falling"] |= {"gap": [0.0, 0.1], "speed": [0.0, 1.0]}
    with pytest.raises(InputError, match="speed must be at least 0.1 m/s, and may be 0"):
        check(plain)
    with pytest.raises(InputError) as caught:
        build(load(["behaviour=turn_over", "start=falling"]))
    assert str(caught.value) == (
        "start=falling falls onto the feet of who turns about the left axis, and "
        "behaviour.roll_about=head; valid: long, prone, rest, side, still, supine, symmetric, "
        "tucked, tucked_back"
    )


# ---------------------------------------------------------------- who stands


@pytest.mark.parametrize(
    ("momentum", "speed"), [(-45, -0.3), (-20, 0), (0, 0), (20, 0), (45, 0.5)], ids=str
)
def test_who_lands_as_flips_do_stands(momentum, speed):
    scenario = made(
        f"start.falling.momentum={[momentum] * 2}", f"start.speed_x={[speed] * 2}", "duration=4"
    )
    buffer, breakdown = in_memory(scenario)
    summary = summarise(scenario, buffer, breakdown, 1.0)
    assert summary["failure_reason"] == ""
    assert summary["stature_least"] < 0.9  # it takes up the fall


@pytest.mark.parametrize("seed", range(2000, 2004))
def test_the_head_is_upright_soon_after_a_landing(seed):
    """From where the fall has thrown it; what hangs as an arm does takes four seconds."""
    scenario = made(f"seed={seed}", "duration=3")
    buffer, _ = in_memory(scenario)
    mj, data = scenario.model.mj, mujoco.MjData(scenario.model.mj)
    data.qpos[:] = buffer.arrays()["trajectory/qpos"][-1]
    mujoco.mj_kinematics(mj, data)
    up = data.xmat[mj.body("head").id].reshape(3, 3)[:, 2]
    assert np.degrees(np.arccos(up[2])) < 10.0
