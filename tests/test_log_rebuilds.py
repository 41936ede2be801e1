"""A log alone repeats its motion: its model under its torques is where its states come from."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

from rotctl.choices.listing import choices
from rotctl.config.loading import load, recorded
from rotctl.log import RunLog
from rotctl.mechanics.compilation import acting
from rotctl.report import stored_model
from rotctl.runs.run import make
from rotctl.runs.scenario import build, model_of

DOCS = Path(__file__).parent.parent / "docs"
CASES = [
    *([f"behaviour={name}"] for name in choices("behaviour")),
    *([f"terrain={name}"] for name in choices("terrain")),
    ["physics.integrator=euler", "physics.substeps=3", "physics.cone=pyramidal"],
    ["controller.rate=125", "physics.substeps=4"],  # a step of 2 ms, which MuJoCo leaves out
    ["physics=lockstep", "behaviour=incline"],
    ["physics=lockstep", "behaviour=sideways_roll"],
]


def logged(folder, *overrides):
    config = load([*overrides, "seed=2000", "duration=1.2"])
    (folder / "run.h5").write_bytes(make(config).log)
    return config, RunLog.open(folder / "run.h5")


@pytest.mark.parametrize("overrides", CASES, ids=" ".join)
def test_the_model_and_the_torques_of_a_log_give_its_states(overrides, tmp_path):
    config, log = logged(tmp_path, *overrides)
    model = mujoco.MjModel.from_xml_string(log.model_xml)
    assert model.opt.timestep == 1.0 / (config.controller.rate * config.physics.substeps)
    assert different(acting(log.model_xml), model_of(config).mj) == []
    assert different(model.opt, model_of(config).mj.opt) == []
    states = zip(log["trajectory/qpos"], log["trajectory/qvel"], strict=True)
    repeat = in_lockstep if "physics=lockstep" in overrides else by_mujoco
    row = -1
    for row, (data, (qpos, qvel)) in enumerate(zip(repeat(model, log), states, strict=True)):
        assert data.time == log["trajectory/time"][row]
        assert data.qpos.tobytes() == qpos.tobytes(), f"qpos, row {row}"
        assert data.qvel.tobytes() == qvel.tobytes(), f"qvel, row {row}"
    assert row >= 71


def by_mujoco(model, log):
    """As docs/reproducibility.md tells a stranger to do it, with nothing of rotctl but the log."""
    time = log["trajectory/time"]
    substeps = round((time[1] - time[0]) / model.opt.timestep)
    data = at_first(model, log)
    for torque in log["trajectory/ctrl"]:
        yield data
        data.ctrl[:] = torque
        mujoco.mj_step(model, data, substeps)


def in_lockstep(model, log):
    """Its steps are rotctl's own; their settings are in the log, too."""
    scenario = build(recorded(log))
    stepper = scenario.stepper
    stepper._mj = model
    data = at_first(model, log)
    for torque in log["trajectory/ctrl"]:
        stepper.evaluate(data)
        yield data
        stepper.advance(data, torque, scenario.controller.read(data).contacts)


def at_first(model, log):
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = log["trajectory/qpos"][0], log["trajectory/qvel"][0]
    return data


def test_what_is_drawn_is_what_was_simulated(tmp_path):
    """The reader that trusts nobody writes the text anew, and loses nothing of it."""
    _, log = logged(tmp_path, "behaviour=uneven_terrain")
    plain = mujoco.MjModel.from_xml_string(log.model_xml)
    assert different(stored_model.load(log), plain) == []


def test_a_difference_would_be_seen():
    model = model_of(load([])).mj
    other = acting(model_of(load([])).mjcf)
    other.geom_size[3, 0] = np.nextafter(other.geom_size[3, 0], 1.0)
    other.opt.timestep = np.nextafter(other.opt.timestep, 1.0)
    assert different(model, other) == ["geom_size"]
    assert different(model.opt, other.opt) == ["timestep"]


def different(one, other):
    """Names of the arrays and numbers that are not the same to the last bit."""
    found = []
    for name in dir(one):
        if name.startswith("_"):
            continue
        mine = getattr(one, name)
        if isinstance(mine, int | float | np.ndarray):
            same = np.asarray(mine).tobytes() == np.asarray(getattr(other, name)).tobytes()
            found += [] if same else [name]
    return found


def test_the_recipe_in_the_docs_repeats_a_run(tmp_path, capsys):
    _, log = logged(tmp_path)
    text = (DOCS / "reproducibility.md").read_text(encoding="utf-8")
    (recipe,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    exec(re.sub(r'open\("[^"]*"\)', f"open({str(log.path)!r})", recipe), {})  # our own file
    assert capsys.readouterr().out == "72 rows, 72 the same\n"
