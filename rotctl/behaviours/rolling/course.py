"""Where a roll goes: turning at commanded rates, or along a path on the ground.

A path is a list of legs, each of a length and of how far the way turns over it: a straight line or
an arc. One follows the other without a kink, so that whatever is written can be rolled; one leg is
a circle, three are a slalom. Rates have no place on the ground. A path has, and who is beside it
turns back towards it by so many degrees a metre.
"""

from bisect import bisect_right
from math import cos, radians, sin
from typing import Annotated, Literal, NamedTuple

from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.settings.fields import GROWING, STRICT, Finite, NonNegative

TIGHTEST = 1.0  # [m] of an arc's radius: on a tighter one a hand would stay where it is
SHORTEST = 0.1  # [m] of a leg: less is no way, and an hour of it takes long to look up
STRAY = 0.5  # [m] that a round moves it at most: it does not go over to another arm
BESIDE = 0.3  # [-] of an arc's radius that is left at least: its middle has a nearest point, too
ROUNDS = 2  # of Newton's method, from the nearest point of the period before, 3 cm away

Rate = Annotated[Finite, Field(ge=-90, le=90)]
Leg = tuple[Annotated[Finite, Field(ge=SHORTEST)], Annotated[Finite, Field(ge=-3600, le=3600)]]


class Going(NamedTuple):
    """How a roll goes at one instant.

    Attributes:
        x, y: from where the way began, ahead and left by its first heading [m].
        speed: along the way [m/s].
    """

    x: float
    y: float
    speed: float


class Course(NamedTuple):
    """Where the way leads at one instant.

    Attributes:
        turned: the way to roll along, from the first heading, left positive [rad].
        rate: how fast it turns [rad/s].
        along: how far it has come along the way [m].
        place: x, y of the way's nearest point, as in `Going` [m]; None where a way has no place.
    """

    turned: float = 0.0
    rate: float = 0.0
    along: float = 0.0
    place: tuple[float, float] | None = None


@validated(frozen=True, config=STRICT)
class RatesSettings:
    """Turning at commanded rates.

    Attributes:
        schedule: times and rates from then on, left positive [s, deg/s]; straight on before.
    """

    kind: Literal["rates"]
    schedule: Annotated[
        tuple[tuple[NonNegative, Rate], ...], Field(min_length=1, max_length=1000), GROWING
    ]
    name: str = ""

    def make(self) -> "Rates":
        """The course of one run."""
        return Rates(self)


@validated(frozen=True, config=STRICT)
class PathSettings:
    """A path on the ground.

    Attributes:
        legs: lengths, and by how much the way turns over each, left positive [m, deg].
        repeat: whether it begins again after the last leg; otherwise it goes straight on.
        ahead: how long before it is there it turns as the path does [s].
        pull: how far it turns back towards the path for each metre beside it [deg/m].
        most: that it turns towards it [deg].
    """

    kind: Literal["path"]
    legs: Annotated[tuple[Leg, ...], Field(min_length=1, max_length=1000)]
    ahead: Annotated[NonNegative, Field(le=2)]
    pull: Annotated[NonNegative, Field(le=180)]
    most: Annotated[NonNegative, Field(le=90)]
    repeat: Annotated[bool, Strict()] = False
    name: str = ""

    def __post_init__(self) -> None:
        for length, turn in self.legs:
            radius = abs(length / radians(turn)) if turn else TIGHTEST
            if radius < TIGHTEST:
                raise ValueError(
                    f"legs: [{length:g}, {turn:g}] is an arc with a radius of {radius:.2f} m; "
                    f"nothing rolls along one below {TIGHTEST:g} m"
                )

    def make(self) -> "Path":
        """The course of one run."""
        return Path(self)


CourseSettings = Annotated[RatesSettings | PathSettings, Field(discriminator="kind")]


class Rates:
    """Turning at commanded rates, in one run."""

    def __init__(self, settings: RatesSettings) -> None:
        """Prepare the schedule."""
        self._times = [time for time, _ in settings.schedule]
        self._rates = [0.0, *(radians(rate) for _, rate in settings.schedule)]

    def follow(self, before: Course, going: Going, time: float, period: float) -> Course:
        """The course now, a period [s] after it was `before`; `time` is now [s]."""
        rate = self._rates[bisect_right(self._times, time)]
        return Course(before.turned + rate * period, rate, before.along + going.speed * period)


class Point(NamedTuple):
    """A point of a path: x, y [m], direction [rad] and curvature [1/m], left positive."""

    x: float
    y: float
    turned: float
    curvature: float = 0.0

    def on(self, way: float) -> "Point":
        """So far along the arc that begins here [m]."""
        after = self.turned + self.curvature * way
        if abs(after - self.turned) < 1e-9:
            return Point(self.x + way * cos(after), self.y + way * sin(after), after)
        x = self.x + (sin(after) - sin(self.turned)) / self.curvature
        y = self.y + (cos(self.turned) - cos(after)) / self.curvature
        return Point(x, y, after, self.curvature)


class Path:
    """A path on the ground, in one run."""

    def __init__(self, settings: PathSettings) -> None:
        """Lay the legs one behind the other."""
        self._settings = settings
        self._starts, self._points, end, total = [], [], Point(0.0, 0.0, 0.0), 0.0
        for length, turn in settings.legs:
            self._starts.append(total)
            self._points.append(end._replace(curvature=radians(turn) / length))
            total, end = total + length, self._points[-1].on(length)
        self._total, self._end = total, end._replace(curvature=0.0)

    def at(self, along: float) -> Point:
        """The point at a way along the path [m]; before its beginning it is straight."""
        if along <= 0.0:
            return Point(along, 0.0, 0.0)
        end, first = self._end, Point(0.0, 0.0, 0.0)
        if along >= self._total and not self._settings.repeat:
            return end.on(along - self._total)
        while along >= self._total:
            along -= self._total
            first = _behind(first, end)
        leg = bisect_right(self._starts, along) - 1
        return _behind(first, self._points[leg].on(along - self._starts[leg]))

    def nearest(self, along: float, x: float, y: float) -> float:
        """How far along the path its point nearest to x, y [m] is, which was at `along` [m]."""
        for _ in range(ROUNDS):
            point = self.at(along)
            (ahead, beside), bend = _beside(point, x, y), point.curvature
            step = ahead / max(1.0 - bend * beside, BESIDE)
            along += min(max(step, -STRAY), STRAY)
        return along

    def follow(self, before: Course, going: Going, time: float, period: float) -> Course:
        """The course now, a period after it was `before`."""
        s = self._settings
        along = self.nearest(before.along, going.x, going.y)
        here, there = self.at(along), self.at(along + s.ahead * going.speed)
        back = s.pull * _beside(here, going.x, going.y)[1]
        turned = there.turned - radians(min(max(back, -s.most), s.most))
        return Course(turned, going.speed * there.curvature, along, (here.x, here.y))


def _beside(point: Point, x: float, y: float) -> tuple[float, float]:
    """How far x, y is ahead of a point along its direction, and left of it [m]."""
    dx, dy, c, s = x - point.x, y - point.y, cos(point.turned), sin(point.turned)
    return c * dx + s * dy, c * dy - s * dx


def _behind(first: Point, point: Point) -> Point:
    """A point of a path that does not begin at the origin, but at `first`."""
    c, s = cos(first.turned), sin(first.turned)
    x, y = first.x + c * point.x - s * point.y, first.y + s * point.x + c * point.y
    return Point(x, y, first.turned + point.turned, point.curvature)
