"""MuJoCo's box solver against known answers, optimality conditions and scipy."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from rotctl.control import condensed
from rotctl.qp import make_solver, without_rows
from rotctl.qp.boxqp import BoxQP

INF = np.inf


def box(H, f, lower, upper):
    arrays = (np.array(part, dtype=float) for part in (H, f, lower, upper))
    return without_rows(*arrays)


def solved(problem, start=None):
    solution = BoxQP().solve(problem, start)
    assert solution.solved, solution.reason
    assert solution.reason == ""
    return solution.x


def assert_optimal(problem, x, tolerance):
    """Feasible; the gradient vanishes where x is free and pushes against its bound elsewhere."""
    assert problem.violation(x) <= tolerance
    gradient = problem.H @ x + problem.f
    scale = tolerance * (1 + np.abs(problem.f).max())
    low, high = x <= problem.lower + tolerance, x >= problem.upper - tolerance
    assert (gradient[~high] >= -scale).all() or not (~high & ~low).any()
    assert (np.abs(gradient[~low & ~high]) <= scale).all()
    assert (gradient[low & ~high] >= -scale).all()
    assert (gradient[high & ~low] <= scale).all()


@pytest.mark.parametrize(
    ("problem", "expected"),
    [
        (box([[1.0]], [-3], [0], [1]), [1.0]),
        (box([[1.0]], [3], [0], [1]), [0.0]),
        (box([[2.0]], [-1], [0], [1]), [0.5]),
        (box(np.eye(2), [-3, 1], [-INF, -INF], [INF, INF]), [3.0, -1.0]),
        (box(np.eye(2), [-3, 1], [-INF, 0], [2, INF]), [2.0, 0.0]),
        (box([[2, 1], [1, 2]], [-3, -3], [-9, -9], [9, 9]), [1.0, 1.0]),
        (box([[2, 1], [1, 2]], [-3, -3], [-9, -9], [0.5, 9]), [0.5, 1.25]),
        (box(np.diag([1e6, 1e-4]), [-2e6, 3e-4], [-9, -9], [9, 9]), [2.0, -3.0]),
        (box(np.eye(2), [-3, 1], [0.3, -9], [0.3, 9]), [0.3, -1.0]),  # a fixed variable
        (box(np.zeros((1, 1)), [0], [-1], [1]), [0.0]),
    ],
)
def test_known_answers(problem, expected):
    assert solved(problem) == pytest.approx(np.array(expected), abs=2e-6)


def random_box(rng, n, rank):
    """A least-squares problem in a box; of low rank, its Hessian is singular."""
    A, b = rng.normal(size=(rank, n)), rng.normal(size=rank)
    scale = 10.0 ** rng.uniform(-2, 2, n)
    lower = np.where(rng.uniform(size=n) < 0.3, -INF, -rng.uniform(size=n)) / scale
    upper = np.where(rng.uniform(size=n) < 0.3, INF, rng.uniform(size=n)) / scale
    return A * scale, b, lower, upper


@pytest.mark.parametrize("seed", range(20))
def test_against_least_squares_with_bounds(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 30))
    A, b, lower, upper = random_box(rng, n, n + 5)
    problem = without_rows(A.T @ A, -A.T @ b, lower, upper)
    expected = lsq_linear(A, b, (lower, upper), method="bvls", tol=1e-14).x
    found = solved(problem)
    size = np.sqrt(np.diag(problem.H))
    assert (found * size) == pytest.approx(expected * size, abs=1e-4)
    assert problem.objective(found) <= problem.objective(expected) + 1e-6


@pytest.mark.parametrize("seed", range(20))
def test_singular_hessians(seed):
    """More variables than rank, as with four generators for three force components."""
    rng = np.random.default_rng(seed)
    A, b, lower, upper = random_box(rng, 24, 15)
    lower, upper = np.maximum(lower, -1e3), np.minimum(upper, 1e3)
    problem = without_rows(A.T @ A, -A.T @ b, lower, upper)
    found = solved(problem)
    assert problem.violation(found) <= 1e-9 * (1 + np.abs(found).max())
    expected = lsq_linear(A, b, (lower, upper), method="bvls", tol=1e-14).x
    assert problem.objective(found) <= problem.objective(expected) + 1e-5


def test_optimality_conditions():
    rng = np.random.default_rng(1)
    for _ in range(20):
        A = rng.normal(size=(12, 8))
        f = 5 * rng.normal(size=8)
        problem = without_rows(A.T @ A, f, np.full(8, -0.3), np.full(8, 0.4))
        assert_optimal(problem, solved(problem), 1e-5)


def test_the_start_does_not_matter():
    rng = np.random.default_rng(2)
    A, b, lower, upper = random_box(rng, 12, 20)
    problem = without_rows(A.T @ A, -A.T @ b, lower, upper)
    size = np.sqrt(np.diag(problem.H))
    cold = solved(problem)
    for scale in (0.1, 1.0, 1e3):
        warm = solved(problem, scale * rng.normal(size=12) / size)
        assert warm * size == pytest.approx(cold * size, abs=1e-6)


def test_input_is_left_alone():
    problem = box([[2, 1], [1, 2]], [-3, -3], [-9, -9], [0.5, 9])
    start = np.array([0.1, 0.2])
    solved(problem, start)
    assert start.tolist() == [0.1, 0.2]
    assert problem.H.tolist() == [[2, 1], [1, 2]]
    assert problem.upper.tolist() == [0.5, 9]


@pytest.mark.parametrize("bad", [np.nan, INF, -INF])
@pytest.mark.parametrize("part", ["H", "f"])
def test_numbers_that_are_not_finite(part, bad):
    problem = box(np.eye(2), [1, 1], [0, 0], [1, 1])
    getattr(problem, part).flat[0] = bad
    solution = BoxQP().solve(problem, None)
    assert not solution.solved
    assert solution.reason == "the problem has numbers that are not finite"


@pytest.mark.filterwarnings("ignore:invalid value")
@pytest.mark.parametrize("bad", [-INF, INF])
def test_infinities_that_cancel(bad):
    solution = BoxQP().solve(box(np.eye(2), [bad, -bad], [0, 0], [1, 1]), None)
    assert not solution.solved
    assert solution.reason == "the problem has numbers that are not finite"


def test_bounds_that_are_not_numbers():
    solution = BoxQP().solve(box(np.eye(2), [1, 1], [np.nan, 0], [1, 1]), None)
    assert not solution.solved
    assert solution.reason


def test_not_convex():
    problem = box([[1, 2], [2, 1]], [1, 1], [-INF, -INF], [INF, INF])
    solution = BoxQP().solve(problem, None)
    assert not solution.solved
    assert solution.reason == "mju_boxQP found the Hessian not positive definite"


def test_bounds_that_cross():
    """No point is in an empty box."""
    solution = BoxQP().solve(box(np.eye(2), [-3, 1], [1, 0], [0, 1]), None)
    assert not solution.solved
    assert solution.reason


def test_no_warning_on_a_negative_diagonal():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not BoxQP().solve(box([[-1, 0], [0, 1]], [1, 1], [-1, -1], [1, 1]), None).solved


def test_regularisation_moves_torques_by_less_than_a_millinewtonmetre(world, steps):
    """Against an exact solver with rows, over all recorded steps."""
    exact, worst = make_solver("qpsolvers:daqp"), 0.0
    for step in steps:
        _, stack = world.stack(step)
        for share in (1.0, 0.3):
            limited = replace(stack, torque_limit=share * stack.torque_limit)
            found = condensed.solve(limited, BoxQP())
            expected = condensed.solve(limited, exact)
            assert found.solution.solved
            assert expected.solution.solved
            worst = max(worst, np.abs(found.torque - expected.torque).max())
    assert worst < 1e-3


def test_deterministic(world, supported):
    _, stack = world.stack(supported[0])
    _, other = world.stack(supported[20])
    solver = BoxQP()
    first = condensed.solve(stack, solver)
    condensed.solve(other, solver)
    again = condensed.solve(stack, solver)
    assert first.torque.tobytes() == again.torque.tobytes()
