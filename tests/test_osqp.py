"""OSQP: right on small problems, honest about failures, independent of its history."""

import numpy as np
import pytest
from scipy.optimize import LinearConstraint, minimize

from rotctl.control import condensed
from rotctl.qp import Problem, make_solver
from rotctl.qp.boxqp import BoxQP
from rotctl.qp.osqp import Osqp

INF = np.inf


def problem(H, f, lower, upper, G=None, low=(), high=()):
    n = len(f)
    rows = np.empty((0, n)) if G is None else np.array(G, dtype=float)
    parts = (np.array(part, dtype=float) for part in (H, f, lower, upper))
    return Problem(*parts, rows, np.array(low, dtype=float), np.array(high, dtype=float))


FREE = ([-INF, -INF], [INF, INF])
GOOD = {
    "bound": (problem(np.eye(2), [-3, 1], [0, 0], [1, 1]), [1, 0]),
    "free": (problem(np.eye(2), [-3, 1], *FREE), [3, -1]),
    "fixed": (problem(np.eye(2), [-3, 1], [0.3, -9], [0.3, 9]), [0.3, -1]),
    "row": (problem(np.eye(2), [-3, -3], *FREE, [[1, 1]], [-INF], [2]), [1, 1]),
    "row from below": (problem(np.eye(2), [1, 1], *FREE, [[1, 1]], [2], [INF]), [1, 1]),
    "equality": (problem(np.eye(2), [-1, 1], *FREE, [[1, 1]], [2], [2]), [2, 0]),
    "row out of reach": (problem(np.eye(2), [-3, 1], *FREE, [[1, 1]], [-50], [50]), [3, -1]),
    "badly scaled": (
        problem(np.diag([1e6, 1e-2]), [-2e6, 30], *FREE, [[1e3, 0]], [-INF], [1e3]),
        [1, -3000],
    ),
    "flat": (problem([[1, 1], [1, 1]], [-1, -1], [0, 0], [0.5, 9]), None),
}
INFEASIBLE = problem(np.eye(2), [1, -2], *FREE, [[1, 1], [1, 1]], [2, -INF], [INF, 1])


@pytest.mark.parametrize("name", GOOD)
def test_known_answers(name):
    stated, expected = GOOD[name]
    solution = Osqp().solve(stated, None)
    assert solution.solved, solution.reason
    assert solution.iterations > 0
    assert stated.violation(solution.x) < 1e-4
    if expected is None:
        assert solution.x.sum() == pytest.approx(1.0, abs=1e-4)
    else:
        assert solution.x == pytest.approx(np.array(expected), abs=2e-4, rel=2e-4)


def random_rows(seed, n=8, k=6):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n + 3, n))
    G, inside = rng.normal(size=(k, n)), rng.normal(size=n) * 0.2
    width = rng.uniform(0.01, 1, (2, k))
    width[:, 0] = 0.0  # an equality
    low, high = G @ inside - width[0], G @ inside + width[1]
    low[1], high[2] = -INF, INF
    return Problem(A.T @ A, 3 * rng.normal(size=n), np.full(n, -1.0), np.full(n, 1.0), G, low, high)


@pytest.mark.parametrize("seed", range(8))
def test_against_scipy(seed):
    stated = random_rows(seed)
    expected = minimize(
        stated.objective,
        np.zeros(len(stated.f)),
        jac=lambda x: stated.H @ x + stated.f,
        method="SLSQP",
        bounds=list(zip(stated.lower, stated.upper, strict=True)),
        constraints=[
            LinearConstraint(stated.G[:1], stated.low[:1], stated.high[:1]),
            LinearConstraint(stated.G[1:], stated.low[1:], stated.high[1:]),
        ],
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert expected.success
    solution = Osqp().solve(stated, None)
    assert solution.solved
    assert stated.violation(solution.x) < 1e-3
    assert solution.x == pytest.approx(expected.x, abs=2e-3)


def test_infeasible_rows():
    """OSQP fills x with 2143289344.0 then; it must not get out."""
    solution = Osqp().solve(INFEASIBLE, None)
    assert not solution.solved
    assert solution.reason.startswith("OSQP: ")
    assert not solution.x.any()
    assert solution.iterations > 0


@pytest.mark.parametrize("part", ["H", "f"])
@pytest.mark.parametrize("bad", [np.nan, INF])
def test_numbers_that_are_not_finite(part, bad):
    stated = problem(np.eye(2), [1, 1], [0, 0], [1, 1])
    getattr(stated, part).flat[0] = bad
    solution = Osqp().solve(stated, None)
    assert not solution.solved
    assert solution.reason == "the problem has numbers that are not finite"


def crossed_bounds():
    return problem(np.eye(2), [-3, 1], [1, 0], [0, 1])


def crossed_rows():
    return problem(np.eye(2), [-3, 1], *FREE, [[1, 1]], [2], [1])


def nan_rows():
    return problem(np.eye(2), [-3, 1], *FREE, [[np.nan, 1]], [0], [1])


@pytest.mark.parametrize("make", [crossed_bounds, crossed_rows, nan_rows])
@pytest.mark.parametrize("used", [False, True], ids=["fresh", "used"])
def test_impossible_problems_are_not_solved(make, used):
    """Neither by an exception, nor by the answer to the workspace's last problem."""
    solver = Osqp()
    if used:
        assert solver.solve(GOOD["free"][0], None).solved
        assert solver.solve(GOOD["row"][0], None).solved
    solution = solver.solve(make(), None)
    assert not solution.solved
    assert solution.reason


def test_not_convex():
    solution = Osqp().solve(problem([[1, 2], [2, 1]], [1, 1], *FREE), None)
    assert not solution.solved
    assert solution.reason.startswith("OSQP: ")


def test_a_nan_bound_is_not_solved():
    solution = Osqp().solve(problem(np.eye(2), [1, 1], [np.nan, 0], [1, 1]), None)
    assert not solution.solved
    assert solution.reason


def test_result_does_not_depend_on_history():
    """Same bytes after other problems of the same size, good and bad ones."""
    stated, solver = random_rows(3), Osqp()
    fresh = solver.solve(stated, None)
    assert fresh.solved
    for seed in range(4, 8):  # other constraint types on the same rows, other step sizes
        other = random_rows(seed)
        other.low[:], other.high[:] = np.roll(other.low, seed), np.roll(other.high, seed)
        other.H[:] *= 10.0 ** (seed - 5)
        solver.solve(other, np.ones(8))
        again = solver.solve(stated, None)
        assert again.x.tobytes() == fresh.x.tobytes()
        assert (again.iterations, again.residual) == (fresh.iterations, fresh.residual)
    broken = random_rows(3)
    broken.f[0] = np.nan
    solver.solve(broken, None)
    infeasible = random_rows(3)
    infeasible.lower[:], infeasible.upper[:] = 5.0, 6.0
    assert not solver.solve(infeasible, None).solved
    assert solver.solve(stated, None).x.tobytes() == fresh.x.tobytes()
    assert Osqp().solve(stated, None).x.tobytes() == fresh.x.tobytes()


def test_start_is_ignored():
    stated = random_rows(1)
    cold = Osqp().solve(stated, None)
    assert Osqp().solve(stated, np.full(8, 0.7)).x.tobytes() == cold.x.tobytes()


def test_agrees_with_boxqp_on_recorded_steps(world, supported):
    """Approximate, but never unsolved, and close."""
    solver, apart = Osqp(), []
    for step in supported[::2]:
        _, stack = world.stack(step)
        found = condensed.solve(stack, solver)
        assert found.solution.solved, found.solution.reason
        apart.append(np.abs(found.torque - condensed.solve(stack, BoxQP()).torque).max())
    assert np.median(apart) < 0.3
    assert np.percentile(apart, 90) < 3.0


def test_through_make_solver():
    assert make_solver("osqp").name == "osqp"
    assert make_solver("osqp").shape == "rows"
