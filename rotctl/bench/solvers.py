"""Solvers and forms on the same states: time of a control step, and error of its torques."""

import time
from dataclasses import replace

import mujoco
import numpy as np

from rotctl.bench.states import Recorded, record_roll, restore
from rotctl.config import load
from rotctl.control import Controller
from rotctl.errors import InputError
from rotctl.mechanics.model import Model
from rotctl.rotations import Array
from rotctl.scenario import build

CHOICES = {
    "boxqp condensed, compiled": {"solver": "boxqp", "form": "condensed", "backend": "compiled"},
    "boxqp condensed, numpy": {"solver": "boxqp", "form": "condensed", "backend": "reference"},
    "qpsolvers:daqp condensed": {"solver": "qpsolvers:daqp", "form": "condensed"},
    "osqp condensed": {"solver": "osqp", "form": "condensed"},
    "osqp literal": {"solver": "osqp", "form": "literal"},
}
TRUTH = "qpsolvers:daqp condensed"  # an exact active-set method on the small dense problem


def compare(count: int) -> str:
    """A table over `count` states of a 20 s roll; all choices take turns on each state."""
    config = load(["duration=20"])
    scenario = build(config)
    model = scenario.model
    recorded = record_roll(scenario, 1200)[:: max(1, 1200 // count)]
    controllers = {}
    for name, choice in CHOICES.items():
        try:
            controllers[name] = Controller(model, replace(config.controller, **choice))
        except InputError as error:
            if name == TRUTH:
                raise InputError(f"the comparison needs its reference solver: {error}") from None
    times, torques, fallbacks = _interleaved(model, controllers, recorded)
    lines = [
        f"{len(recorded)} states of a forward roll, both passes, all choices in turn on each",
        "",
        f"{'':28}{'time [us]':>10}{'x fastest':>11}{'torque error [N m]':>30}{'fell back':>11}",
        f"{'':28}{'median':>10}{'':>11}{'median':>10}{'p95':>10}{'max':>10}",
    ]
    fastest = min(np.median(t) for t in times.values())
    for name, taken in times.items():
        error = np.abs(torques[name] - torques[TRUTH]).max(axis=1)
        cells = (np.median(error), np.percentile(error, 95), error.max())
        lines.append(
            f"{name:28}{np.median(taken):10.0f}{np.median(taken) / fastest:11.1f}"
            + "".join(f"{cell:10.1e}" for cell in cells)
            + f"{fallbacks[name]:11d}"
        )
    return "\n".join(lines)


def _interleaved(
    model: Model, controllers: dict[str, Controller], recorded: list[Recorded]
) -> tuple[dict[str, Array], dict[str, Array], dict[str, int]]:
    """Times (n,) [us], torques (n, nu) [N m] and number of fallbacks by name."""
    data = mujoco.MjData(model.mj)
    times = {name: np.zeros(len(recorded)) for name in controllers}
    torques = {name: np.zeros((len(recorded), model.mj.nu)) for name in controllers}
    fallbacks = dict.fromkeys(controllers, 0)
    for i, one in enumerate(recorded):
        restore(model, data, one)
        for name, controller in controllers.items():
            begin = time.perf_counter()
            decision = controller.decide(controller.read(data), one.desired, one.blend)
            times[name][i] = 1e6 * (time.perf_counter() - begin)
            torques[name][i] = decision.torque
            fallbacks[name] += decision.fallback > 0
    return times, torques, fallbacks
