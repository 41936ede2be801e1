"""The worked examples of docs/extending.md, run as they stand there."""

import ctypes
import re
import shutil
import subprocess
from dataclasses import replace
from importlib import util
from itertools import islice
from pathlib import Path

import mujoco
import numpy as np
import pytest
import yaml

from rotctl.config.loading import composed
from rotctl.config.schema import check
from rotctl.control import Controller, compiled, kinds
from rotctl.control.settings import TaskGains
from rotctl.control.task import task
from rotctl.native.library import FOLDER, library
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

PAGE = Path(__file__).parents[1] / "docs" / "extending.md"
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)


def block(language, number=0):
    """The text of a block of the page."""
    return [text for name, text in BLOCKS if name == language][number]


@pytest.fixture
def height():
    """The kind of the page, as if it stood in kinds.py."""
    exec(block("python"), vars(kinds))
    yield kinds.kind("height")
    del kinds.KINDS["height"]


def commands_with_height(seconds=1.0):
    """A standing character's states and commands, with its head wanted 5 cm lower."""
    scenario = build(check(composed(["behaviour=stand", "seed=1"])))
    head = scenario.model.mj.body("head").id
    gains = TaskGains((2000.0,) * 3, (60.0,) * 3, (15.0,) * 3)
    extra = task(kinds.kind("height").number, gains, np.eye(3), head)
    for moment in islice(Episode(scenario), round(60 * seconds)):
        extra["target"][0, 2] = moment.state.data.xpos[head, 2] - 0.05
        tasks = np.concatenate((moment.command.tasks, extra))
        yield scenario, moment, moment.command._replace(tasks=tasks)


def test_the_objective_works_in_the_reference_at_once(height):
    """Without its function in C the compiled step leaves the command to the reference."""
    for scenario, moment, command in islice(commands_with_height(), 5):
        fast = Controller(scenario.model, scenario.config.controller)
        slow = Controller(scenario.model, replace(fast.settings, backend="reference"))
        data = mujoco.MjData(scenario.model.mj)
        data.qpos[:], data.qvel[:] = moment.state.position, moment.state.velocity
        mujoco.mj_step1(scenario.model.mj, data)
        plain = slow.decide(slow.read(data), moment.command, moment.blend)
        decision = slow.decide(slow.read(data), command, moment.blend)
        assert abs(decision.predicted[-1, 0] - decision.wanted[-1, 0]) < 1.0
        assert np.abs(decision.torque - plain.torque).max() > 0.1
        found = fast.decide(fast.read(data), command, moment.blend)
        assert found.torque == pytest.approx(decision.torque, rel=1e-9)
        if library():
            assert fast.notice == (
                "no function in C for tasks of kind height; steps that have one are decided by "
                "the numpy reference, several times slower"
            )


def test_the_same_in_c(height, tmp_path, monkeypatch):
    """The page's C, built beside the other kinds, gives the reference's torques."""
    compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    if compiler is None or library() is None:
        pytest.skip("no C compiler here")
    sources = tmp_path / "native"
    shutil.copytree(FOLDER, sources, ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    with (sources / "kinds.c").open("a", encoding="utf-8") as file:
        file.write(block("c"))
    built = tmp_path / "with_height.so"
    headers = Path(util.find_spec("mujoco").origin).parent / "include"
    flags = ["-O2", "-std=c11", "-fPIC", "-shared", "-ffp-contract=off", f"-I{headers}"]
    subprocess.run([compiler, *flags, "step.c", "-o", str(built), "-lm"], cwd=sources, check=True)
    monkeypatch.setattr(compiled, "library", lambda: ctypes.CDLL(str(built)))
    for scenario, moment, command in islice(commands_with_height(), 5):
        fast = compiled.CompiledStep(scenario.model, scenario.config.controller)
        settings = replace(scenario.config.controller, backend="reference")
        slow = Controller(scenario.model, settings)
        data = mujoco.MjData(scenario.model.mj)
        data.qpos[:], data.qvel[:] = moment.state.position, moment.state.velocity
        mujoco.mj_step1(scenario.model.mj, data)
        expected = slow.decide(slow.read(data), command, moment.blend)
        decision = fast.decide(fast.read(data), command, moment.blend)
        assert decision.torque == pytest.approx(expected.torque, rel=1e-8, abs=1e-8)
        assert decision.wanted == pytest.approx(expected.wanted, rel=1e-9, abs=1e-9)


def test_the_behaviour():
    """The page's stages, with what they bring along: the arms go out and come back, it stands."""
    brought = dict(re.findall(r"override /(\w+)@\S+: (\w+)", block("yaml", 1)))
    data = composed(["behaviour=stand", *(f"{group}={name}" for group, name in brought.items())])
    scenario = build(check(data | {"behaviour": yaml.safe_load(block("yaml"))}))
    joint = scenario.model.angles.start + scenario.model.joint_names.index("shoulder_x_l")
    out, stages = [], []
    for moment in islice(Episode(scenario), 270):
        out.append(moment.state.position[joint])
        stages.append(moment.signals.stage)
        assert moment.state.trunk_axes[2, 2] > 0.9
    assert (stages[0], stages[-1]) == (0, 2)
    assert sorted(stages) == stages
    assert max(out[:60]) < 0.4
    assert out[120] > 1.0
    assert out[-1] < 0.4
