"""What other solvers of a control step are asked: a state in their order, and what is wanted."""

from typing import NamedTuple

import mujoco
import numpy as np

from rotctl.bench.states import Recorded, restore
from rotctl.control import Controller
from rotctl.control.pose import PoseTracker
from rotctl.control.stack import Stack, collect
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State, read


class Question(NamedTuple):
    """What peers are given of a state: positions and velocities in their order, and the wishes."""

    position: Array
    velocity: Array
    passive: Array
    bodies: list[str]
    contacts: Contacts
    wishes: Stack
    answer: Array
    recorded: Recorded


def question(model: Model, exact: Controller, one: Recorded) -> Question:
    """A recorded state as peers take it, and what an exact solver answers."""
    mj, data = model.mj, mujoco.MjData(model.mj)
    restore(model, data, one)
    state = read(model, data, merging=exact.settings.merging)
    poses = np.array((one.command.pose_a, one.command.pose_b))
    torques = PoseTracker(model, 1.0 / exact.settings.rate).torques(state, poses, one.command.pose)
    stack = collect(model, state, one.command, exact.settings, torques, one.blend)
    decision = exact.decide(state, one.command, one.blend)
    keep = decision.used
    contacts = Contacts(**{name: of[keep] for name, of in vars(state.contacts).items()})
    return Question(
        position=one.position[[0, 1, 2, 4, 5, 6, 3, *range(7, mj.nq)]],  # theirs are (x, y, z, w)
        velocity=_in_body(state, one.velocity),
        passive=_in_body(state, data.qfrc_passive.copy()),
        bodies=[mj.body(int(body)).name for body in contacts.body],
        contacts=contacts,
        wishes=stack.subset(keep[one.command.candidates(state)]),
        answer=decision.torque,
        recorded=one,
    )


def _in_body(state: State, along: Array) -> Array:
    """The root's first three in its own axes, as Pinocchio has them, not in the world's."""
    return np.concatenate((state.momentum.root_rotation.T @ along[:3], along[3:]))
