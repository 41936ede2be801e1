"""A behaviour along another heading is the same motion, turned: the world's axes do not matter."""

from itertools import islice

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.config.loading import load
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

HEADINGS = (37, 90, 180)  # [deg]


def first_second(overrides, heading):
    """The moments of the first second along a heading."""
    scenario = build(load([*overrides, f"behaviour.heading={heading}"]))
    moments = list(islice(Episode(scenario), round(scenario.controller.settings.rate)))
    assert len(moments) == round(scenario.controller.settings.rate)
    return moments


def turned_back(position, turn):
    """A position with its root turned back (nq,); of the quaternion's two signs one."""
    root = turn.inv() * Rotation.from_quat(position[3:7], scalar_first=True)
    quaternion = root.as_quat(scalar_first=True, canonical=True)
    return np.concatenate((turn.inv().apply(position[:3]), quaternion, position[7:]))


@pytest.mark.exact
@pytest.mark.parametrize(
    "overrides",
    [
        ["behaviour=forward_roll_1", "seed=2000"],
        ["behaviour=forward_roll_1_phase", "seed=2001", "controller.backend=reference"],
        ["behaviour=reference_roll", "seed=2000", "excursion=root"],
        ["behaviour=backward_roll_1", "seed=2001", "start=still"],
        # Where boxqp stops short along one heading alone, the two solvers part by 1e-9: seed 2000.
        ["behaviour=sideways_roll", "seed=2003"],
        ["behaviour=forward_roll", "seed=2000", "+course=slalom"],
        ["behaviour=forward_roll_1", "seed=2002", "controller=tracked_excursion"],
        ["behaviour=stand", "seed=2000", "disturbance=push", "disturbance.time=[0.2, 0.2]"],
        ["behaviour=stand", "seed=2001", "disturbance=wind", "controller.sees_disturbance=true"],
        ["behaviour=stand_step", "seed=2000", "disturbance=push", "disturbance.time=[0.6, 0.6]",
         "disturbance.impulse=45"],
    ],
    ids=" ".join,
)  # fmt: skip
def test_the_same_trajectory_turned(overrides):
    """On the flat, over the first second, to rounding."""
    straight = first_second(overrides, 0)
    for heading in HEADINGS:
        turn = Rotation.from_euler("z", heading, degrees=True)
        for there, here in zip(straight, first_second(overrides, heading), strict=True):
            expected = turned_back(there.state.position, Rotation.identity())
            found = turned_back(here.state.position, turn)
            assert found == pytest.approx(expected, abs=1e-9)
            assert here.decision.torque == pytest.approx(there.decision.torque, abs=1e-5)
            assert turn.inv().apply(here.wrench[:3]) == pytest.approx(there.wrench[:3], abs=1e-7)
            axes = turn.apply(there.signals.axes)
            assert here.signals.axes == pytest.approx(axes, abs=1e-9)
            assert here.signals.phase == pytest.approx(there.signals.phase, abs=1e-9)
            error, expected = here.decision.error, there.decision.error
            assert error == pytest.approx(expected, abs=1e-8)  # along the task's own axes


def test_hard_contacts_slide_along_the_physics_own_axes():
    """Lockstep bounds friction along two fixed tangents: the motion turned by 90 degrees is the
    same, the one turned by 37 another."""
    overrides = ["physics=lockstep", "behaviour=forward_roll_1_phase", "seed=2000"]
    straight, *others = (first_second(overrides, heading) for heading in (0, *HEADINGS))
    last = turned_back(straight[-1].state.position, Rotation.identity())
    missed = []
    for heading, moments in zip(HEADINGS, others, strict=True):
        turn = Rotation.from_euler("z", heading, degrees=True)
        missed.append(np.abs(turned_back(moments[-1].state.position, turn) - last).max())
    assert missed[0] > 1e-3
    assert max(missed[1:]) < 1e-6
