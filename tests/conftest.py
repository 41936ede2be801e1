"""Shared by the tests: a scenario built once, and control steps recorded from short rolls."""

import copy
import os
import pickle
import zlib
from dataclasses import dataclass, replace
from itertools import islice

import headless  # noqa: F401, before mujoco
import mujoco
import numpy as np
import pytest
from browser import Browser, executable
from here import without_processes

from rotctl.choices.config_folders import OWN
from rotctl.cli.main import main
from rotctl.config import loading
from rotctl.config.loading import load
from rotctl.control import Command, Decision
from rotctl.control.pose import PoseTracker
from rotctl.control.stack import collect
from rotctl.errors import InputError
from rotctl.mechanics.state import read
from rotctl.report import gl
from rotctl.runs.scenario import build
from rotctl.simulation import episode
from rotctl.simulation.episode import Episode

NUDGE = 1e-9  # [m/s, rad/s] standard deviation, of `pytest --nudge`
SEEDS = (1, 2)
SECONDS = 2.0  # each; 240 control steps in all
RATE = 60.0


@dataclass(frozen=True)
class Step:
    """One control step of a roll, enough to do it again."""

    position: np.ndarray
    velocity: np.ndarray
    command: Command
    blend: float
    decision: Decision


class World:
    """A roll with recorded steps, and independent mechanics to compare with."""

    def __init__(self):
        # Fixed here, so that the tests do not follow the tuning of conf/.
        self.config = load(
            [
                "behaviour=forward_roll_1_on_head",
                f"duration={SECONDS:g}",
                "controller.solver=boxqp",
                "controller.form=condensed",
                "controller.backend=reference",
                f"controller.rate={RATE:g}",
                "controller.supervisor=as_written",
                "physics.substeps=4",
                "physics.cone=elliptic",
                "start=tucked",
                "character.exclude_from_control=[head]",  # so that leaving one out is seen too
            ]
        )
        self.scenario = build(self.config)
        self.model = self.scenario.model
        self.mj = self.model.mj
        self.settings = self.config.controller
        self.steps = [step for seed in SEEDS for step in self._roll(seed)]

    def _roll(self, seed):
        moments = islice(Episode(build(replace(self.config, seed=seed))), round(SECONDS * RATE))
        return [
            Step(m.state.position, m.state.velocity, m.command.copy(), m.blend, m.decision)
            for m in moments
        ]

    def data(self, position, velocity, mj=None):
        """Fresh MuJoCo data in that state, evaluated as the loop does it."""
        mj = mj or self.mj
        data = mujoco.MjData(mj)
        data.qpos[:], data.qvel[:] = position, velocity
        mujoco.mj_step1(mj, data)
        return data

    def state(self, step):
        return read(self.model, self.data(step.position, step.velocity))

    def stack(self, step, command=None, settings=None):
        """The state of a recorded step and its first pass, of another command if given."""
        command, settings = command or step.command, settings or self.settings
        state, poses = self.state(step), np.array((command.pose_a, command.pose_b))
        tracker = PoseTracker(self.model, 1.0 / settings.rate)
        torques, towards = tracker.torques(state, poses, command.pose), None
        if settings.tracking == "acceleration":
            towards = tracker.accelerations(state, poses, command.pose)
        return state, collect(self.model, state, command, settings, torques, step.blend, towards)

    def in_the_air(self, seed=0, speed=1.0):
        """A random posture and velocity, high above the ground: (qpos, qvel)."""
        rng = np.random.default_rng(seed)
        position, velocity = np.empty(self.mj.nq), np.empty(self.mj.nv)
        position[:3] = rng.normal(size=3) + [0.0, 0.0, 50.0]
        position[3:7] = rng.normal(size=4)
        position[3:7] /= np.linalg.norm(position[3:7])
        low, high = self.model.joint_range.T
        position[7:] = rng.uniform(low + 0.2 * (high - low), high - 0.2 * (high - low))
        velocity[:] = speed * rng.normal(size=self.mj.nv)
        return position, velocity

    @staticmethod
    def body_sums(mj, data):
        """Newton and Euler: CM, L, H and I_c by adding up the rigid bodies one by one."""
        mass = mj.body_mass[1:]
        com = mass @ data.xipos[1:] / mass.sum()
        linear, angular, inertia = np.zeros(3), np.zeros(3), np.zeros((3, 3))
        velocity = np.empty(6)
        for body in range(1, mj.nbody):
            mujoco.mj_objectVelocity(mj, data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
            spin, speed = velocity[:3], velocity[3:]
            axes = data.ximat[body].reshape(3, 3)
            own = axes @ np.diag(mj.body_inertia[body]) @ axes.T
            arm = data.xipos[body] - com
            linear += mj.body_mass[body] * speed
            angular += own @ spin + mj.body_mass[body] * np.cross(arm, speed)
            inertia += own + mj.body_mass[body] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return com, linear, angular, inertia

    def rates_by_difference(self, position, velocity, acceleration, tiny=1e-5):
        """d/dt of [L; H] (6,) along an acceleration, by central differences of body sums."""
        momenta = []
        for h in (-tiny, tiny):
            moved = position.copy()
            change = velocity * h + 0.5 * acceleration * h**2
            mujoco.mj_integratePos(self.mj, moved, change, 1.0)
            data = self.data(moved, velocity + h * acceleration)
            momenta.append(np.concatenate(self.body_sums(self.mj, data)[1:3]))
        return (momenta[1] - momenta[0]) / (2 * tiny)

    def model_copy(self, **options):
        """A copy of the MuJoCo model with other options."""
        mj = copy.copy(self.mj)
        for name, value in options.items():
            setattr(mj.opt, name, value)
        return mj


def pytest_addoption(parser):
    parser.addoption(
        "--nudge",
        type=int,
        metavar="SEED",
        help=f"move every start by some {NUDGE:g} m/s and rad/s; leaves out tests marked exact",
    )


def pytest_collection_modifyitems(config, items):
    if config.getoption("nudge") is not None:
        skip = pytest.mark.skip(reason="compares bits, or with a process that is not nudged")
        for item in items:
            if item.get_closest_marker("exact"):
                item.add_marker(skip)


@pytest.fixture(scope="session", autouse=True)
def _nudged(request):
    """Equal starts are moved equally, so that what is simulated twice is the same twice."""
    seed, place = request.config.getoption("nudge"), episode.place

    def moved(model, data, *start):
        place(model, data, *start)
        own = zlib.crc32(data.qpos.tobytes() + data.qvel.tobytes())
        data.qvel[:] += np.random.default_rng([seed, own]).normal(0.0, NUDGE, model.mj.nv)

    with pytest.MonkeyPatch.context() as patch:
        if seed is not None:
            patch.setattr(episode, "place", moved)
        yield


@pytest.fixture(scope="session", autouse=True)
def _what_is_shipped_is_composed_once():
    """Hydra takes a sixth of a second for a config, and tests ask for the same ones often."""
    shipped, compose, known = loading.conf_dir(), loading.composed, {}

    def composed(overrides):
        if loading.folders() != (shipped,) or any("mjcf" in one for one in overrides):
            return compose(overrides)
        key = tuple(overrides)
        if key not in known:
            known[key] = pickle.dumps(compose(overrides))
        return pickle.loads(known[key])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loading, "composed", composed)
        yield


@pytest.fixture
def here_alone(monkeypatch):
    """Commands carry their tasks out in this process."""
    without_processes(monkeypatch)


@pytest.fixture
def cli(capsys):
    """Calls the command line in this process: (exit code, stdout, stderr)."""

    def call(*arguments):
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as stop:  # argparse's way
            code = stop.code
        return (code, *capsys.readouterr())

    return call


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder that one is in, without configs of one's own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(OWN, raising=False)
    return tmp_path


@pytest.fixture(scope="session")
def world():
    return World()


@pytest.fixture(scope="session")
def steps(world):
    """Recorded control steps, at least 200."""
    assert len(world.steps) >= 200
    return world.steps


@pytest.fixture(scope="session")
def supported(world, steps):
    """Recorded steps with at least two contacts the controller may use."""
    found = [s for s in steps if (~world.model.excluded[world.state(s).contacts.body]).sum() >= 2]
    assert len(found) >= 50
    return found


def pictures_are_wanted():
    """CI must be able to draw and browse unless it says otherwise; others may lack it."""
    return os.environ.get("CI") == "true" and os.environ.get("ROTCTL_CI_NO_PICTURES") != "1"


@pytest.fixture
def drawing():
    """A machine that can draw."""
    try:
        gl.backend()
    except InputError as error:
        if pictures_are_wanted():
            raise
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def browser():
    """A Chromium of this module's own."""
    if executable() is None:
        reason = "no Chromium here; on Debian: apt-get install chromium"
        if pictures_are_wanted():
            pytest.fail(reason)
        pytest.skip(reason)
    opened = Browser()
    yield opened
    opened.close()
