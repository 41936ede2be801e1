"""Everything that the script of a replay is told, as a tree for `rotctl.report.pack`."""

from typing import Any

import mujoco
import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.report import character, shapes, stored_model
from rotctl.report.panels import panels
from rotctl.report.rows import at_rate, drawable, moderate
from rotctl.report.signals import Signals, signals

RATE = 30.0  # [1/s] frames; the page draws between them
MAX_FRAMES = 9000  # 5 min; longer runs get fewer frames a second
MAX_PLOTTED = 20_000  # rows in plots; of longer runs every k-th
MAX_CONTACTS = 64  # in a frame
MAX_FORCE = 100.0  # [body weights] of a run that broke down; no force is larger
MOMENTUM_LENGTH = 0.8  # [m] of the arrow of a large angular momentum, its 95th percentile

Tree = dict[str, Any]


def data(log: RunLog, compare: RunLog | None) -> Tree:
    """The data of a replay of `log`, with `compare` laid over.

    Raises:
        LogError: a log is damaged or its model is not safe to load.
    """
    logs = [moderate(each) for each in (log, compare) if each is not None]
    times = [drawable(each, each["trajectory/qpos"]) for each in logs]
    models = [stored_model.load(each) for each in logs]
    rows = [_frames(time) for time in times]
    plotted = [_plotted(each, len(time)) for each, time in zip(logs, times, strict=True)]
    return {
        "arrow": character.FORCE_SCALE * character.size(models[0]),
        "duration": max(float(time[-1]) for time in times) or 1e-3,
        "runs": [_run(*each) for each in zip(logs, models, rows, strict=True)],
        "contacts": _contacts(logs[0], models[0], rows[0]),
        "panels": panels(plotted[0], plotted[1] if compare else None),
    }


def _frames(time: Array) -> list[int]:
    return at_rate(time, min(RATE, MAX_FRAMES / max(time[-1] - time[0], 1e-9)))


def _plotted(log: RunLog, rows: int) -> Signals:
    return signals(log, slice(0, rows, 1 + rows // MAX_PLOTTED))


def _run(log: RunLog, model: mujoco.MjModel, rows: list[int]) -> Tree:
    """Shapes and frames of one run."""
    poses = shapes.poses(model, log["trajectory/qpos"][rows])
    momentum = _finite(log["trajectory/angular_momentum"][rows])
    large = float(np.percentile(np.linalg.norm(momentum, axis=1), 95))
    return {
        "bodies": shapes.bodies(model),
        "world": shapes.world(model),
        "momentumScale": MOMENTUM_LENGTH / max(large, 1e-6),
        "frames": {
            "time": log["trajectory/time"][rows],
            "positions": poses.positions,
            "quaternions": poses.quaternions,
            "com": poses.com,
            "ground": poses.ground,
            "omega": _finite(log["trajectory/angular_velocity"][rows]),
            "momentum": momentum,
        },
    }


def _contacts(log: RunLog, model: mujoco.MjModel, rows: list[int]) -> Tree:
    """Contacts of all frames one after the other; those of frame i begin at `start[i]`.

    Forces are in body weights times the body's size: the page draws an adult's.
    """
    weight = max(character.weight(model), 1.0) / character.size(model)
    position = log["contacts/position"][rows]
    realised = log["contacts/force_realised"][rows] / weight
    predicted = log["contacts/force_predicted"][rows] / weight
    kept = (
        (log["contacts/body"][rows] >= 0)
        & np.isfinite(position).all(axis=2)
        & np.isfinite(realised).all(axis=2)
    )
    kept &= np.cumsum(kept, axis=1) <= MAX_CONTACTS
    count = kept.sum(axis=1)
    return {
        "start": np.concatenate([[0], np.cumsum(count)]),
        "most": max(1, int(count.max())),
        "position": position[kept],
        "realised": realised[kept].clip(-MAX_FORCE, MAX_FORCE),
        "predicted": _finite(predicted[kept]).clip(-MAX_FORCE, MAX_FORCE),
        "used": log["contacts/used"][rows][kept],
    }


def _finite(values: Array) -> Array:
    return np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
