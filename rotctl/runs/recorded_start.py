"""A start of one's own out of a log: the state that its run was in at some time."""

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import yaml

from rotctl.choices import own_folder
from rotctl.config.loading import recorded
from rotctl.config.schema import Config, changed
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.mechanics.model import Model
from rotctl.runs.scenario import model_of
from rotctl.settings.complaints import brief
from rotctl.simulation.clearance import clearance

LONGEST = 1e4  # [s] no run is as long
DEEP = 0.2  # [m] that no soft ground gives way by
RANGES = (  # of a start, around the state: none
    "pitch",
    "speed_x",
    "speed_y",
    "angular_velocity_x",
    "angular_velocity_y",
    "angular_velocity_z",
)


def make(name: str, log: RunLog, at: float | None) -> Path:
    """Write a start into the user's folder.

    Args:
        at: which row, by its time [s]; the last one if None.

    Raises:
        InputError: there is a start of that name, no such time, or the state of it is under
            water; nothing is written.
        LogError: the log is damaged, its config makes no run here, or its state no start.
    """
    path = own_folder.free("start", name)
    config = recorded(log)
    times = log["trajectory/time"]
    row = _row(log, times, at)
    state = _state(log, model_of(config), row)
    seconds = f"{_short(times[row])} s"
    data = {
        "name": name,
        "description": f"As {config.behaviour.name}, seed {config.seed}, was at {seconds}.",
        **{key: [0.0, 0.0] for key in RANGES},
        "scatter": 0.0,
        "tilt": 0.0,
        "state": state,
    }
    _check(log, config, data)
    if state["gap"] < -DEEP:
        raise InputError(
            f"--at={_short(times[row])}: the run is {-state['gap']:.2f} m below the ground then, "
            "as in water; choose an earlier time"
        )
    run = brief(log.attributes["run_id"])  # a stranger's text, which must not end the comment
    who = f"character={config.character.name}"
    ground = f"on terrain={config.terrain.name}, seed {config.seed}"
    head = f"# From the run {run}, {who}, {ground}, at {seconds}; see docs/getting_up.md\n"
    text = yaml.safe_dump(data, sort_keys=False, default_flow_style=None, width=100)
    return own_folder.write(path, head + text)


def _row(log: RunLog, times: np.ndarray, at: float | None) -> int:
    """Of the time; the nearest one."""
    if not len(times):
        raise LogError(f"{log.path}: has no rows, the run ended before its first step")
    if not np.isfinite(times).all():
        raise LogError(f"{log.path}: has times that are not finite")
    if at is None:
        return len(times) - 1
    first, last = float(times[0]), float(times[-1])
    if not first <= at <= last:
        raise InputError(f"--at={at:g}: the run has states from {first:g} to {_short(last)} s")
    return int(np.abs(times - at).argmin())


def _short(time: float) -> str:
    """A time [s] to the hundredth; one that no run reaches does not fill a page."""
    return f"{time:.2f}" if abs(time) < LONGEST else f"{time:.6g}"


def _check(log: RunLog, config: Config, start: dict[str, Any]) -> None:
    """Refuse what would not load again: a stranger's log may hold any number."""
    try:
        changed(config, {"start": start})
    except InputError as error:
        raise LogError(f"{log.path}: its state there makes no start: {error}") from None


def _state(log: RunLog, model: Model, row: int) -> dict[str, Any]:
    """What `rotctl.simulation.known.StateSettings` takes; loose boxes are left where they were."""
    qpos, qvel = log["trajectory/qpos"][row], log["trajectory/qvel"][row]
    if (len(qpos), len(qvel)) != (model.mj.nq, model.mj.nv):
        raise LogError(f"{log.path}: its states are not those of its config's character")
    place, orientation = qpos[:2].tolist(), qpos[3:7].tolist()
    angles, speeds = qpos[model.angles].tolist(), qvel[model.joints].tolist()
    numbers = [*qpos.tolist(), *qvel.tolist()]
    if not all(map(math.isfinite, numbers)):
        raise LogError(f"{log.path}: its state there is not finite")
    data = mujoco.MjData(model.mj)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model.mj, data)
    return {
        "place": place,
        "gap": clearance(model, data),
        "orientation": orientation,
        "velocity": qvel[:3].tolist(),
        "angular_velocity": qvel[3:6].tolist(),
        "pose": dict(zip(model.joint_names, angles, strict=True)),
        "speeds": dict(zip(model.joint_names, speeds, strict=True)),
        "mass": model.mass,
    }
