"""What controllers are asked along real episodes, and tasks of any kind to ask for more."""

from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.control import Command
from rotctl.control.kinds import KINDS
from rotctl.control.pose import PoseTracker
from rotctl.control.stack import Stack, collect
from rotctl.control.task import TASK
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.simulation.episode import Episode


def any_task(name, model, rng, stiffness=5.0, damping=2.0, weight=0.05):
    """A task of a kind that nobody had in mind: random wherever it may be."""
    task = np.zeros(1, TASK)
    task["kind"] = KINDS[name].number
    task["body"] = rng.choice(np.flatnonzero(is_character(model.mj)))
    task["axes"] = Rotation.random(rng=rng).as_matrix()
    task["point"] = rng.uniform(0.05, 0.3, 3)
    target = rng.normal(size=4)
    task["target"] = target / np.sqrt(target @ target)  # a place, a rotation or an orientation
    task["velocity"], task["acceleration"] = rng.normal(size=(2, 3))
    task["stiffness"] = stiffness * rng.uniform(0.5, 1.5, 3)
    task["damping"] = damping * rng.uniform(0.5, 1.5, 3)
    task["weight"] = weight * rng.uniform(0.5, 1.5, 3)
    return task


def with_tasks(command, *more):
    """The same command with more tasks."""
    return command._replace(tasks=np.concatenate((command.tasks, *more)))


@dataclass(frozen=True)
class Question:
    """One control step, while MuJoCo's data are still those of its state."""

    model: Model
    state: State
    command: Command
    blend: float
    settings: object

    def stack(self, *more) -> Stack:
        """Of the first pass, with more tasks."""
        command = with_tasks(self.command, *more)
        tracker = PoseTracker(self.model, 1.0 / self.settings.rate)
        poses = np.array((command.pose_a, command.pose_b))
        torques = tracker.torques(self.state, poses, command.pose)
        return collect(self.model, self.state, command, self.settings, torques, self.blend)


class Shown:
    """Serves an episode as its controller, and shows a function what it is asked."""

    def __init__(self, model, controller, look):
        self.settings = controller.settings
        self._model, self._controller, self._look = model, controller, look

    def read(self, data):
        return self._controller.read(data)

    def decide(self, state, command, blend):
        self._look(Question(self._model, state, command, blend, self.settings))
        return self._controller.decide(state, command, blend)


def look_at(scenario, steps, look, every=1):
    """Show `look` every so many of the questions of an episode."""
    count = 0

    def some(question):
        nonlocal count
        if count % every == 0:
            look(question)
        count += 1

    shown = Shown(scenario.model, scenario.controller, some)
    return list(islice(Episode(replace(scenario, controller=shown, observer=shown)), steps))


class Asking:
    """A behaviour that asks for more tasks, beside those of another one.

    `aim`, where there is one, changes them at every instant: it is given them and the state.
    """

    def __init__(self, behaviour, more, aim=lambda more, state: None):
        self._behaviour, self._more, self._aim = behaviour, more, aim
        self.tasks = (*behaviour.tasks, *(f"more_{i}" for i in range(len(more))))

    def __getattr__(self, name):
        return getattr(self._behaviour, name)

    def command(self, memory, state):
        command = self._behaviour.command(memory, state)
        self._aim(self._more, state)
        asked = with_tasks(command, *self._more)
        if command.slots is None:
            return asked
        behind = range(len(self._behaviour.tasks), len(self.tasks))
        return asked._replace(slots=[*command.slots, *behind])
