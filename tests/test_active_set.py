"""The active-set method against scipy and an exact solver, on problems boxqp finds hard too."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from rotctl.qp import make_solver, without_rows
from rotctl.qp.active_set import ActiveSet


def pyramid_problem(rng, contacts):
    """Forces of `contacts` points on one body as sums of pyramid edges: rank six at most."""
    edges = np.array([[1, 1, 1, 1], [0.8, 0.8, -0.8, -0.8], [0.8, -0.8, 0.8, -0.8]])
    maps = np.concatenate(
        [np.vstack((edges, np.cross(rng.normal(size=3), edges.T).T)) for _ in range(contacts)],
        axis=1,
    )
    n = maps.shape[1]
    H = maps.T @ maps + 1e-4 * np.kron(np.eye(contacts), edges.T @ edges)
    f = -maps.T @ (300.0 * rng.normal(size=6))
    return without_rows(H, f, np.zeros(n), np.full(n, np.inf))


@pytest.mark.parametrize("seed", range(20))
def test_against_bounded_least_squares(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 30))
    A, b = rng.normal(size=(n + 5, n)), rng.normal(size=n + 5)
    upper = rng.uniform(0.05, 2.0, n)
    solution = ActiveSet().solve(without_rows(A.T @ A, -A.T @ b, -upper, upper), None)
    assert solution.solved, solution.reason
    expected = lsq_linear(A, b, (-upper, upper), tol=1e-14).x
    assert solution.x == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("contacts", [1, 3, 10, 25])
def test_singular_problems_of_many_contacts(contacts):
    """The objective is that of an exact solver, though the edges are not unique."""
    rng = np.random.default_rng(contacts)
    for _ in range(5):
        problem = pyramid_problem(rng, contacts)
        solution = ActiveSet().solve(problem, None)
        assert solution.solved, solution.reason
        exact = make_solver("qpsolvers:daqp").solve(problem, None)
        assert exact.solved
        best = problem.objective(exact.x)
        assert problem.objective(solution.x) == pytest.approx(best, rel=1e-6, abs=1e-3)
        assert problem.violation(solution.x) <= 1e-9


def test_any_start_leads_to_the_same_answer():
    rng = np.random.default_rng(0)
    A = rng.normal(size=(12, 12))
    problem = without_rows(A.T @ A, rng.normal(size=12), -np.ones(12), np.ones(12))
    answers = [
        ActiveSet().solve(problem, start).x
        for start in (None, np.ones(12), -np.ones(12), rng.uniform(-3, 3, 12))
    ]
    for answer in answers[1:]:
        assert answer == pytest.approx(answers[0], abs=1e-5)


def test_ill_posed_problems_are_refused():
    nothing = np.zeros(1)
    for H, f, lower, upper in (
        ([[np.nan]], [0], [0], [1]),
        ([[1]], [np.inf], [0], [1]),
        ([[1]], [0], [1], [0]),
    ):
        problem = without_rows(*(np.array(part, dtype=float) for part in (H, f, lower, upper)))
        solution = ActiveSet().solve(problem, nothing)
        assert not solution.solved
        assert solution.reason
