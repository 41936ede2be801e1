"""A roll that keeps a commanded pace: it flows by itself, and waits over its feet until it is time.

A body that rolls is slow over its feet and quick over its back, whatever it is commanded, and at
half its own pace it does not get up from the seat. So the commanded velocities here swing over the
phase as the motion's own do, and a clock that runs on at the commanded pace says what there is to
wait for or to make good in the squat.
"""

from bisect import bisect_right
from math import cos, floor, inf, pi, sqrt, tau
from typing import NamedTuple

from rotctl.behaviours.rolling.pace_settings import SLIP, PaceSettings
from rotctl.errors import InputError

SWING = 1 / 18  # [-] of the way in a revolution: amplitude of the height of the centre of mass


class Clock(NamedTuple):
    """Where a roll should be.

    Attributes:
        due: how far it should have come [rev].
        late: how much of it is missing [rev].
    """

    due: float
    late: float = 0.0


class Wanted(NamedTuple):
    """What a pace asks for at one instant.

    Attributes:
        rate: angular velocity [rev/s].
        speed: [m/s].
        brake: on the dampers along the way [-].
        back: how far the poses stay behind [rev].
        waits: how far the poses have come to that of one who waits [-].
    """

    rate: float
    speed: float
    brake: float
    back: float
    waits: float


class Pace:
    """The pace of one run.

    Attributes:
        times: at which what is commanded changes [s].
        rates: as an angular velocity, before the first of them and from each on [rev/s].
    """

    def __init__(self, settings: PaceSettings, rate: float, speed: float) -> None:
        """For a commanded angular velocity [rev/s] and speed [m/s]."""
        self.settings = s = settings
        per = 1.0 if s.keep == "rate" else s.travel
        self.times = [time for time, _ in s.schedule]
        first = rate if s.keep == "rate" else speed
        self.rates = [each / per for each in (first, *(value for _, value in s.schedule))]

    def check(self, gravity: float) -> None:
        """Look at all that is commanded.

        The height of the centre of mass swings by `amplitude` once in a revolution. Down from the
        top of it takes an acceleration of amplitude (2 pi rate)2, and gravity [m/s2] gives no more.

        Raises:
            InputError: a roll so quick leaves the ground.
        """
        s = self.settings
        amplitude = SWING * s.travel
        most = sqrt(gravity / amplitude) / tau if gravity > 0.0 else inf
        quick = max(self.rates)
        if quick <= most:
            return
        per, unit = (1.0, "rev/s") if s.keep == "rate" else (s.travel, "m/s")
        first = "behaviour.angular_velocity" if s.keep == "rate" else "behaviour.speed"
        key = first if quick == self.rates[0] else "behaviour.pace.schedule"
        raise InputError(
            f"{key}: {quick * per:g} {unit} cannot be rolled: a centre of mass that comes down "
            f"{2.0 * amplitude:.2g} m in half a revolution falls too slowly; "
            f"give at most {floor(100.0 * most * per) / 100.0:g}"
        )

    def commanded(self, time: float) -> float:
        """What is commanded at a time [s], as an angular velocity [rev/s]."""
        return self.rates[bisect_right(self.times, time)]

    def tick(self, clock: Clock, come: float, time: float, period: float) -> Clock:
        """The clock now, a period after it was `clock`.

        Args:
            come: how far the roll has come [rev].
            time: now [s].
            period: [s].
        """
        asked = self.commanded(time)
        if not asked:  # a halt: it goes on from where it is then
            return Clock(come)
        late = clock.due + asked * period - come
        late = min(max(late, -self.settings.patience), SLIP)
        return Clock(come + late, late)

    def before(self, phase: float) -> float:
        """How far a phase [rad] is before the one in which it waits, at most half [rev]."""
        return (self.settings.wait - phase / tau + 0.5) % 1.0 - 0.5

    def at(
        self,
        phase: float,
        ahead: float,
        late: float,
        time: float,
        goes: float = 0.0,
        turns: float = inf,
    ) -> Wanted:
        """What to ask for.

        Args:
            phase: [rad].
            ahead: of the bodies it waits over, where the centre of mass is [m].
            late: see `Clock` [rev].
            time: [s].
            goes: how fast it goes along the way [m/s].
            turns: how fast it turns [rev/s].
        """
        s = self.settings
        turn = phase / tau
        before = self.before(phase)
        here = _near(before, s.width)
        asked = self.commanded(time)
        share = min(max(1.0 + s.gain * late, 0.0), s.most) if asked else 0.0
        early = max(1.0 - share, 0.0)
        flow = max(s.own, asked) * (1.0 - s.calm * early)
        base = flow * (1.0 + (max(share, 1.0) - 1.0) * here)
        rate = base * (1.0 - s.swing * cos(tau * (turn - s.swing_from)))
        speed = s.travel * base * (1.0 - s.surge * cos(tau * (turn - s.surge_from)))
        slow = min(max(1.0 - turns / flow, 0.0), 1.0)
        reach = (s.approach if before > 0.0 else s.leave) or s.width
        waits = early * _near(before, reach)
        return Wanted(
            rate + waits * (s.settling[0] * before - rate),
            speed + waits * (s.settling[1] * (s.ahead - ahead) - speed),
            1.0 + waits * (self._brake(asked, goes) - 1.0),
            waits * s.back,
            max(
                early * _near(before, s.width if before > 0.0 else reach),
                slow * _near(before, s.approach or s.width),
            ),
        )

    def _brake(self, asked: float, goes: float) -> float:
        """How much stiffer it waits, told a rate [rev/s] and as fast as it goes [m/s]."""
        s = self.settings
        if asked or s.easing is None:
            return s.brake
        return 1.0 + (s.brake - 1.0) * min(abs(goes) / s.easing, 1.0)


def _near(before: float, width: float) -> float:
    """1 in the phase that it is `before`, 0 from `width` to either side on, and smooth between."""
    return 0.5 + 0.5 * cos(pi * before / width) if abs(before) < width else 0.0
