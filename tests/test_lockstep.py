"""Lockstep physics against Newton and Euler, sliding theory and MuJoCo's reading of its forces."""

import json
from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from both import along

from rotctl.config.loading import load
from rotctl.control import Controller, compiled
from rotctl.errors import InputError
from rotctl.log import read_attributes
from rotctl.mechanics import compilation
from rotctl.mechanics.bodies import is_character, lowest_and_highest
from rotctl.mechanics.contacts import contact_jacobian, read_contacts
from rotctl.mechanics.state import read
from rotctl.runs.run import in_memory, run
from rotctl.runs.scenario import build
from rotctl.simulation import lockstep, pgs
from rotctl.simulation.lockstep import LockstepStepper

NOTHING = SimpleNamespace(
    body=np.zeros(0, dtype=np.int32), position=np.zeros((0, 3)), frame=np.zeros((0, 3, 3))
)
GRAVITY = 9.81


@pytest.fixture(scope="module")
def settings():
    """Fixed here where it matters, so that the tests do not follow conf/."""
    return replace(
        load(["physics=lockstep"]).physics, substeps=1, correction=0.2, slop=5e-4, closing=True
    )


def plain(xml, settings):
    """A stepper of any MuJoCo model, with the options that lockstep physics sets."""
    spec = mujoco.MjSpec.from_string(xml)
    settings.set_options(spec, 60.0)
    for geom in spec.geoms:
        geom.margin = 0.5 * settings.margin
    for joint in spec.joints:
        joint.margin = settings.limit_margin
    mj = spec.compile()
    return mj, mujoco.MjData(mj), LockstepStepper(SimpleNamespace(mj=mj), settings)


def advance(stepper, data, torque=0.0, contacts=NOTHING):
    stepper.evaluate(data)
    return stepper.advance(data, torque, contacts)


class Person:
    """The character in this physics, steps taken one by one."""

    def __init__(self, world, settings, damping=None):
        character = world.config.character
        if damping is not None:
            character = replace(character, joint_damping=damping)
        self.model = compilation.build(character, world.config.terrain, settings, 60.0)
        self.stepper = LockstepStepper(self.model, settings)
        self.data = mujoco.MjData(self.model.mj)

    def put(self, position, velocity):
        self.data.qpos[:], self.data.qvel[:] = position, velocity
        return self

    def step(self, torque=0.0):
        self.stepper.evaluate(self.data)
        self.stepper.advance(self.data, torque, NOTHING)


# ------------------------------------------------------------------ momentum


def wrench(mj, data):
    """Force and torque about the centre of mass (6,) of the ground, as MuJoCo reads efc_force."""
    total = np.concatenate((mj.body_subtreemass[1] * mj.opt.gravity, np.zeros(3)))
    local = np.empty(6)
    for i, contact in enumerate(data.contact):
        bodies = mj.geom_bodyid[contact.geom]
        if (bodies == 0).any():
            mujoco.mj_contactForce(mj, data, i, local)
            force = contact.frame.reshape(3, 3).T @ local[:3] * (-1.0 if bodies[0] else 1.0)
            total[:3] += force
            total[3:] += np.cross(contact.pos - data.subtree_com[1], force)
    return total


def test_momentum_changes_by_the_impulses_and_by_nothing_else(world):
    """Newton and Euler, body by body, at every step of a roll with limits and self-contacts."""
    scenario = build(load(["physics=lockstep", "behaviour=forward_roll_1_phase", "seed=1"]))
    mj, stepper, seen = scenario.model.mj, scenario.stepper, []
    step = stepper._step

    def spy(data):
        position, velocity = data.qpos.copy(), data.qvel.copy()
        step(data)
        kinds = {int(data.efc_type[i]) for i in np.flatnonzero(data.efc_force)}
        acceleration = (data.qvel - velocity) / mj.opt.timestep
        seen.append((position, velocity, acceleration, wrench(mj, data), kinds))

    stepper._step = spy
    in_memory(replace(scenario, config=replace(scenario.config, duration=3.0)))
    kinds = set.union(*(s[4] for s in seen))
    assert kinds == {lockstep.LIMIT, *(int(mujoco.mjtConstraint(k)) for k in (5, 7))}
    worst = 0.0
    for position, velocity, acceleration, forces, _ in seen[::4]:
        found = world.rates_by_difference(position, velocity, acceleration)
        worst = max(worst, np.abs(found - forces).max() / (1 + np.abs(forces).max()))
    assert np.abs(seen[60][3]).max() > 100
    assert worst < 1e-5


def test_impulses_and_momentum_to_rounding(world, settings, supported):
    """The root's rows, which no motor, damper or limit can touch."""
    person = Person(world, settings)
    mj, data, h = person.model.mj, person.data, person.model.mj.opt.timestep
    for recorded in supported[::10]:
        person.put(recorded.position, recorded.velocity)
        person.stepper.evaluate(data)
        before, bias = data.qvel.copy(), data.qfrc_bias[:6].copy()
        person.stepper.advance(data, recorded.decision.torque, NOTHING)
        change = np.empty(mj.nv)
        mujoco.mj_mulM(mj, data, change, data.qvel - before)
        rows = data.efc_J.reshape(-1, mj.nv)
        expected = rows[:, :6].T @ person.stepper.solved[0].p - h * bias
        assert change[:6] == pytest.approx(expected, abs=1e-11)


def test_free_flight(world, settings):
    """The centre of mass falls as semi-implicit steps do; H drifts, at first order in the step."""
    position, velocity = world.in_the_air(seed=3, speed=1.5)
    drift = []
    for substeps in (1, 4):
        person = Person(world, replace(settings, substeps=substeps)).put(position, velocity)
        com, linear, angular, _ = world.body_sums(world.mj, world.data(position, velocity))
        steps = 30
        for _ in range(steps):
            person.step()
        data = person.data
        new, new_linear, new_angular, _ = world.body_sums(
            world.mj, world.data(data.qpos, data.qvel)
        )
        fall = -world.model.mass * GRAVITY * data.time
        assert data.time == pytest.approx(0.5, abs=1e-12)
        assert np.abs(new_linear - linear - [0, 0, fall]).max() < 0.2 * abs(fall)
        drift.append(np.abs(new_angular - angular).max())
    assert 0 < drift[1] < 0.5 * drift[0]


def test_a_loose_box_and_the_character_push_each_other_equally(world):
    """Thrown at it in the air: momenta about the origin, and the forces that the log would have."""
    scenario = build(load(["physics=lockstep", "terrain=hazards", "physics.gravity=[0, 0, 0]"]))
    model, stepper = scenario.model, scenario.stepper
    mj, data = model.mj, mujoco.MjData(model.mj)
    trees = {"character": (0, 0), "box": (model.angles.stop, model.joints.stop)}  # qpos, dof
    angle, dof = trees["box"]
    data.qpos[:angle] = world.in_the_air(seed=1)[0]
    data.qpos[angle : angle + 3] = data.qpos[:3] + [1.0, 0.0, 0.0]
    data.qvel[dof] = -6.0
    hit = 0.0
    for _ in range(20):
        stepper.evaluate(data)
        before, place, bias = data.qvel.copy(), data.qpos.copy(), data.qfrc_bias.copy()
        contacts = read_contacts(mj, data, touch=1.0)
        force = stepper.advance(data, np.zeros(mj.nu), contacts).total
        change = np.empty(mj.nv)
        mujoco.mj_mulM(mj, data, change, data.qvel - before)
        change += mj.opt.timestep * bias
        given = {}
        for name, (q, v) in trees.items():
            turn = np.empty(9)
            mujoco.mju_quat2Mat(turn, place[q + 3 : q + 7])
            spin = turn.reshape(3, 3) @ change[v + 3 : v + 6]
            push, arm = change[v : v + 3], place[q : q + 3] - place[:3]
            given[name] = np.concatenate((push, spin + np.cross(arm, push)))
        assert given["character"] == pytest.approx(-given["box"], abs=1e-10)
        assert given["character"][:3] == pytest.approx(force * mj.opt.timestep, abs=1e-10)
        assert is_character(mj)[contacts.body].all()
        hit = max(hit, np.abs(given["box"][:3]).max())
    assert hit > 1.0


# ------------------------------------------------------------------ friction

BOX = """
<mujoco>
  <worldbody>
    <geom name="ground" type="plane" size="0 0 1" euler="0 {tilt} 0" friction="0.5"/>
    <body pos="0 0 0" euler="0 {tilt} 0">
      <freejoint/>
      <geom type="box" size="0.1 0.1 0.05" pos="0 0 0.05" mass="2" friction="0.5" condim="3"/>
    </body>
  </worldbody>
</mujoco>
"""


def slide(settings, degrees, speed, steps):
    """Speeds down the slope [m/s] after each step."""
    _, data, stepper = plain(BOX.format(tilt=degrees), settings)
    angle = np.radians(degrees)
    downhill = np.array([np.cos(angle), 0.0, -np.sin(angle)])
    data.qvel[:3] = speed * downhill
    speeds = []
    for _ in range(steps):
        advance(stepper, data)
        speeds.append(data.qvel[:3] @ downhill)
        assert np.abs(data.qvel[3:]).max() < 1e-6
    assert stepper.complaint(data) == ""
    return np.array(speeds)


def test_a_sliding_box_slows_down_by_mu_g_and_stops(settings):
    speeds = slide(settings, 0.0, 1.0, 30)
    expected = np.maximum(1.0 - 0.5 * GRAVITY / 60 * np.arange(1, 31), 0.0)
    assert speeds == pytest.approx(expected, abs=1e-6)
    assert np.abs(speeds[-10:]).max() < settings.tolerance


@pytest.mark.parametrize("degrees", [20.0, 26.0])
def test_a_box_stays_on_a_slope_below_the_friction_angle(settings, degrees):
    assert np.abs(slide(settings, degrees, 0.0, 60)).max() < 1e-6


@pytest.mark.parametrize("degrees", [27.0, 40.0])
def test_a_box_slides_on_a_slope_above_it(settings, degrees):
    angle = np.radians(degrees)
    rate = GRAVITY * (np.sin(angle) - 0.5 * np.cos(angle))
    assert slide(settings, degrees, 0.0, 60)[-1] == pytest.approx(rate, rel=1e-5)


# ------------------------------------------------------------------ rest, limits, impact


def test_a_body_at_rest_neither_sinks_nor_gains_energy(world, settings):
    """Limp, dropped from 0.3 m: true energies, of the model without the damping's armature."""
    person = Person(world, settings)
    person.data.qpos[2:7] = [0.0, np.cos(0.7), 0.0, -np.sin(0.7), 0.0]  # on its back
    mujoco.mj_kinematics(person.model.mj, person.data)
    solid = (person.model.mj.geom_bodyid > 0) & (person.model.mj.geom_contype > 0)
    lowest, _ = lowest_and_highest(person.model.mj, person.data, solid)
    person.data.qpos[2] = 0.3 - lowest
    energies, heights, depth = [], [], []
    for _ in range(360):
        true = world.data(person.data.qpos, person.data.qvel)
        mujoco.mj_energyPos(world.mj, true)
        mujoco.mj_energyVel(world.mj, true)
        energies.append(true.energy.sum())
        heights.append(true.subtree_com[1, 2])
        person.step()
        depth.append(-person.data.contact.dist.min(initial=0.0))
    rises = np.array(energies) - np.minimum.accumulate(energies)
    assert energies[0] - energies[-1] > 300
    assert rises.max() < 0.005 * (energies[0] - energies[-1])
    assert 0 < max(depth) < 0.03
    assert max(depth[-60:]) < 0.003
    assert abs(heights[-1] - heights[-61]) < 0.005


HINGE = """
<mujoco>
  <worldbody>
    <body>
      <joint name="hinge" type="hinge" axis="0 1 0" range="-30 50" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0 0 0.5" size="0.05" mass="3" contype="0"/>
    </body>
  </worldbody>
  <actuator><motor joint="hinge"/></actuator>
</mujoco>
"""


@pytest.mark.parametrize("side", [-1, 1])
def test_a_joint_stops_at_its_limit_and_holds_there(settings, side):
    mj, data, stepper = plain(HINGE, replace(settings, gravity=(0.0, 0.0, 0.0)))
    limit = mj.jnt_range[0, (side + 1) // 2]
    data.qvel[0] = 3.0 * side
    for _ in range(120):
        advance(stepper, data, 5.0 * side)
        assert side * (data.qpos[0] - limit) < 1e-9
    assert data.qpos[0] == pytest.approx(limit, abs=1e-9)
    assert stepper.solved[0].p / mj.opt.timestep == pytest.approx(5.0, rel=1e-9)
    advance(stepper, data, -5.0 * side)
    assert side * data.qvel[0] < 0  # it lets go at once


def test_a_joint_faster_than_the_margin_is_taken_back(settings):
    """At 30 rad/s a joint passes its limit between two steps; it comes back, but slowly."""
    mj, data, stepper = plain(HINGE, replace(settings, gravity=(0.0, 0.0, 0.0)))
    data.qvel[0], past = 30.0, []
    for _ in range(60):
        advance(stepper, data)
        past.append(data.qpos[0] - mj.jnt_range[0, 1])
    assert 0.05 < max(past) < 30 / 60
    assert min(np.diff(past[past.index(max(past)) :])) > -settings.limit_push_out / 60 - 1e-9
    assert past[-1] < 1e-3


def test_a_falling_ball_meets_the_ground_and_does_not_pass(settings):
    """An open contact closes within the step: exactly at the surface, at no speed, no bounce."""
    ball = BOX.format(tilt=0).replace('type="box" size="0.1 0.1 0.05"', 'type="sphere" size="0.05"')
    _, data, stepper = plain(ball, settings)
    data.qpos[2], data.qvel[2] = 0.04, -2.9
    heights = []
    for _ in range(3):
        advance(stepper, data)
        heights.append(data.qpos[2])
    assert heights == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert data.qvel[2] == pytest.approx(0.0, abs=1e-9)


# ------------------------------------------------------------------ what control sees


def closing_states(world, settings, supported):
    """States from MuJoCo rolls, lifted a little so that contacts are open, and evaluated here."""
    model = Person(world, settings).model
    for step in supported[::4]:
        data = mujoco.MjData(model.mj)
        data.qpos[:], data.qvel[:] = step.position, step.velocity
        data.qpos[2] += 0.02
        data.qvel[2] -= 1.0
        mujoco.mj_step1(model.mj, data)
        yield step, model, data


def test_control_sees_contacts_that_touch_or_close(world, settings, supported):
    seen = left = 0
    for _, model, data in closing_states(world, settings, supported):
        expected = []
        for contact in data.contact:
            bodies = model.mj.geom_bodyid[contact.geom]
            row = data.efc_J.reshape(-1, model.mj.nv)[contact.efc_address]
            closes = contact.dist + row @ data.qvel / 60 < 0
            if (bodies == 0).any() and (contact.dist <= settings.touch or closes):
                expected.append(contact.dist)
            left += int((bodies == 0).any() and not (contact.dist <= settings.touch or closes))
        assert read(model, data).contacts.gap.tolist() == expected
        seen += sum(gap > settings.touch for gap in expected)
        touching = read_contacts(model.mj, data, settings.touch)
        assert (touching.gap <= settings.touch).all()
    assert min(seen, left) > 10


@pytest.mark.parametrize("form", ["condensed", "literal"])
def test_the_controller_meets_a_closing_contact_at_the_surface(world, settings, supported, form):
    """With contact velocities all that counts, the dynamics take each normal to -gap / h."""
    met = 0
    hold = replace(world.settings.contact, weight=1e9 / 60**2, force=1e-9)
    control = replace(world.settings, form=form, solver="qpsolvers:daqp")
    for step, model, data in closing_states(world, settings, supported):
        controller = Controller(model, control)
        state = controller.read(data)
        command = step.command._replace(contact=hold, supervisor="none")
        decision = controller.decide(state, command, step.blend)
        used = replace(
            state.contacts, **{k: v[decision.used] for k, v in vars(state.contacts).items()}
        )
        J = contact_jacobian(model.mj, data, used)
        push = np.einsum("mij,mj->mi", used.frame, decision.force[decision.used]).ravel()
        M = np.zeros((model.mj.nv, model.mj.nv))
        mujoco.mj_fullM(model.mj, data, M)
        force = J.T @ push - data.qfrc_bias + data.qfrc_passive
        force[6:] += decision.torque
        after = J @ (data.qvel + np.linalg.solve(M, force) / 60)
        inside = push[::3] > 1.0  # the others may separate
        wanted = -np.maximum(used.gap, 0.0) * 60
        if (
            decision.fallback == 0
            and not (np.abs(decision.torque) > 0.99 * model.torque_limit).any()
        ):
            assert after[::3][inside] == pytest.approx(wanted[inside], abs=0.02)
            met += int((inside & (wanted < -0.1)).sum())
    assert met > 5


@pytest.mark.skipif(compiled.library() is None, reason="the compiled control step is not built")
def test_compiled_control_is_the_reference_here_too():
    scenario = build(load(["physics=lockstep", "seed=1"]))
    open_contacts = []
    for asked in along(scenario, 150):
        for name in vars(asked.expected.contacts):
            a, b = (getattr(s.contacts, name).tolist() for s in (asked.found, asked.expected))
            assert a == b
        open_contacts.append((asked.expected.contacts.gap > 0.002).sum())
        fast, slow = asked.fast, asked.slow
        assert np.abs(fast.torque - slow.torque).max() <= 1e-6 * np.abs(slow.torque).max()
        assert fast.used.tolist() == slow.used.tolist()
        assert fast.force == pytest.approx(slow.force, rel=1e-6, abs=1e-4)
    assert len(open_contacts) == 150
    assert sum(open_contacts) > 10


# ------------------------------------------------------------------ the run


def test_the_log_has_the_lcp_s_forces(world, settings, supported):
    """Impulses over h, in world axes: what MuJoCo reads from the same constraint rows."""
    person, checked = Person(world, settings), 0
    mj, data = person.model.mj, person.data
    for recorded in supported[::20]:
        person.put(recorded.position, recorded.velocity)
        person.stepper.evaluate(data)
        contacts = read(person.model, data).contacts
        found = person.stepper.advance(data, recorded.decision.torque, contacts)
        expected, local = np.zeros((mj.nbody, 3)), np.empty(6)
        for i, contact in enumerate(data.contact):
            bodies = mj.geom_bodyid[contact.geom]
            if (bodies == 0).any():
                mujoco.mj_contactForce(mj, data, i, local)
                expected[bodies.max()] += contact.frame.reshape(3, 3).T @ local[:3]
        for body in range(1, mj.nbody):
            force = found.mean[found.body == body].sum(axis=0)
            assert force == pytest.approx(expected[body], abs=1e-9)
            checked += bool(force.any())
        assert found.total == pytest.approx(expected.sum(axis=0), abs=1e-9)
    assert checked > 10


def test_substeps_share_the_control_period(world, settings):
    person = Person(world, replace(settings, substeps=3)).put(*world.in_the_air(seed=1))
    person.step()
    assert person.data.time == pytest.approx(1 / 60, abs=1e-15)
    assert person.model.mj.opt.timestep == pytest.approx(1 / 180, rel=1e-12)
    assert person.stepper.complaint(person.data) == ""


def test_damping_is_an_armature_of_the_step(world, settings):
    plain, damped = (Person(world, settings, damping=d).model for d in (0.0, 2.0))
    assert damped.armature - plain.armature == pytest.approx(2.0 / 60, rel=1e-5)  # six digits
    assert world.model.armature == pytest.approx(plain.armature, rel=1e-12)


def test_two_runs_are_the_same_bytes():
    def trajectory():
        buffer, breakdown = in_memory(build(load(["physics=lockstep", "seed=7", "duration=1"])))
        assert breakdown == ""
        return b"".join(array.tobytes() for array in buffer.arrays().values())

    assert trajectory() == trajectory()


def test_it_rolls(tmp_path):
    """Two revolutions of the phase-varying roll, with the shared gains, and what the log says."""
    overrides = ["physics=lockstep", "behaviour=forward_roll_1_phase", "seed=2", "duration=5"]
    result = run(load(overrides), tmp_path)
    assert result.summary["revolutions"] > 2
    attributes = read_attributes(result.folder / "run.h5", linked=False)
    kind = "compiled" if pgs.library() else "reference"
    assert json.loads(attributes["versions"])["physics_step"] == f"lockstep {kind}"


def test_a_solve_that_stops_short_is_an_event():
    overrides = ["physics=lockstep", "physics.sweeps=1", "physics.alarm=1.0e-6", "duration=0.5"]
    buffer, _ = in_memory(build(load(overrides)))
    assert buffer.events[0][1].startswith("contacts not solved after 1 sweeps: off by ")
    assert len(buffer.events) > 20


def test_without_the_library_it_says_so_and_gives_the_same(monkeypatch):
    overrides = ["physics=lockstep", "seed=1", "duration=0.3"]
    usual, _ = in_memory(build(load(overrides)))
    monkeypatch.setattr(lockstep, "library", lambda: None)
    scenario = build(load(overrides))
    assert scenario.stepper.notice == (
        "the compiled contact solver is not built, using its numpy reference, which is much "
        "slower; install a C compiler (Debian: apt-get install gcc libc6-dev), then rotctl again"
    )
    assert scenario.stepper.backend == "lockstep reference"
    buffer, _ = in_memory(scenario)
    assert buffer.trajectory.qpos == pytest.approx(usual.trajectory.qpos, abs=1e-8)


def test_a_blow_up_is_a_complaint(world, settings):
    person = Person(world, settings).put(*world.in_the_air())
    person.step(np.full(person.model.mj.nu, np.nan))
    person.stepper.evaluate(person.data)
    assert person.stepper.complaint(person.data).startswith("MuJoCo warns: ")


@pytest.mark.parametrize(
    ("override", "message"),
    [
        (
            "physics.stepper=x",
            "physics.stepper=\"x\": no such stepper; valid: 'mujoco', 'lockstep'",
        ),
        ("physics.sweeps=0", "physics.sweeps=0: must be greater than or equal to 1"),
        ("physics.margin=0", "physics.margin=0: must be greater than 0"),
        (
            "physics.iterations=3",
            "unknown key 'physics.iterations'; did you mean ccd_iterations? "
            "valid keys under physics: name, ",
        ),
    ],
)
def test_bad_settings(override, message):
    with pytest.raises(InputError) as caught:
        load(["physics=lockstep", override])
    assert str(caught.value).startswith(message)
