"""Solvers of qpsolvers by name; and what an unknown name gets as an answer."""

import re
import sys
from dataclasses import replace

import numpy as np
import pytest
import qpsolvers
from test_osqp import FREE, GOOD, INFEASIBLE, problem, random_rows

from rotctl.control import condensed
from rotctl.errors import InputError
from rotctl.qp import make_solver, without_rows
from rotctl.qp.boxqp import BoxQP

INF = np.inf
NAMES = ["daqp", "piqp"]


@pytest.mark.parametrize("solver", NAMES)
@pytest.mark.parametrize("name", [name for name in GOOD if name != "flat"])
def test_known_answers(solver, name):
    stated, expected = GOOD[name]
    chosen = make_solver(f"qpsolvers:{solver}")
    solution = chosen.solve(stated, None)
    assert chosen.name == f"qpsolvers:{solver}"
    assert chosen.shape == "rows"
    assert solution.solved, solution.reason
    assert solution.x == pytest.approx(np.array(expected), abs=1e-4, rel=1e-4)
    assert solution.residual <= 1e-5


@pytest.mark.parametrize("solver", NAMES)
def test_infeasible_rows(solver):
    solution = make_solver(f"qpsolvers:{solver}").solve(INFEASIBLE, None)
    assert not solution.solved
    assert solution.reason.startswith(f"qpsolvers:{solver}")
    assert not solution.x.any()


@pytest.mark.parametrize("solver", NAMES)
@pytest.mark.parametrize("part", ["H", "f", "lower", "G", "low"])
def test_nan_is_not_solved(solver, part):
    stated = problem(np.eye(2), [1, 1], [0, 0], [9, 9], [[1, 1]], [1], [5])
    getattr(stated, part).flat[0] = np.nan
    solution = make_solver(f"qpsolvers:{solver}").solve(stated, None)
    assert not solution.solved
    assert solution.reason


def test_a_solver_s_exception_is_a_failed_row(monkeypatch):
    def explode(*_, **__):
        raise RuntimeError("licence expired")

    solver = make_solver("qpsolvers:daqp")
    monkeypatch.setattr(qpsolvers, "solve_problem", explode)
    solution = solver.solve(GOOD["row"][0], None)
    assert not solution.solved
    assert solution.reason == "qpsolvers:daqp: licence expired"


def test_a_solution_that_breaks_its_constraints_is_refused(monkeypatch):
    def careless(stated, _):
        solution = qpsolvers.Solution(stated)
        solution.found, solution.x = True, np.array([1.5, 1.5])
        solution.z, solution.z_box, solution.y = np.array([1.5]), np.zeros(2), np.empty(0)
        return solution

    solver = make_solver("qpsolvers:daqp")
    monkeypatch.setattr(qpsolvers, "solve_problem", careless)
    solution = solver.solve(GOOD["row"][0], None)  # x + y <= 2
    assert not solution.solved
    assert re.fullmatch(r"qpsolvers:daqp: residual \d.\de[+-]\d\d exceeds 1e-05", solution.reason)


def test_a_feasible_point_that_is_not_optimal_is_refused(monkeypatch):
    """A first-order solver that stops early returns one; its torques can be far off."""

    def lazy(stated, _):
        solution = qpsolvers.Solution(stated)
        solution.found, solution.x = True, np.array([0.5, 0.5])
        solution.z, solution.z_box = np.zeros(1), np.zeros(2)
        solution.y = np.empty(0)
        return solution

    solver = make_solver("qpsolvers:daqp")
    monkeypatch.setattr(qpsolvers, "solve_problem", lazy)
    assert not solver.solve(GOOD["row"][0], None).solved


@pytest.mark.parametrize("seed", range(10))
def test_solvers_agree_with_each_other(seed):
    """DAQP, PIQP, OSQP on rows; boxqp and DAQP on a box."""
    stated = random_rows(seed)
    exact = make_solver("qpsolvers:daqp").solve(stated, None)
    assert exact.solved
    for name, tolerance in (("qpsolvers:piqp", 1e-4), ("osqp", 2e-3)):
        other = make_solver(name).solve(stated, None)
        assert other.solved, other.reason
        assert other.x == pytest.approx(exact.x, abs=tolerance)
    box = without_rows(stated.H, stated.f, stated.lower, stated.upper)
    exact = make_solver("qpsolvers:daqp").solve(box, None)
    assert BoxQP().solve(box, None).x == pytest.approx(exact.x, abs=1e-5)


def test_problem_and_violation():
    stated = problem(np.eye(2), [1, -2], [0, 0], [1, 1], [[1, 1]], [-INF], [1.5])
    x = np.array([1.0, 2.0])
    assert stated.objective(x) == pytest.approx(2.5 + 1 - 4)
    assert stated.violation(x) == pytest.approx(1.5)  # the row, 3 against 1.5
    assert stated.violation(np.array([0.5, 1.2])) == pytest.approx(0.2)  # the bound
    assert stated.violation(np.array([-0.4, 0.0])) == pytest.approx(0.4)
    assert stated.violation(np.array([0.5, 0.5])) == 0.0
    assert problem(np.eye(1), [0], [-INF], [INF]).violation(np.array([7.0])) == 0.0


def test_violation_does_not_hide_nan():
    stated = problem(np.eye(2), [1, -2], *FREE)
    assert not stated.violation(np.array([np.nan, 0.0])) <= 1e9
    assert not replace(stated, lower=np.array([np.nan, 0.0])).violation(np.zeros(2)) <= 1e9


@pytest.mark.parametrize("name", NAMES)
def test_recorded_steps(name, world, supported):
    solver = make_solver(f"qpsolvers:{name}")
    for step in supported[::10]:
        _, stack = world.stack(step)
        found = condensed.solve(stack, solver)
        assert found.solution.solved, found.solution.reason
        assert np.abs(found.torque - condensed.solve(stack, BoxQP()).torque).max() < 0.05


@pytest.mark.parametrize("name", ["osqpp", "", "daqp", "BOXQP"])
def test_unknown_solver(name):
    with pytest.raises(InputError) as error:
        make_solver(name)
    assert str(error.value) == (
        f"controller.solver={name!r} is unknown; valid: boxqp, osqp, qpsolvers:<name> "
        "(for example qpsolvers:daqp)"
    )


def test_unknown_to_qpsolvers(monkeypatch):
    monkeypatch.setattr(qpsolvers, "available_solvers", ["piqp", "daqp"])
    with pytest.raises(InputError) as error:
        make_solver("qpsolvers:gurobi")
    assert str(error.value) == (
        "controller.solver: qpsolvers has no solver 'gurobi' here; installed: daqp, piqp"
    )


def test_no_solvers_at_all(monkeypatch):
    monkeypatch.setattr(qpsolvers, "available_solvers", [])
    with pytest.raises(InputError, match="; installed: none$"):
        make_solver("qpsolvers:daqp")


def test_without_qpsolvers(monkeypatch):
    monkeypatch.setitem(sys.modules, "qpsolvers", None)
    with pytest.raises(InputError) as error:
        make_solver("qpsolvers:daqp")
    assert str(error.value) == (
        "controller.solver=qpsolvers:daqp needs the optional package qpsolvers; "
        "install it with: pip install 'rotctl[solvers]'"
    )
