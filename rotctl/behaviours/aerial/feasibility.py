"""What no launch can give is refused before anything is simulated, with the reason.

Time in the air follows from ballistics, the least angular momentum for a turn in that time from
the tightest shape; how much a push gives at all was measured and stands with the launch.
"""

from collections.abc import Mapping
from math import copysign, degrees, pi, radians, tau

from rotctl.behaviours.aerial.flight import Flight
from rotctl.behaviours.aerial.launch import Launch, Whirl
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model

GONE = radians(60.0)  # already turned at take-off: as far as the strongest launches here
KEY = "behaviour.target_excursion"
SPEED = "behaviour.take_off"
FASTER = tuple(tenths / 10.0 for tenths in range(1, 60))  # [m/s] the first that would do is told


def check(
    model: Model,
    axes: Array,
    target: float,
    aims: Mapping[str, object],
    laws: Mapping[str, object],
    take_off: float | None = None,
) -> None:
    """Look at a stage's launch, if it has one, and at the flight that it is for.

    Args:
        axes: (3, 3) rows are forward, left and up.
        target: to turn [rad].
        aims: of the stage's tasks; laws: of the behaviour's poses, by the name of the stage.

    Raises:
        InputError: a launch does not give the turn; the line says what would do.
    """
    for whirl in aims.values():
        if isinstance(whirl, Whirl):
            launch, flight = whirl.parts(aims, laws)
            _check_way(launch, flight, target)
            _check_turn(flight, target)
            _check_speed(launch, take_off)
            _check_momentum(model, axes, target, launch, whirl, flight, take_off)


def _check_way(launch: Launch, flight: Flight, target: float) -> None:
    """Raises InputError for a somersault against the way that it takes off.

    From a platform such a turn has the time and the room (a reverse dive); back onto the feet that
    took off it has not.
    """
    elsewhere = flight.landing.bodies != launch.bodies
    if elsewhere or launch.forward * target > 0.0 or not launch.forward:
        return
    way = "forward" if launch.forward > 0.0 else "backward"
    turn = copysign(degrees(abs(target)) or 360.0, launch.forward)
    raise InputError(
        f"{KEY}={degrees(target):g}: this take-off goes {way} and can only turn {way}; "
        f"give {turn:g}"
    )


def _check_turn(flight: Flight, target: float) -> None:
    """Raises InputError for a turn after which other parts come down first."""
    if not flight.landing.lands():
        near = [degrees(angle) for angle in (target - pi, target + pi)]
        turns = " or ".join(f"{angle:.0f}" for angle in sorted(near, key=abs) if abs(angle) > 1.0)
        raise InputError(
            f"{KEY}={degrees(target):g}: it would not come down on its "
            f"{' or '.join(flight.landing.bodies)}; half a turn less or more: {turns}"
        )


def _check_speed(launch: Launch, take_off: float | None) -> None:
    """Raises InputError for a speed that legs do not give."""
    if take_off and not launch.most:
        raise InputError(f"{SPEED}={take_off:g}: this launch has its own speed alone")
    if take_off and take_off > launch.most:
        raise InputError(
            f"{SPEED}={take_off:g}: legs give no more than at {launch.most:g} m/s; "
            "give that or less"
        )


def _check_momentum(
    model: Model,
    axes: Array,
    target: float,
    launch: Launch,
    whirl: Whirl,
    flight: Flight,
    take_off: float | None,
) -> None:
    """Raises InputError for more angular momentum than the push gives."""
    time = _time(model, axes, launch, flight, launch.up)
    turns = [abs(target)]  # and fewer, till one is possible
    while turns[-1] > 0.0 and flight.least_momentum(turns[-1], GONE, time) > whirl.most:
        turns.append(turns[-1] - tau)
    if len(turns) == 1:
        return
    fewer = f"{degrees(copysign(turns[-1], target)):g} is possible" if turns[-1] > 0.0 else ""
    if take_off and not fewer:
        for speed in (speed for speed in FASTER if speed <= launch.most):
            longer = _time(model, axes, launch, flight, launch.up * speed / take_off)
            if flight.least_momentum(turns[0], GONE, longer) <= whirl.most:
                fewer = f"with {SPEED}={speed:g} it is possible"
                break
    raise InputError(
        f"{KEY}={degrees(target):g}: to turn so far in {time:.2f} s asks for "
        f"{flight.least_momentum(turns[0], GONE, time):.0f} kg m2/s in the tightest shape, and "
        f"the push gives at most {whirl.most:g}; {fewer or 'no turn is possible'} here"
    )


def _time(model: Model, axes: Array, launch: Launch, flight: Flight, up: float) -> float:
    """In the air, taking off upward at a speed [m/s], until it lands as usual [s]."""
    back = 2.0 * abs(up) / -float(model.gravity[2])  # [s] till it is as high as at take-off
    x, y, _ = (back * launch.forward * axes[0]).tolist()
    return flight.landing.usual_time(up, launch.height - model.ground.height(x, y))
