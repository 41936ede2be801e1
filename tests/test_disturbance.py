"""Forces from outside: what acts, what the log says of it, and what control knows."""

from itertools import islice
from math import cos, pi, radians, sin

import mujoco
import numpy as np
import pytest
from questions import look_at

from rotctl.config.loading import load
from rotctl.control.kinds import KINDS
from rotctl.errors import InputError
from rotctl.mechanics.disturbance import OnePush
from rotctl.mechanics.momentum import contact_momentum_maps
from rotctl.mechanics.state import read
from rotctl.mechanics.wind import Air
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

PUSH = ["disturbance=push", "disturbance.time=[0.11, 0.11]"]  # between two control steps
PHYSICS = ["mujoco", "lockstep"]


def made(*overrides):
    return build(load(["seed=2001", *overrides]))


def moving(world, seed):
    """Data in flight, all joints turning."""
    return world.data(*world.in_the_air(seed, speed=2.0))


def rates_of(world, data, acceleration):
    """d/dt of [L; H] (6,) along an acceleration."""
    return world.rates_by_difference(data.qpos.copy(), data.qvel.copy(), acceleration)


def accelerations(mj, data, disturbance, period=1 / 60):
    """With the forces and without, and the wrench that is told."""
    data.xfrc_applied[:] = 0.0
    mujoco.mj_forward(mj, data)
    calm = data.qacc.copy()
    wrench = disturbance.apply(data, period)
    mujoco.mj_forward(mj, data)
    return data.qacc.copy(), calm, wrench


# ---------------------------------------------------------------- what acts is what is told


@pytest.mark.parametrize("seed", range(3))
def test_the_wrench_is_the_change_of_the_momentum_s_rate(world, seed):
    """Of L and of H about the centre of mass, by differences of what the bodies sum up to."""
    data, mj = moving(world, seed), world.mj
    rng = np.random.default_rng(seed)
    push = OnePush(
        world.mj.body("forearm_l" if seed else "chest").id, 300 * rng.normal(size=3), 0, 1
    )
    for disturbance in (push, Air(mj, 20 * rng.normal(size=3), 0.6)):
        pushed, calm, wrench = accelerations(mj, data, disturbance)
        change = rates_of(world, data, pushed) - rates_of(world, data, calm)
        assert np.abs(wrench).max() > 50.0
        assert change == pytest.approx(wrench, abs=1e-5 * np.abs(wrench).max())


@pytest.mark.parametrize("rate", [30, 60, 120, 240])
@pytest.mark.parametrize("duration", [0.001, 0.1, 0.37])
def test_a_push_s_impulse_is_the_same_at_any_rate(world, rate, duration):
    """Whatever part of a control step it begins and ends in."""
    data = moving(world, 0)
    push = OnePush(3, np.array([10.0, -20.0, 5.0]) / duration, 0.123, 0.123 + duration)
    total = np.zeros(3)
    for i in range(rate):
        data.time = i / rate
        total += push.apply(data, 1 / rate)[:3] / rate
    assert total == pytest.approx([10.0, -20.0, 5.0], rel=1e-12)
    assert not data.xfrc_applied.any()  # and then it is over


@pytest.mark.parametrize("physics", PHYSICS)
@pytest.mark.parametrize("seed", range(3))
def test_either_physics_takes_all_of_it(world, physics, seed):
    """One step in flight: what it adds to L and H is the wrench times the step, to rounding."""
    scenario = made(f"physics={physics}", "physics.substeps=1")
    mj, rng = scenario.model.mj, np.random.default_rng(seed)
    push = OnePush(int(rng.integers(1, mj.nbody)), 300 * rng.normal(size=3), 0.0, 1.0)
    ends = []
    for disturbance in (None, push):
        data = mujoco.MjData(mj)
        data.qpos[:], data.qvel[:] = world.in_the_air(seed)
        stepper = build(scenario.config).stepper
        stepper.evaluate(data)
        state = read(scenario.model, data)
        wrench = disturbance.apply(data, 1 / 60) if disturbance else None
        stepper.advance(data, np.zeros(mj.nu), state.contacts)
        ends.append(data.qvel.copy())
    M = np.zeros((mj.nv, mj.nv))
    mujoco.mj_fullM(mj, world.data(*world.in_the_air(seed), mj=mj), M)
    added = contact_momentum_maps(state.momentum, (M @ (ends[1] - ends[0]))[None])[:, 0]
    assert added * 60 == pytest.approx(wrench, rel=1e-9, abs=1e-8)


@pytest.mark.parametrize("physics", PHYSICS)
@pytest.mark.parametrize("kind", [PUSH, ["disturbance=wind", "disturbance.speed=30"]])
def test_newton_s_second_law_holds_in_the_log(physics, kind):
    """Ground, gravity and what is told of the outside are the change of momentum."""
    scenario = made(f"physics={physics}", *kind, "physics.substeps=64", "duration=1")
    buffer, breakdown = in_memory(scenario)
    assert not breakdown
    gained = np.diff(buffer.trajectory.linear_momentum, axis=0) * scenario.config.controller.rate
    rest = gained - scenario.model.mass * scenario.model.gravity - buffer.contacts.ground_force[:-1]
    wrench = buffer.disturbance.wrench[:-1, :3]
    acts = np.abs(wrench).max(axis=1) > 0
    assert acts.sum() >= 6
    missed = np.sqrt(((rest - wrench)[acts] ** 2).mean())
    assert missed < 0.1 * np.sqrt((wrench[acts] ** 2).mean())


def test_the_log_has_a_push_from_the_way_that_it_was_drawn():
    """Seeds differ; the heading turns it; its impulse is what was asked for."""
    seen = []
    for overrides in (["seed=3"], ["seed=4"], ["seed=3", "behaviour.heading=90"]):
        scenario = build(load([*overrides, "disturbance=push", "duration=2"]))
        buffer, _ = in_memory(scenario)
        impulse = buffer.disturbance.wrench[:, :3].sum(axis=0) / 60
        assert np.linalg.norm(impulse) == pytest.approx(20.0, rel=1e-9)
        assert impulse[2] == 0.0
        when = buffer.trajectory.time[np.abs(buffer.disturbance.wrench).max(axis=1) > 0]
        assert 0.5 - 1 / 60 <= when[0] <= 1.5
        assert when[-1] - when[0] == pytest.approx(0.1, abs=0.02)
        seen.append((impulse, when[0]))
    assert np.abs(seen[0][0] - seen[1][0]).max() > 1.0
    assert seen[0][1] != seen[1][1]
    turned = np.array([-seen[0][0][1], seen[0][0][0], 0.0])
    assert seen[2][0] == pytest.approx(turned, abs=1e-9)


def test_wind_blows_where_it_says_and_drags_what_moves(world):
    """On a character at rest it is drag along the wind; in still air, along what moves."""
    mj, data = world.mj, world.data(world.in_the_air(1)[0], np.zeros(world.mj.nv))
    wind = np.array([3.0, 4.0, 0.0])
    force = Air(mj, wind, 0.6).apply(data, 1 / 60)[:3]
    assert force @ wind == pytest.approx(np.linalg.norm(force) * 5.0, rel=1e-9)
    # A person's drag area is 0.4 to 0.9 m2, whatever the posture.
    assert 0.3 < np.linalg.norm(force) / (0.6 * 25.0) < 1.0
    stronger = Air(mj, 2 * wind, 0.6).apply(data, 1 / 60)[:3]
    assert stronger == pytest.approx(4 * force, rel=1e-9)
    assert not Air(mj, np.zeros(3), 0.6).apply(data, 1 / 60).any()
    moves = np.zeros(mj.nv)
    moves[:3] = -wind
    data = world.data(data.qpos.copy(), moves)
    assert Air(mj, np.zeros(3), 0.6).apply(data, 1 / 60)[:3] == pytest.approx(force, rel=1e-9)


def test_a_sphere_s_drag_is_its_cross_section():
    mj = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='0.3'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(mj)
    mujoco.mj_forward(mj, data)
    force = Air(mj, np.array([0.0, 10.0, 0.0]), 0.5 * 1.2 * 0.47).apply(data, 1 / 60)[:3]
    assert force == pytest.approx([0.0, 0.5 * 1.2 * 0.47 * pi * 0.09 * 100.0, 0.0], rel=1e-12)


def test_a_gust_blows_between_its_ends(world):
    """Whatever parts of control steps they lie in, and as hard as the wind meanwhile."""
    data, mj = world.data(world.in_the_air(1)[0], np.zeros(world.mj.nv)), world.mj
    wind, period = np.array([3.0, 4.0, 0.0]), 1 / 60
    steady = Air(mj, wind, 0.6).apply(data, period)
    gust, total = Air(mj, wind, 0.6, begin=0.123, end=0.456), np.zeros(6)
    for i in range(60):
        data.time = i * period
        total += gust.apply(data, period) * period
    assert total == pytest.approx(steady * (0.456 - 0.123), rel=1e-9)
    assert not data.xfrc_applied.any()


def test_a_body_that_is_not_there():
    with pytest.raises(InputError) as caught:
        made("disturbance=push", "disturbance.body=tail")
    assert str(caught.value).startswith(
        "disturbance.body names the unknown body 'tail'; bodies: pelvis, "
    )


def test_directions_are_from_forward_towards_left():
    for heading in (0, 90):
        overrides = ["disturbance=push", "disturbance.direction=[30, 30]"]
        push = made(*overrides, f"behaviour.heading={heading}").disturbance
        way = radians(30 + heading)
        assert push.force == pytest.approx(200.0 * np.array([cos(way), sin(way), 0.0]))


# ---------------------------------------------------------------- what control knows


@pytest.mark.parametrize("backend", ["compiled", "reference"])
@pytest.mark.parametrize("physics", PHYSICS)
def test_control_is_surprised_by_a_push_unless_it_is_told(physics, backend):
    """Up to and with the step in which it begins, torques are those of a run without one."""
    always = [f"physics={physics}", f"controller.backend={backend}"]
    begins = 6  # the step that the push of PUSH begins in
    found = {}
    for name, overrides in {
        "calm": [],
        "unseen": PUSH,
        "seen": [*PUSH, "controller.sees_disturbance=true"],
    }.items():
        moments = list(islice(Episode(made(*always, *overrides)), begins + 2))
        found[name] = [moment.decision.torque for moment in moments]
        acts = [bool(moment.wrench.any()) for moment in moments[begins - 1 :]]
        assert acts == [False, bool(overrides), bool(overrides)]
    for i in range(begins + 1):
        assert found["unseen"][i].tobytes() == found["calm"][i].tobytes()
    assert np.abs(found["unseen"][begins + 1] - found["calm"][begins + 1]).max() > 0.1
    assert np.abs(found["seen"][begins] - found["calm"][begins]).max() > 0.1
    assert found["seen"][begins - 1] == pytest.approx(found["calm"][begins - 1], abs=1e-9)


SEEN = [
    [*PUSH, "disturbance.impulse=40", "behaviour=forward_roll_1"],
    ["disturbance=wind", "disturbance.speed=25", "behaviour=stand"],
    ["physics.density=30", "physics.viscosity=1", "behaviour=sideways_roll"],
    [*PUSH, "physics=lockstep", "behaviour=forward_roll_1_phase"],
]


@pytest.mark.parametrize("backend", ["compiled", "reference"])
@pytest.mark.parametrize("overrides", SEEN, ids=" ".join)
@pytest.mark.parametrize("told", [True, False], ids=["seen", "unseen"])
def test_what_is_seen_is_predicted_and_what_is_not_is_missing(overrides, backend, told):
    """Rates of L and H, and each task's rows, beside those of the acceleration that MuJoCo finds
    for the decided torques and forces and whatever else acts."""
    settings = [f"controller.sees_disturbance={str(told).lower()}"]
    scenario = made(*overrides, *settings, f"controller.backend={backend}")
    mj, model = scenario.model.mj, scenario.model
    off, lost, names = [], [], list(KINDS)

    def look(question):
        state = question.state
        decision = scenario.controller.decide(state, question.command, question.blend)
        acting = np.zeros(mj.nv)
        for body in range(1, mj.nbody):
            force, moment = state.data.xfrc_applied[body].reshape(2, 3)
            mujoco.mj_applyFT(mj, state.data, force, moment, state.data.xipos[body], body, acting)
        acting += state.data.qfrc_fluid
        root_rates = np.zeros(6)  # of what acts from outside
        arm = state.data.qpos[:3] - state.momentum.com
        turned = state.data.xmat[1].reshape(3, 3) @ acting[3:6]
        root_rates[:3], root_rates[3:] = acting[:3], turned + np.cross(arm, acting[:3])
        pushed = acting + state.data.qfrc_passive - state.data.qfrc_fluid - state.data.qfrc_bias
        pushed[model.joints] += decision.torque
        rates = root_rates.copy()
        rates[:3] += model.mass * model.gravity
        for body, at, force in zip(
            state.contacts.body, state.contacts.position, decision.force, strict=True
        ):
            mujoco.mj_applyFT(mj, state.data, force, np.zeros(3), at, body, pushed)
            rates += np.concatenate((force, np.cross(at - state.momentum.com, force)))
        acceleration = np.zeros((1, mj.nv))
        mujoco.mj_solveM(mj, state.data, acceleration, pushed[None])
        if not acting.any():
            return
        scale = 1 + np.abs(rates).max()
        off.append(np.abs(decision.rates_predicted - rates).max() / scale)
        lost.append(np.abs(root_rates).max() / scale)
        for i, task in enumerate(question.command.tasks):
            kind = KINDS[names[task["kind"]]]
            rows = kind.rows(task, model, state)
            expected = (rows.matrix @ (rates if kind.momentum else acceleration[0]))[:3]
            miss = np.abs(decision.predicted[i, : len(expected)] - expected).max(initial=0.0)
            off.append(miss / (1 + np.abs(expected).max(initial=0.0)))

    look_at(scenario, 14, look)
    assert len(lost) >= 4
    if told:
        assert max(off) < 1e-7
    else:
        assert max(off) > 0.1 * max(lost) > 1e-3


# ---------------------------------------------------------------- what changes of the world

CHANGES = {
    "load": ["disturbance=load", "disturbance.mass=6"],
    "slip": ["disturbance=slippery", "disturbance.friction=0.4"],
}


def changing(kind, *overrides):
    return made(*CHANGES[kind], "disturbance.time=0.19", *overrides)


@pytest.mark.parametrize("physics", PHYSICS)
@pytest.mark.parametrize("kind", CHANGES)
def test_no_velocity_jumps_as_the_world_changes(physics, kind):
    """The run goes on from the state that it would have had, and in another way."""
    calm = list(islice(Episode(made(f"physics={physics}")), 20))
    changed = list(islice(Episode(changing(kind, f"physics={physics}")), 20))
    for before, after in zip(calm[:13], changed[:13], strict=True):
        assert before.truth.velocity == pytest.approx(after.truth.velocity, abs=1e-12)
        assert before.decision.torque == pytest.approx(after.decision.torque, rel=1e-6, abs=1e-6)
        assert not after.wrench.any()
    assert [bool(moment.remark) for moment in changed] == [i == 12 for i in range(20)]
    assert np.abs(calm[-1].truth.velocity - changed[-1].truth.velocity).max() > 1e-3


@pytest.mark.parametrize("backend", ["compiled", "reference"])
def test_a_load_has_its_body_s_momentum_and_its_own_weight(backend):
    """As it is taken up, and in flight, where the whole falls as everything does."""
    scenario = changing("load", f"controller.backend={backend}")
    mj, chest = scenario.model.mj, scenario.model.mj.body("chest").id
    before = float(mj.body_subtreemass[1])
    moments = list(islice(Episode(made()), 13))
    changed = list(islice(Episode(scenario), 13))
    velocity = np.zeros(6)
    data = mujoco.MjData(mj)
    data.qpos[:], data.qvel[:] = changed[-1].truth.position, changed[-1].truth.velocity
    mujoco.mj_forward(mj, data)
    mujoco.mj_objectVelocity(mj, data, mujoco.mjtObj.mjOBJ_BODY, chest, velocity, 0)
    added = changed[-1].truth.momentum.linear - moments[-1].truth.momentum.linear
    assert added == pytest.approx(6.0 * velocity[3:], rel=1e-6)
    assert mj.body_subtreemass[1] == pytest.approx(before + 6.0)
    told = changed[-1].truth.momentum
    assert told.com_velocity == pytest.approx(told.linear / (before + 6.0), rel=1e-12)
    assert scenario.known.mj.body_subtreemass[1] == before  # what control goes on to believe
    assert made().model.mj.body_subtreemass[1] == before  # as does the next run


def test_newton_s_second_law_holds_with_a_load():
    """Ground and the gravity of what it weighs then are the change of momentum."""
    scenario = changing("load", "physics.substeps=32", "duration=1")
    buffer, breakdown = in_memory(scenario)
    assert not breakdown
    gained = np.diff(buffer.trajectory.linear_momentum, axis=0)[12:] * 60.0
    weighs = float(scenario.model.mj.body_subtreemass[1])
    rest = gained - buffer.contacts.ground_force[12:-1]
    assert rest.mean(axis=0) == pytest.approx(weighs * scenario.model.gravity, abs=10.0)
    assert weighs - scenario.model.mass == pytest.approx(6.0)


def test_slippery_ground_gives_a_share_of_its_friction():
    scenario = changing("slip")
    states = [moment.truth for moment in islice(Episode(scenario), 20)]
    before, after = (
        {float(of) for state in some for of in state.contacts.friction.flat}
        for some in (states[:12], states[12:])
    )
    (usual,) = before
    assert list(after) == pytest.approx([0.4 * usual])
    ours, known = scenario.model.mj.geom_friction, scenario.known.mj.geom_friction
    assert ours == pytest.approx(0.4 * known)


def test_a_change_waits_for_its_phase():
    scenario = made(*CHANGES["load"], "disturbance.time=1", "disturbance.phase=90")
    moments = list(islice(Episode(scenario), 200))
    came = [i for i, moment in enumerate(moments) if moment.remark]
    assert len(came) == 1
    before, after = (moments[i].signals.phase for i in (came[0] - 2, came[0] - 1))
    assert (before - pi / 2) // (2 * pi) != (after - pi / 2) // (2 * pi)
    assert moments[came[0]].truth.time >= 1.0
