"""Rows of contacts over the acceleration: their axes, and what stops each of them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.control.settings import ContactGains
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import contact_jacobian
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State

LEAST_TANGENT = 1e-9  # a direction this near a normal has no tangent


def along(
    model: Model, state: State, forward: Array, keep: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Frames (m, 3, 3) and rows (3m, nv) of contacts, their tangents turned about the normal.

    The first then lies along `forward`, so that the friction pyramid's edges lie the same way
    whatever the heading.
    """
    frame = state.contacts.frame[keep]
    jacobian = contact_jacobian(model.mj, state.data, state.contacts)[np.repeat(keep, 3)]
    rows = jacobian.reshape(-1, 3, model.mj.nv)
    for k in range(len(frame)):
        first, second = product(frame[k, 1:], forward).tolist()
        length = (first * first + second * second) ** 0.5
        if length < LEAST_TANGENT:
            continue
        c, s = first / length, second / length
        for array in (frame[k], rows[k]):
            one, two = array[1].copy(), array[2].copy()
            array[1], array[2] = c * one + s * two, c * two - s * one
    return frame, jacobian


def stopping(
    model: Model,
    state: State,
    gains: ContactGains,
    rate: float,
    frame: Array,
    jacobian: Array,
    keep: NDArray[np.bool_],
) -> Array:
    """Accelerations (3m,) with which velocities fade, and what is open closes [m/s2].

    Args:
        rate: of the control [Hz]: nothing fades faster than within a period.
        frame, jacobian: as of `along`.
        keep: which contacts there are rows of.
    """
    fade = min(gains.damping, rate)
    stop = -fade * product(jacobian, state.velocity)
    stop[::3] -= fade * fade * np.maximum(state.contacts.gap[keep], 0.0)
    if gains.centripetal:
        stop -= _centripetal(model, state, frame, keep)
    return np.asarray(stop)


def _centripetal(model: Model, state: State, frame: Array, keep: NDArray[np.bool_]) -> Array:
    """Jdot qdot of contacts (3m,), along the rows of their frames (m, 3, 3) [m/s2].

    Of the points of the body that touch: a sole that rolls on a radius r gains omega^2 r less.
    """
    found, moving = np.zeros((len(frame), 3)), np.zeros((3, model.mj.nv))
    bodies, places = state.contacts.body[keep], state.contacts.position[keep]
    for i, (body, place) in enumerate(zip(bodies.tolist(), places, strict=True)):
        mujoco.mj_jacDot(model.mj, state.data, moving, None, place, body)
        found[i] = product(frame[i], product(moving, state.velocity))
    return found.ravel()
