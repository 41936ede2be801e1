"""Least squares within bounds, against scipy's."""

import numpy as np
import pytest
from scipy import optimize

from rotctl.adopting.squares import least_squares


def valley(x):
    """Rosenbrock's, of which the floor is bent, thrice."""
    return np.concatenate([10.0 * (x[1:] - x[:-1] ** 2), 1.0 - x[:-1]])


def reach(x):
    """An arm of four hinges that is to get to where it cannot, and to stay near its middle."""
    turned = np.cumsum(x)
    tip = np.array([np.cos(turned).sum(), np.sin(turned).sum()])
    return np.concatenate([tip - [1.0, 4.5], 0.03 * x])


@pytest.mark.parametrize("missed", [valley, reach])
@pytest.mark.parametrize("most", [1.5, 0.8, 0.4])
def test_the_least_within_bounds_is_that_of_scipy(missed, most):
    low, high = np.full(4, -0.3), np.full(4, most)
    start = np.array([-0.2, 0.3, 0.1, 0.35])
    found = least_squares(missed, start, low, high)
    best = optimize.least_squares(
        missed, start, bounds=(low, high), xtol=1e-15, ftol=1e-15, gtol=1e-15
    ).x
    assert found == pytest.approx(best, abs=1e-5)
    assert (missed(found) ** 2).sum() <= (missed(best) ** 2).sum() + 1e-9
    assert (found >= low).all()
    assert (found <= high).all()


def test_a_start_beyond_the_bounds_begins_at_them():
    found = least_squares(lambda x: x - 3.0, np.full(2, 9.0), np.zeros(2), np.array([2.0, 5.0]))
    assert found == pytest.approx([2.0, 3.0], abs=1e-9)


def test_what_nothing_changes_stays_where_it_began():
    found = least_squares(lambda x: 0.0 * x + 1.0, np.array([0.3]), np.zeros(1), np.ones(1))
    assert found == [0.3]
