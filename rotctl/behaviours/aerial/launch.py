"""From standing into the air: lean, and a push that gives height, way and angular momentum at once.

The launch knows what it is for. Of the flight that follows it takes the time in the air, from
ballistics, and asks for the momentum with which an average tuck turns as far as is wanted in that
time: neither too little nor too much, [AlBorno2014]. Velocity and angular momentum are then to be
there together, when the centre of mass has risen to where the legs end.
"""

from collections.abc import Mapping
from math import copysign
from typing import Literal

from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.flight import Flight
from rotctl.behaviours.aerial.pendulum import captured, pushed, standing
from rotctl.behaviours.named_bodies import NamesBodies, NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.maths.linear import solve
from rotctl.maths.rotations import dot
from rotctl.settings.fields import STRICT, Finite, Fraction, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class Lean(NamesBodies):
    """Go down, then fall slowly to one side, pressure inside the feet all the while: linear.

    Along the way the centre of mass gets its speed, as far as pressure within the feet can give
    it; across it the capture point is kept over them.

    Attributes:
        bodies: that stand.
        margin: inside the support that the pressure keeps [m].
        speed: to forward, backward where it is negative [m/s]; 0 keeps its place.
        eager: how fast a speed is taken up [1/s].
        gain: of the pressure beyond the capture point [-].
        height: of the centre of mass over the ground [m]; sink: it comes there at [m/s], and
            steady: in the end slower, by its distance [1/s].
        ahead: of the middle of the feet, where it keeps to [m].
    """

    law: Literal["lean"]
    bodies: SomeNames
    margin: NonNegative
    speed: Finite
    eager: Positive
    gain: NonNegative
    height: Positive
    sink: Positive
    steady: Positive
    ahead: Finite = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration."""
        (ahead, left, _), momentum = scene.axes, scene.state.momentum
        base = standing(scene, self.bodies)
        if self.speed:
            more = self.eager * (self.speed - dot(momentum.com_velocity, ahead))
            along = pushed(scene, base, ahead, more, self.margin)
        else:
            along = captured(scene, base, ahead, self.gain, self.margin, self.ahead)
        across = captured(scene, base, left, self.gain, self.margin)
        task["acceleration"] = along * ahead + across * left
        above = float(momentum.com[2]) - scene.floor - self.height
        down = min(max(self.steady * above, -self.sink), self.sink)
        fall = float(momentum.com_velocity[2])
        task["acceleration"][2] = -self.eager * (down + fall)


@validated(frozen=True, config=STRICT)
class Launch(NamesBodies):
    """The velocity at take-off is there when the height is: linear.

    Attributes:
        bodies: that push.
        gain, margin: as for `lean`, across the way.
        forward, up: velocity at take-off [m/s]; hands are left on the way down.
        height: of the centre of mass over the ground there [m].
        soonest: the time that is left counts as so much at least [s].
        most: take-off that may be commanded, as measured: beyond it legs give no more speed, and
            less else [m/s]; 0 sets no limit.
    """

    law: Literal["launch"]
    bodies: SomeNames
    gain: NonNegative
    margin: NonNegative
    forward: Finite
    up: Finite
    height: Positive
    soonest: Positive
    most: NonNegative = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration."""
        ahead, left, _ = scene.axes
        time = self.left(scene)
        velocity = scene.state.momentum.com_velocity
        missing = self.forward * ahead - velocity
        missing[2] = self.up - float(velocity[2])
        across = captured(scene, standing(scene, self.bodies), left, self.gain, self.margin)
        wanted = missing / time
        task["acceleration"] = wanted + (across - dot(wanted, left)) * left

    def left(self, scene: Scene) -> float:
        """Time to take-off [s], at the mean of the speed now and that at take-off."""
        way = max(scene.floor + self.height - float(scene.state.momentum.com[2]), 0.0)
        speed = max(float(scene.state.momentum.com_velocity[2]) + self.up, 0.5)
        return max(2.0 * way / speed, self.soonest)


@validated(frozen=True, config=STRICT)
class Whirl(NamesNothing):
    """Angular momentum at take-off, as much as the flight needs at an average tuck: spin.

    Attributes:
        task: whose aim is `launch`.
        flight: name of the stage that flies.
        amount: of the tuck that is planned with [-]: room is left to either side.
        calm: angular momentum across the way fades at this rate [1/s].
        most: that the push gives [kg m2/s], as measured: what needs more is refused.
        least: it is so much, where less would do [kg m2/s]: what a launch gives across the way by
            mistake is then a small part of it, and the body flies longer than planned.
        ceiling: no more is asked for, whatever the flight needs [kg m2/s]; 0 sets none.
    """

    law: Literal["whirl"]
    task: str
    flight: str
    amount: Fraction
    calm: NonNegative
    most: Positive
    least: NonNegative = 0.0
    ceiling: NonNegative = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the acceleration."""
        momentum, about = scene.state.momentum, scene.turning
        launch, _ = self.parts(scene.aims, scene.laws)
        along = dot(momentum.angular, about)
        rate = -self.calm * (momentum.angular - along * about)
        rate += (self.wanted(scene) - along) / launch.left(scene) * about
        task["acceleration"] = solve(momentum.inertia, rate)

    def wanted(self, scene: Scene) -> float:
        """Angular momentum at take-off about the axis [kg m2/s]."""
        launch, flight = self.parts(scene.aims, scene.laws)
        wanted = flight.planned(scene, self.amount, launch.forward, launch.up, launch.height)
        wanted = copysign(max(abs(wanted), self.least), scene.target)
        return min(max(wanted, -self.ceiling), self.ceiling) if self.ceiling else wanted

    def enough(self, scene: Scene) -> bool:
        """Whether it has that already."""
        wanted = self.wanted(scene)
        return dot(scene.state.momentum.angular, scene.turning) * copysign(1.0, wanted) >= abs(
            wanted
        )

    def parts(
        self, aims: Mapping[str, object], laws: Mapping[str, object]
    ) -> tuple[Launch, Flight]:
        """The launch that it belongs to, and the flight that it is for.

        Args:
            aims: of the stage's tasks; laws: of the behaviour's poses, by the name of the stage.
        """
        launch, flight = aims[self.task], laws[self.flight]
        assert isinstance(launch, Launch)
        assert isinstance(flight, Flight)  # see `staged.named_tasks`
        return launch, flight
