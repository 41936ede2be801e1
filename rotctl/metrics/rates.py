"""Rates and how sure they are."""

from math import sqrt

Z_95 = 1.959963984540054  # two-sided 95 % of the normal distribution


def wilson(succeeded: int, n: int, z: float = Z_95) -> tuple[float, float]:
    """Wilson's score interval of a rate; all of [0, 1] if nothing was tried."""
    if n == 0:
        return 0.0, 1.0
    rate, share = succeeded / n, z * z / n
    middle = (rate + share / 2) / (1 + share)
    half = z / (1 + share) * sqrt(rate * (1 - rate) / n + share / (4 * n))
    return max(0.0, middle - half), min(1.0, middle + half)
