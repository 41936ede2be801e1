"""Angular excursion against bodies whose rotation is known."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import rotate
from rotctl.mechanics import excursion
from rotctl.mechanics.momentum import read_momentum

Y = np.array([0.0, 1.0, 0.0])
PERIOD = 1.0 / 60.0
NEVER = 1e9  # correction time without effect
BRICK = """
<mujoco>
  <option gravity="0 0 0" integrator="RK4" timestep="{step}"/>
  <worldbody>
    <body><freejoint/><geom type="box" size="{size}" mass="5" euler="20 -35 50"/></body>
  </worldbody>
</mujoco>
"""


def spin(size, velocity, seconds):
    """A free brick's phi after torque-free flight, fed by its own momentum readings."""
    mj = mujoco.MjModel.from_xml_string(BRICK.format(step=PERIOD / 4, size=size))
    data = mujoco.MjData(mj)
    axes = Rotation.from_quat(mj.body_iquat[1], scalar_first=True).as_matrix()
    data.qvel[3:] = axes @ velocity  # along the principal axes
    now = excursion.start(0.0, Y)
    for _ in range(round(seconds / PERIOD)):
        mujoco.mj_forward(mj, data)
        omega = read_momentum(mj, data).angular_velocity
        now = excursion.integrate(now, omega, Y, Y, PERIOD, NEVER)
        mujoco.mj_step(mj, data, 4)
    mujoco.mj_forward(mj, data)
    return now, axes @ velocity, data.xmat[1].reshape(3, 3)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_principal_axis_spin_of_a_free_brick(axis):
    """Torque-free about a principal axis that is askew in the world: phi = omega t."""
    now, omega, attitude = spin("0.1 0.2 0.4", 3.0 * np.eye(3)[axis], 2.0)
    assert now.angle == pytest.approx(2.0 * omega, abs=1e-4)
    carried = np.array([rotate(now.orientation, e) for e in np.eye(3)]).T
    assert carried == pytest.approx(attitude, abs=1e-4)


def test_free_cube_about_a_general_axis():
    now, omega, attitude = spin("0.2 0.2 0.2", np.array([1.0, -2.0, 0.7]), 3.0)
    assert now.angle == pytest.approx(3.0 * omega, abs=1e-9)
    assert now.angle @ now.angle > (2 * np.pi) ** 2  # more than a turn: phi does not wrap
    carried = np.array([rotate(now.orientation, e) for e in np.eye(3)]).T
    assert carried == pytest.approx(attitude, abs=1e-6)


def test_start_is_phi_0():
    now = excursion.start(-0.3, Y)
    assert now.angle.tolist() == [0.0, -0.3, 0.0]
    assert now.phase == -0.3
    assert now.orientation.tolist() == [1.0, 0.0, 0.0, 0.0]


def test_integrate_leaves_its_input_alone():
    before = excursion.start(0.0, Y)
    excursion.integrate(before, np.ones(3), Y, Y, PERIOD, 0.4)
    assert not before.angle.any()
    assert before.orientation.tolist() == [1.0, 0.0, 0.0, 0.0]


def coning(tilt, correction_time, seconds, spin_rate=6.0):
    """A body tilted about x that spins about world y; its lateral axis draws a cone."""
    now = excursion.start(0.0, Y)
    for i in range(1, round(seconds / PERIOD) + 1):
        attitude = Rotation.from_rotvec(spin_rate * i * PERIOD * Y) * Rotation.from_rotvec(
            [tilt, 0.0, 0.0]
        )
        lateral = attitude.apply(Y)
        now = excursion.integrate(now, spin_rate * Y, lateral, Y, PERIOD, correction_time)
    return now, lateral


@pytest.mark.parametrize("tilt", [0.1, -0.5, 1.2])
def test_coning_is_unseen_by_the_integral_and_seen_when_oriented(tilt):
    now, lateral = coning(tilt, 0.2, 4.0)
    printed = excursion.error(now, np.zeros(3), Y, "integral")
    oriented = excursion.error(now, np.zeros(3), Y, "oriented")
    assert printed[[0, 2]] == pytest.approx([0.0, 0.0], abs=1e-12)
    across = oriented * [1.0, 0.0, 1.0]
    assert np.linalg.norm(across) == pytest.approx(abs(tilt), abs=1e-3)
    # The error is the rotation that brings the body's own axis back.
    assert Rotation.from_rotvec(across).apply(lateral) == pytest.approx(Y, abs=1e-3)


def test_in_plane_both_are_the_plain_integral():
    now, _ = coning(0.3, 0.4, 1.0)
    for name in ("integral", "oriented"):
        error = excursion.error(now, np.array([0.0, 1.5, 0.0]), Y, name)
        assert error[1] == pytest.approx(1.5 - now.angle[1], abs=1e-12)
    assert now.angle[1] == pytest.approx(6.0, abs=1e-9)


def test_oriented_error_of_a_body_that_turned_away():
    """Seen at once, without correction: omega itself carried the axis away."""
    now = excursion.start(0.0, Y)
    for _ in range(30):
        now = excursion.integrate(now, np.array([0.8, 0.0, 0.0]), Y, Y, PERIOD, NEVER)
    expected = [-0.8 * 30 * PERIOD, 0.0, 0.0]
    assert excursion.error(now, np.zeros(3), Y, "oriented") == pytest.approx(expected, abs=1e-6)
    assert excursion.error(now, np.zeros(3), Y, "integral") == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("correction_time", [0.2, 0.4, 1.0])
def test_correction_time_is_a_time_constant(correction_time):
    """A small drift decays by 1 - period / correction time a step: by about e in that time."""
    tilt = np.array([0.02, 0.0, 0.0])
    lateral = Rotation.from_rotvec(tilt).apply(Y)
    now = excursion.start(0.0, Y)
    steps = round(correction_time / PERIOD)
    for _ in range(steps):
        now = excursion.integrate(now, np.zeros(3), lateral, Y, PERIOD, correction_time)
    missing = np.linalg.norm(rotate(now.orientation, Y) - lateral) / 0.02
    assert missing == pytest.approx((1 - PERIOD / correction_time) ** steps, rel=1e-3)
    assert missing == pytest.approx(np.exp(-1.0), rel=0.06)
    assert not now.angle.any()  # eq. 1 itself is not corrected


@pytest.mark.parametrize("phase_time", [0.5, 3.0])
@pytest.mark.parametrize("lag", [-2.0, 0.4, 7.0])
def test_phase_follows_the_integral_and_is_pulled_to_the_trunk(lag, phase_time):
    """A body that turns at 6 rad/s with its trunk behind: what is missing decays."""
    now, steps = excursion.start(0.0, Y), round(phase_time / PERIOD)
    for i in range(1, steps + 1):
        now = excursion.integrate(now, 6.0 * Y, Y, Y, PERIOD, NEVER)
        trunk = 6.0 * i * PERIOD - lag
        now = excursion.keep_phase(now, trunk, PERIOD, phase_time)
    near = (lag + np.pi) % (2 * np.pi) - np.pi  # whole revolutions do not count
    missing = now.phase - (trunk + lag - near)
    assert missing / near == pytest.approx((1 - PERIOD / phase_time) ** steps, rel=1e-6)
    assert now.angle[1] == pytest.approx(6.0 * steps * PERIOD)  # eq. 1 itself is not corrected


def test_phase_without_a_trunk_that_differs_is_the_integral():
    now = excursion.start(0.3, Y)
    for i in range(1, 100):
        now = excursion.integrate(now, -5.0 * Y, Y, Y, PERIOD, 0.4)
        now = excursion.keep_phase(now, 0.3 - 5.0 * i * PERIOD, PERIOD, 0.4)
    assert now.phase == pytest.approx(now.angle[1], abs=1e-9)


def test_correction_faster_than_a_period_does_not_overshoot():
    lateral = Rotation.from_rotvec([0.01, 0.0, 0.0]).apply(Y)
    now = excursion.start(0.0, Y)
    now = excursion.integrate(now, np.zeros(3), lateral, Y, PERIOD, PERIOD / 100)
    assert rotate(now.orientation, Y) == pytest.approx(lateral, abs=1e-6)
