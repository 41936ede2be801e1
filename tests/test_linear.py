"""Linear algebra without BLAS, against numpy's; and that what makes a run has no other."""

import ast
from pathlib import Path

import numpy as np
import pytest

import rotctl
from rotctl.maths.linear import NotPositiveDefiniteError, product, solve

RNG = np.random.default_rng(5)
PACKAGE = Path(rotctl.__file__).parent
# Of no run: they draw, count, search, export, import. A clip once imported is the same everywhere.
NO_PART_OF_A_RUN = {"bench", "export", "report", "results", "sweep", "tune"}
OF_A_RUN_IN_MOTION = {"__init__", "clip", "pose_pair", "reference", "untrusted"}
BLAS = {
    *("linalg", "dot", "vdot", "inner", "matmul", "tensordot", "vecdot", "matvec", "vecmat"),
    *("polyfit", "convolve", "correlate", "cov", "corrcoef", "matrix_power", "einsum_path"),
}
# numpy has these in several versions for several processors, which differ in the last bit; its sin
# and cos are the C library's, as all of Python's math is.
SEVERAL = {
    *("arcsin", "arccos", "arctan", "arctan2", "tan", "sinh", "cosh", "tanh", "exp", "exp2"),
    *("expm1", "log", "log2", "log10", "log1p", "power", "float_power", "cbrt"),
}
RUN_ONLY = [
    path
    for path in sorted(PACKAGE.rglob("*.py"))
    if path.relative_to(PACKAGE).parts[0] not in NO_PART_OF_A_RUN
    and (path.parent.name != "motion" or path.stem in OF_A_RUN_IN_MOTION)
]


@pytest.mark.parametrize(
    ("left", "right"), [((3,), (3,)), ((3,), (3, 5)), ((4, 3), (3,)), ((4, 3), (3, 5))]
)
def test_products_are_those_of_numpy(left, right):
    a, b = RNG.normal(size=left), RNG.normal(size=right)
    np.testing.assert_allclose(product(a, b), a @ b, rtol=1e-13, atol=1e-14)


def test_a_product_of_several_goes_from_left_to_right():
    a, b, c = RNG.normal(size=(2, 3)), RNG.normal(size=(3, 4)), RNG.normal(size=4)
    np.testing.assert_array_equal(product(a, b, c), product(product(a, b), c))
    np.testing.assert_allclose(product(a, b, c), a @ b @ c, rtol=1e-13, atol=1e-14)


def test_a_product_over_nothing_is_zero():
    np.testing.assert_array_equal(product(np.zeros((2, 0)), np.zeros((0, 3))), np.zeros((2, 3)))


@pytest.mark.parametrize("right", [(6,), (6, 1), (6, 4)])
def test_what_solves_an_equation(right):
    root = RNG.normal(size=(6, 9))
    matrix, wanted = root @ root.T, RNG.normal(size=right)
    given, kept = matrix.copy(), (matrix @ wanted).copy()
    found = solve(matrix, kept)
    assert found.shape == right
    np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-10)
    np.testing.assert_array_equal(matrix, given)
    np.testing.assert_array_equal(kept, given @ wanted)


@pytest.mark.parametrize("matrix", [np.zeros((2, 2)), -np.eye(2), np.full((2, 2), np.nan)])
def test_what_is_not_positive_definite_is_said_to_be_so(matrix):
    with pytest.raises(NotPositiveDefiniteError, match=r"^matrix has rank [01] of 2$"):
        solve(matrix, np.ones(2))


@pytest.mark.parametrize("path", RUN_ONLY, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_nothing_between_start_and_log_hangs_on_the_processor(path):
    found = [
        f"line {node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if hangs_on_processor(node)
    ]
    assert not found, "use rotctl.maths.linear or math, whose bits no processor changes"


def hangs_on_processor(node):
    match node:
        case ast.BinOp(op=ast.MatMult()) | ast.AugAssign(op=ast.MatMult()):
            return True
        case ast.Attribute(value=ast.Name("np" | "numpy" | "scipy"), attr=name):
            return name in BLAS | SEVERAL
        case ast.Call(func=ast.Attribute(attr="dot")):
            return True
        case ast.ImportFrom(module=module, names=names) if module:
            parts = {*module.split("."), *(alias.name for alias in names)}
            return module.split(".")[0] in {"numpy", "scipy"} and bool(parts & (BLAS | SEVERAL))
        case ast.Call(keywords=keywords):
            return any(keyword.arg == "optimize" for keyword in keywords)
    return False


@pytest.mark.parametrize(
    "line",
    [
        *("a @ b", "a @= b", "np.dot(a, b)", "a.dot(b)", "np.linalg.solve(a, b)", "np.inner(a, b)"),
        *("from numpy.linalg import solve", "from numpy import dot", "from scipy import linalg"),
        *("np.einsum('ij,jk', a, b, optimize=True)", "np.arctan2(y, x)"),
    ],
)
def test_that_search_finds(line):
    assert any(hangs_on_processor(node) for node in ast.walk(ast.parse(line)))


def test_that_search_looks_into_what_makes_a_run():
    looked = {str(path.relative_to(PACKAGE)) for path in RUN_ONLY}
    modules = ("maths/rotations", "control/condensed", "simulation/lockstep", "adopting/meshes")
    for module in (*modules, "metrics/criteria/rolling"):
        assert f"{module}.py" in looked
