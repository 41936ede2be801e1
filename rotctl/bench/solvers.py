"""Solvers and forms on the same states: time of a control step, and error of its torques."""

import time

import mujoco
import numpy as np

from rotctl.bench.states import Recorded, record_roll, restore
from rotctl.config.loading import load
from rotctl.control import Controller
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.runs.scenario import build

CHOICES = {
    "boxqp condensed, compiled": ["controller.backend=compiled"],
    "boxqp condensed, numpy": ["controller.backend=reference"],
    "qpsolvers:daqp condensed": ["controller.solver=qpsolvers:daqp"],
    "osqp condensed": ["controller.solver=osqp"],
    "osqp literal": ["controller.solver=osqp", "controller.form=literal"],
}
TRUTH = "qpsolvers:daqp condensed"  # an exact active-set method on the small dense problem
ROUNDS = 2  # of all choices in turn


def compare(count: int) -> str:
    """A table over `count` states of a 20 s roll, the choices one after the other, in rounds."""
    scenario = build(load(["duration=20"]))
    model = scenario.model
    recorded = record_roll(scenario, 1200)[:: max(1, 1200 // count)]
    controllers = {}
    for name, choice in CHOICES.items():
        try:
            controllers[name] = Controller(model, load(choice).controller)
        except InputError:
            if name == TRUTH:
                raise
    times, torques, fallbacks = _in_rounds(model, controllers, recorded)
    lines = [
        f"{len(recorded)} states of a forward roll, state and both passes, {ROUNDS} rounds",
        "",
        f"{'':28}{'time [us]':>10}{'x fastest':>11}{'torque error [N m]':>30}{'fell back':>11}",
        f"{'':28}{'median':>10}{'':>11}{'median':>10}{'p95':>10}{'max':>10}",
    ]
    fastest = min(float(np.median(t)) for t in times.values())
    for name, taken in times.items():
        error = np.abs(torques[name] - torques[TRUTH]).max(axis=1)
        cells = (np.median(error), np.percentile(error, 95), error.max())
        lines.append(
            f"{name:28}{np.median(taken):10.0f}{np.median(taken) / fastest:11.1f}"
            + "".join(f"{cell:10.1e}" for cell in cells)
            + f"{fallbacks[name]:11d}"
        )
    return "\n".join(lines)


def _in_rounds(
    model: Model, controllers: dict[str, Controller], recorded: list[Recorded]
) -> tuple[dict[str, Array], dict[str, Array], dict[str, int]]:
    """Times (n,) [us], torques (n, nu) [N m] and number of fallbacks by name."""
    data = mujoco.MjData(model.mj)
    times = {name: np.full(len(recorded), np.inf) for name in controllers}
    torques = {name: np.zeros((len(recorded), model.mj.nu)) for name in controllers}
    fallbacks = dict.fromkeys(controllers, 0)
    for turn in range(ROUNDS):
        for name, controller in controllers.items():
            for i, one in enumerate(recorded):
                restore(model, data, one)
                begin = time.perf_counter()
                decision = controller.decide(controller.read(data), one.command, one.blend)
                taken = 1e6 * (time.perf_counter() - begin)
                times[name][i] = min(times[name][i], taken)
                torques[name][i] = decision.torque
                fallbacks[name] += turn == 0 and decision.fallback > 0
    return times, torques, fallbacks
