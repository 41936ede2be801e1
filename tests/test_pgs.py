"""Projected Gauss-Seidel against exact enumeration and another solver, and C against numpy."""

import itertools

import numpy as np
import pytest
import scipy.optimize

from rotctl.config.loading import load
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation import pgs
from rotctl.simulation.pgs import NO_NORMAL, Rows, solve, solve_compiled

needs_library = pytest.mark.skipif(
    pgs.library() is None,
    reason="the compiled contact solver is not built here (no C compiler at installation)",
)
SOLVERS = [solve, pytest.param(solve_compiled, marks=needs_library)]
MU = 0.5
FOLLOW = 0.5


def problem(seed, contacts, limits):
    """Random well-conditioned rows: contacts of a normal and two tangents, then limits."""
    generator = np.random.default_rng(seed)
    n = 3 * contacts + limits
    J = generator.normal(size=(n, n + 4))
    normal = np.full(n, NO_NORMAL, dtype=np.int32)
    friction = np.zeros(n)
    for c in range(contacts):
        normal[3 * c + 1 : 3 * c + 3] = 3 * c
        friction[3 * c + 1 : 3 * c + 3] = MU
    return Rows(J @ J.T / n, generator.normal(size=n), normal, friction)


def enumerated(rows):
    """Every exact solution: each row's three or two cases in turn, solved as linear equations."""
    n = len(rows.b)
    cases = [(0, 1) if rows.normal[i] == NO_NORMAL else (0, 1, -1) for i in range(n)]
    found = []
    for case in itertools.product(*cases):
        # Free normals and friction rows at a bound have one equation in p, the others w = 0.
        system, right = rows.A.copy(), -rows.b
        for i in range(n):
            if rows.normal[i] == NO_NORMAL and case[i] == 0:
                system[i], right[i] = np.eye(n)[i], 0.0
            elif rows.normal[i] != NO_NORMAL and case[i]:
                system[i] = np.eye(n)[i]
                system[i, rows.normal[i]] -= case[i] * rows.friction[i]
                right[i] = 0.0
        p = np.linalg.solve(system, right)
        if complementary(rows, p, 1e-9):
            found.append(p)
    return found


def complementary(rows, p, slack):
    w = rows.A @ p + rows.b
    for i in range(len(p)):
        if rows.normal[i] == NO_NORMAL:
            fits = p[i] >= -slack and w[i] >= -slack and min(p[i], w[i]) <= slack
        else:
            most = rows.friction[i] * p[rows.normal[i]]
            sticks = abs(w[i]) <= slack
            slides = abs(p[i] + np.sign(w[i]) * most) <= slack
            fits = abs(p[i]) <= most + slack and (sticks or slides)
        if not fits:
            return False
    return True


@pytest.mark.parametrize("solver", SOLVERS)
def test_an_exact_solution(solver):
    stuck = slid = lifted = 0
    for seed in range(12):
        rows = problem(seed, contacts=2, limits=1)
        exact = enumerated(rows)
        found = solver(rows, 5000, 1e-14, 1.0 if seed % 2 else FOLLOW)
        assert found.residual < 1e-9
        assert min(np.abs(found.p - p).max() for p in exact) < 1e-7
        bound = rows.friction * found.p[rows.normal]
        tangent = rows.normal != NO_NORMAL
        lifted += (found.p[~tangent] == 0.0).sum()
        slid += ((np.abs(found.p) >= bound - 1e-9) & tangent & (bound > 1e-6)).sum()
        stuck += ((np.abs(found.p) < bound - 1e-6) & tangent).sum()
    assert min(stuck, slid, lifted) > 3


@pytest.mark.parametrize("solver", SOLVERS)
def test_without_friction_it_is_least_squares_with_bounds(solver):
    """min 1/2 p'Ap + b'p over p >= 0, by scipy's own active-set method."""
    for seed in range(10):
        rows = problem(seed, contacts=0, limits=9)
        L = np.linalg.cholesky(rows.A)
        expected, _ = scipy.optimize.nnls(L.T, -np.linalg.solve(L, rows.b))
        found = solver(rows, 20000, 1e-13, FOLLOW)
        assert found.p == pytest.approx(expected, abs=1e-8)
        assert 0 < (expected == 0.0).sum() < 9


@pytest.mark.parametrize("solver", SOLVERS)
def test_sweeps_are_capped_and_the_rest_is_told(solver):
    rows = problem(1, contacts=4, limits=2)
    short, long = solver(rows, 2, 0.0, FOLLOW), solver(rows, 5000, 1e-12, FOLLOW)
    assert short.sweeps == 2
    assert 10 < long.sweeps < 5000
    assert short.residual > 1e-3 > 1e-9 > long.residual


@pytest.mark.parametrize("solver", SOLVERS)
def test_no_rows(solver):
    found = solver(problem(0, 0, 0), 10, 1e-9, FOLLOW)
    assert (found.p.size, found.residual) == (0, 0.0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_what_is_not_finite_stays_so(solver):
    rows = problem(0, 2, 0)
    rows.b[3] = np.nan
    with np.errstate(invalid="ignore"):
        assert not np.isfinite(solver(rows, 10, 1e-9, FOLLOW).p).all()


@needs_library
def test_compiled_is_the_reference_on_a_roll():
    scenario = build(load(["physics=lockstep", "seed=1", "duration=1.5"]))
    seen = []

    def both(rows, *settings):
        slow, fast = solve(rows, *settings), solve_compiled(rows, *settings)
        assert fast.sweeps == slow.sweeps
        assert fast.p == pytest.approx(slow.p, abs=1e-9 * (1 + np.abs(slow.p).max()))
        assert fast.residual == pytest.approx(slow.residual, rel=1e-6, abs=1e-12)
        if slow.residual < 1e-7:
            assert complementary(rows, slow.p, 1e-5)
        seen.append((len(rows.b), slow.sweeps, (rows.friction > 0).any()))
        return slow

    scenario.stepper._solve = both
    in_memory(scenario)
    rows, sweeps, friction = zip(*seen, strict=True)
    assert len(seen) >= 85
    assert (max(rows) > 30, max(sweeps) > 50, all(friction)) == (True, True, True)


@needs_library
def test_a_bound_that_follows_slowly_ends_the_cycles_of_the_plain_method():
    """States of a roll: some never converge with bounds at mu p_n, all do with these."""
    overrides = ["physics=lockstep", "behaviour=forward_roll_1_phase", "seed=0", "duration=4"]
    scenario = build(load(overrides))
    residuals = []

    def both(rows, sweeps, tolerance, follow):
        plain, found = (solve_compiled(rows, 2000, tolerance, f) for f in (1.0, FOLLOW))
        residuals.append((plain.residual, found.residual))
        return found

    scenario.stepper._solve = both
    in_memory(scenario)
    plain, found = np.array(residuals).T
    assert plain.max() > 0.1
    assert found.max() < 0.01
