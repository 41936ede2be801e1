"""Quaternions against scipy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.maths import rotations

RNG = np.random.default_rng(0)
VECTORS = [scale * RNG.normal(size=3) for scale in (1e-9, 1e-3, 0.3, 1.0, 3.0, 20.0)]
UNITS = [v / np.linalg.norm(v) for v in RNG.normal(size=(8, 3))]


def scipy_of(quaternion):
    return Rotation.from_quat(quaternion, scalar_first=True)


def assert_same_rotation(quaternion, expected, tolerance=1e-12):
    assert np.linalg.norm(quaternion) == pytest.approx(1.0, abs=1e-12)
    assert np.abs(scipy_of(quaternion).as_matrix() - expected.as_matrix()).max() < tolerance


@pytest.mark.parametrize("vector", VECTORS)
def test_rotation_vector_to_quaternion(vector):
    found = rotations.quaternion_from_rotation_vector(vector)
    assert_same_rotation(found, Rotation.from_rotvec(vector))


def test_no_rotation():
    found = rotations.quaternion_from_rotation_vector(np.zeros(3))
    assert found.tolist() == [1.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("vector", VECTORS)
def test_rotate(vector):
    other = RNG.normal(size=3)
    quaternion = rotations.quaternion_from_rotation_vector(vector)
    expected = Rotation.from_rotvec(vector).apply(other)
    assert rotations.rotate(quaternion, other) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("first", VECTORS)
@pytest.mark.parametrize("second", VECTORS)
def test_multiply_turns_by_the_right_one_first(first, second):
    found = rotations.multiply(
        rotations.quaternion_from_rotation_vector(second),
        rotations.quaternion_from_rotation_vector(first),
    )
    assert_same_rotation(found, Rotation.from_rotvec(second) * Rotation.from_rotvec(first))


@pytest.mark.parametrize("vector", VECTORS)
def test_advance_turns_in_the_world_frame(vector):
    start = Rotation.from_rotvec([0.4, -1.1, 0.7])
    found = rotations.advance(start.as_quat(scalar_first=True), vector)
    assert_same_rotation(found, Rotation.from_rotvec(vector) * start)


def test_scaled_is_each_number_by_the_factor():
    assert rotations.scaled([1.0, -2.5, 0.0], -0.5) == (-0.5, 1.25, 0.0)


def test_advance_keeps_the_length_at_one():
    quaternion = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(5000):
        quaternion = rotations.advance(quaternion, np.array([0.1, 0.2, -0.3]))
    assert np.linalg.norm(quaternion) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("start", UNITS)
@pytest.mark.parametrize("end", UNITS)
def test_rotation_between_is_the_shortest(start, end):
    found = rotations.rotation_between(start, end)
    assert Rotation.from_rotvec(found).apply(start) == pytest.approx(end, abs=1e-12)
    angle = np.arccos(np.clip(start @ end, -1.0, 1.0))
    assert np.linalg.norm(found) == pytest.approx(angle, abs=1e-7)


@pytest.mark.parametrize("angle", [1e-6, 3.0, np.pi - 1e-6])
def test_rotation_between_at_the_ends_of_its_range(angle):
    start, axis = np.array([0.0, 1.0, 0.0]), np.array([0.6, 0.0, 0.8])
    end = Rotation.from_rotvec(angle * axis).apply(start)
    assert rotations.rotation_between(start, end) == pytest.approx(angle * axis, abs=1e-9)


def test_rotation_between_opposite_vectors_is_zero():
    up = np.array([0.0, 0.0, 1.0])
    assert rotations.rotation_between(up, -up) == (0.0, 0.0, 0.0)


def test_cross():
    a, b = RNG.normal(size=(2, 3))
    assert rotations.cross(a, b) == pytest.approx(np.cross(a, b), abs=1e-15)
