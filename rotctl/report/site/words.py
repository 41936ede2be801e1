"""Numbers and names as the report writes them."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from rotctl.metrics import appearance, pace
from rotctl.metrics.claims import Claim, Judged
from rotctl.metrics.criteria.kinds import COLUMNS
from rotctl.metrics.measured import SUCCESS_RATE, Measured
from rotctl.report.title import plain

QUANTITIES = {
    SUCCESS_RATE: ("Success rate", "%"),
    "revolutions": ("Revolutions", "rev"),
    "angular_velocity_mean": ("In-plane angular velocity", "rev/s"),
    "speed_mean": ("Speed", "m/s"),
    "heading_error_end": ("Heading error at the end", "deg"),
    "lateral_drift": ("Sideways drift", "m"),
    "longest_stall": ("Longest stall", "s"),
    "duration": ("Simulated time", "s"),
    "torque_p99_fraction": ("Torque, 99th percentile of its limit", ""),
    "real_time_factor": ("Real-time factor", ""),
    **{c.name: (c.title, c.unit) for kind in (appearance, pace) for c in kind.COLUMNS},
}
OFTEN = tuple(QUANTITIES)  # these before others
QUANTITIES |= {c.name: (c.title, c.unit) for c in COLUMNS.values() if c.name not in QUANTITIES}
QUANTITIES["solver_failures"] = ("Solver failures", "steps")
NOTHING = "\u2013"
LONGEST = 80  # letters of a kind of failure
_ANY = "\u2026"  # for a number
_PART = re.compile(r"part \d+ of \d+, \w+(: |, )")  # of a chain
_NUMBER = re.compile(r"(?<!\w)[-\u2212]?\d+(\.\d+)?(?!\w)")
_TIME = re.compile(r",? (from|at) t = .*")


def quantity(metric: str) -> str:
    """What a metric is called."""
    return QUANTITIES.get(metric, (plain(metric), ""))[0]


def claimed(claim: Claim) -> str:
    """What a claim is about: a quantity, and which quantile of it where that is not the median."""
    share = "" if claim.quantile == 0.5 else f", {100 * claim.quantile:g} % quantile"
    return quantity(claim.metric) + share


def number(value: float | None, metric: str = "") -> str:
    """A number to three digits, at most three decimals, without its unit; rates in percent."""
    if value is None or value != value:
        return NOTHING
    if metric == SUCCESS_RATE:
        return f"{100 * value:.0f}"
    small = abs(value) < 1000 or abs(value) > 1e9
    text = f"{round(value, 3) + 0.0:.3g}" if small else f"{value:.0f}"  # no -0
    return text.replace("-", "\u2212")


def with_unit(text: str, metric: str) -> str:
    """The text followed by the unit of a metric."""
    unit = QUANTITIES.get(metric, ("", ""))[1]
    return f"{text} {unit}" if unit and text != NOTHING else text


def spread(found: Measured, metric: str) -> str:
    """`value [low, high]` without a unit."""
    if found.value is None:
        return NOTHING
    middle, low, high = (number(v, metric) for v in (found.value, found.low, found.high))
    return middle if low == middle == high else f"{middle} [{low}, {high}]"


def outcome(judged: Judged) -> str:
    """What a claim's runs had: a rate with its interval, a median with its quartiles.

    Of another quantile these are beside it, as it need not lie between them.
    """
    claim, found = judged.claim, judged.measured
    alike = found.value == found.low == found.high
    if claim.quantile == 0.5 or alike:
        return with_unit(spread(found, claim.metric), claim.metric)
    value, low, high = (number(v, claim.metric) for v in (found.value, found.low, found.high))
    return f"{with_unit(value, claim.metric)}, quartiles {low} and {high}"


def expectation(claim: Claim) -> str:
    """What a claim expects, such as `at least 95 %` or `1.3 ± 0.2 rev/s`."""
    wanted, tolerance = (number(v, claim.metric) for v in (claim.expected, claim.tolerance))
    if claim.comparison == "near":
        return with_unit(f"{wanted} \u00b1 {tolerance}", claim.metric)
    slack = f" \u2212 {tolerance}" if claim.comparison == "at_least" else f" + {tolerance}"
    words = f"{claim.comparison.replace('_', ' ')} {wanted}{slack if claim.tolerance else ''}"
    return with_unit(words, claim.metric)


def values(where: Mapping[str, Any]) -> str:
    """What tells runs from others, in a few words: `incline`, `incline, start rest`."""
    named = [plain(v) if k == "behaviour" else plain(f"{k} {v}") for k, v in where.items()]
    return ", ".join(named) or "all runs"


def kind(reason: str) -> str:
    """A failure's reason without its numbers: `leans by 25 deg at the end` with an ellipsis for 25.

    Of a time only what happens then is left, and of a chain which of its parts it is about.
    """
    said = plain(reason)
    part = _PART.match(said)
    named = part[0] if part else ""
    words = _NUMBER.sub(_ANY, _TIME.sub("", re.split(r"[:(]", said[len(named) :])[0])).split()
    text = f"{named}{' '.join(words)}".rstrip(" ,:") or "no reason given"
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + _ANY


def ranges(numbers: Iterable[int]) -> str:
    """Whole numbers in a few words: `0-4, 7`."""
    found: list[list[int]] = []
    for n in sorted(set(numbers)):
        if found and n == found[-1][1] + 1:
            found[-1][1] = n
        else:
            found.append([n, n])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in found)


class Names:
    """File names that any web server takes, each given once."""

    def __init__(self) -> None:
        self._given: set[str] = set()

    def give(self, text: str) -> str:
        """A name that resembles the text."""
        base = re.sub(r"[^a-z0-9_]+", "-", text.lower()).strip("-")[:60] or "x"
        name, again = base, 1
        while name in self._given:
            again += 1
            name = f"{base}-{again}"
        self._given.add(name)
        return name
