"""A control step of rotctl beside those of its peers, on the same states of a forward roll.

`make peers` runs it in an environment of its own: the peers are no part of rotctl. Each time is of
one state from positions and velocities to torques, kinematics and dynamics included:

- rotctl: `mj_step1`, which finds the contacts too, then the compiled step: both passes.
- Pinocchio with DAQP or ProxQP: mass matrix, bias and Jacobians, the same objectives over
  [qddot, lambda, gamma] for the contacts that rotctl's second pass uses, one solve.
- placo: its own question on as many point contacts, as it has no gamma and no momenta: the centre
  of mass and each body's attitude, one solve; so its torques are compared with nobody's.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

from rotctl.bench.peer_question import Question, question
from rotctl.bench.peer_steps import Pinocchio, Placo
from rotctl.bench.states import Recorded, record_roll, restore
from rotctl.config.loading import load
from rotctl.control import Controller
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.runs.scenario import build

STATES, ROUNDS = 150, 3
TRUTH = ["controller.solver=qpsolvers:daqp"]  # exact, on the condensed form


Step = Callable[[Question], Array | None]


def compare() -> str:
    """A table over `STATES` states of a 20 s roll, one peer after the other, in rounds."""
    scenario = build(load(["duration=20"]))
    recorded = record_roll(scenario, 1200)[:: 1200 // STATES]
    model = scenario.model
    exact = Controller(model, load(TRUTH).controller)
    asked = [question(model, exact, one) for one in recorded]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "model.xml")
        path.write_text(model.mjcf)
        peers: dict[str, Step] = {
            "Pinocchio, qpsolvers:daqp": Pinocchio(path, "daqp").step,
            "Pinocchio, qpsolvers:proxqp": Pinocchio(path, "proxqp").step,
            "placo (another question)": Placo(path).step,
        }
    ours = Ours(model)
    steps: dict[str, Step] = {"rotctl": ours.whole, "  without mj_step1": ours.decision, **peers}
    times = {name: np.full(len(asked), np.inf) for name in steps}
    errors: dict[str, list[float]] = {name: [] for name in steps}
    for turn in range(ROUNDS):
        for name, step in steps.items():
            for i, each in enumerate(asked):
                ours.restore(each.recorded)
                begin = time.perf_counter()
                torque = step(each)
                times[name][i] = min(times[name][i], time.perf_counter() - begin)
                if turn == 0 and torque is not None:
                    errors[name].append(float(np.abs(torque - each.answer).max()))
    return _table(times, errors, [len(each.bodies) for each in asked])


def _table(times: dict[str, Array], errors: dict[str, list[float]], contacts: list[int]) -> str:
    lines = [
        f"{STATES} states of a forward roll, {np.mean(contacts):.1f} contacts on average,"
        f" least of {ROUNDS} rounds",
        "",
        f"{'':30}{'time [us]':>16}{'x rotctl':>10}{'torque error [N m]':>24}",
        f"{'':30}{'median':>8}{'p95':>8}{'':10}{'median':>12}{'max':>12}",
    ]
    for name, taken in times.items():
        factor = np.median(taken) / np.median(times["rotctl"])
        error = errors[name]
        cells = f"{np.median(error):12.1e}{np.max(error):12.1e}" if error else f"{'-':>12}{'-':>12}"
        lines.append(
            f"{name:30}{1e6 * np.median(taken):8.0f}{1e6 * np.percentile(taken, 95):8.0f}"
            f"{factor:10.1f}{cells}"
        )
    return "\n".join(lines)


class Ours:
    """rotctl, compiled."""

    def __init__(self, model: Model) -> None:
        """Of the model itself."""
        self._model, self._data = model, mujoco.MjData(model.mj)
        self._controller = Controller(model, load([]).controller)

    def restore(self, recorded: Recorded) -> None:
        """Put a state into MuJoCo's data, evaluated."""
        restore(self._model, self._data, recorded)

    def whole(self, asked: Question) -> Array:
        """Torques (nu,) from a state."""
        mujoco.mj_step1(self._model.mj, self._data)
        return self.decision(asked)

    def decision(self, asked: Question) -> Array:
        """Torques (nu,) from a state that is evaluated."""
        controller, one = self._controller, asked.recorded
        state = controller.read(self._data)
        return controller.decide(state, one.command, one.blend).torque
