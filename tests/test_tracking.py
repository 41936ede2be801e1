"""Tasks at work in real simulations: a hand follows a place, a head looks where it is told.

The character stands meanwhile; without the task neither comes near.
"""

from dataclasses import replace
from itertools import islice

import mujoco
import numpy as np
import pytest
from questions import Asking
from scipy.spatial.transform import Rotation

from rotctl.config.loading import load
from rotctl.control.kinds import KINDS
from rotctl.control.settings import TaskGains
from rotctl.control.task import task
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

HAND = (0.0, 0.0, -0.25)  # [m] in the forearm's frame
SETTLED = 1.0  # [s]
GAINS = {
    "point": TaskGains((30.0,) * 3, (250.0,) * 3, (32.0,) * 3),
    "attitude": TaskGains((30.0,) * 3, (250.0,) * 3, (32.0,) * 3),
}


def standing(kind, body, aim, asked, point=(0.0, 0.0, 0.0)):
    """Moments of four seconds of standing, with or without the task, which comes last."""
    scenario = build(load(["behaviour=stand", "seed=2000"]))
    more = task(KINDS[kind].number, GAINS[kind], np.eye(3), scenario.model.mj.body(body).id, point)
    if asked:
        scenario = replace(scenario, behaviour=Asking(scenario.behaviour, [more], aim))
    return list(islice(Episode(scenario), 240))


def circle(time):
    """A place before the left shoulder that goes round once in two seconds, and its velocity."""
    angle = np.pi * time
    place = np.array([0.35, 0.30 + 0.12 * np.cos(angle), 1.15 + 0.12 * np.sin(angle)])
    return place, 0.12 * np.pi * np.array([0.0, -np.sin(angle), np.cos(angle)])


@pytest.fixture(scope="module")
def frame():
    """Place and orientation of a body at a position, by kinematics alone."""
    model = build(load(["behaviour=stand"])).model.mj
    data = mujoco.MjData(model)

    def of(position, name):
        data.qpos[:] = position
        mujoco.mj_kinematics(model, data)
        body = data.body(name)
        return body.xpos.copy(), Rotation.from_quat(body.xquat, scalar_first=True)

    return of


def missed(moments, miss):
    """What `miss` says of each settled moment; all of them stand."""
    assert all(moment.state.position[2] > 0.8 for moment in moments)
    return [miss(moment) for moment in moments if moment.state.time >= SETTLED]


def test_a_hand_goes_round(frame):
    def aim(more, state):
        more[0]["target"][0, :3], more[0]["velocity"][0] = circle(state.time)

    def miss(moment):
        place, turn = frame(moment.state.position, "forearm_l")
        return np.linalg.norm(circle(moment.state.time)[0] - place - turn.apply(HAND))

    moments = standing("point", "forearm_l", aim, True, HAND)
    found = missed(moments, miss)
    assert max(found) < 0.03  # [m]
    logged = [np.linalg.norm(moment.decision.error[-1]) for moment in moments]
    assert logged[-len(found) :] == pytest.approx(found, abs=1e-9)
    assert min(missed(standing("point", "forearm_l", aim, False, HAND), miss)) > 0.2


def test_a_head_looks_about_and_stays_level(frame):
    """Left and right by 30 degrees, once in four seconds."""

    def wanted(time):
        return Rotation.from_rotvec([0.0, 0.0, 0.52 * np.sin(0.5 * np.pi * time)])

    def aim(more, state):
        more[0]["target"][0] = wanted(state.time).as_quat(scalar_first=True)
        more[0]["velocity"][0] = [0.0, 0.0, 0.26 * np.pi * np.cos(0.5 * np.pi * state.time)]

    def miss(moment):
        _, turn = frame(moment.state.position, "head")
        return (wanted(moment.state.time) * turn.inv()).magnitude()

    moments = standing("attitude", "head", aim, True)
    found = missed(moments, miss)
    assert max(found) < 0.05  # [rad]
    logged = [np.linalg.norm(moment.decision.error[-1]) for moment in moments]
    assert logged[-len(found) :] == pytest.approx(found, abs=1e-9)
    assert max(missed(standing("attitude", "head", aim, False), miss)) > 0.4
