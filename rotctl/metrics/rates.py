"""Rates and how sure they are."""

from math import sqrt

Z_95 = 1.959963984540054  # two-sided 95 % of the normal distribution


def wilson(succeeded: int, n: int, distinct: int | None = None) -> tuple[float, float]:
    """Wilson's score interval of a rate; all of [0, 1] if nothing was tried.

    Args:
        distinct: how many of the n are different: a run that is another one to the bit tells
            nothing more, so that the interval is that of the rate over as many; None: all.
    """
    if n == 0:
        return 0.0, 1.0
    z, apart = Z_95, distinct or n
    rate, share = succeeded / n, z * z / apart
    middle = (rate + share / 2) / (1 + share)
    half = z / (1 + share) * sqrt(rate * (1 - rate) / apart + share / (4 * apart))
    low = middle - half if succeeded else 0.0  # and not what rounding leaves of it
    return low, middle + half if succeeded < n else 1.0
