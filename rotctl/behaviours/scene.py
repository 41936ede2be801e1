"""What aims and conditions of a stage look at."""

from collections.abc import Mapping
from typing import NamedTuple

from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.excursion import Excursion, ExcursionName
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State


class Begin(NamedTuple):
    """How a stage began.

    Attributes:
        time: [s].
        com: (3,) centre of mass [m].
        place, orientation: (nbody, 3) [m] and (nbody, 4) of all bodies.
        angles: (nu,) of the joints [rad].
        excursion: AE and phase.
    """

    time: float
    com: Array
    place: Array
    orientation: Array
    angles: Array
    excursion: Excursion


class Step(NamedTuple):
    """A step with a foot, or none where both stand; see `rotctl.behaviours.standing.stepping`.

    Attributes:
        swing, stance: MuJoCo ids of the feet; 0 where none swings.
        begin: of the swing [s].
    """

    swing: int = 0
    stance: int = 0
    begin: float = 0.0


class Scene(NamedTuple):
    """One instant of a staged behaviour.

    Attributes:
        state: that the controller sees.
        axes: (3, 3) rows are the behaviour's forward, left and up, world.
        turning: (3,) the one of them that the behaviour turns about.
        excursion: AE and phase now, measured by `measure`.
        begin: of the stage.
        first: AE and phase at the start of the run.
        aims: of the stage's tasks, by the name of the task.
        laws: of the behaviour's poses, by the name of the stage.
        pose: (nu,) that the stage has [rad]; speed: (nu,) at which it moves [rad/s].
        target: in-plane excursion that the behaviour is to reach since its start [rad].
        turned: in-plane excursion since its start [rad].
        airborne: how long nothing has touched the ground [s].
        still: how long nothing has moved faster than `SLOW` [s].
        step: with a foot.
    """

    model: Model
    state: State
    axes: Array
    turning: Array
    excursion: Excursion
    measure: ExcursionName
    begin: Begin
    first: Excursion
    aims: Mapping[str, object]
    laws: Mapping[str, object]
    pose: Array
    speed: Array
    target: float
    turned: float
    airborne: float
    still: float
    step: Step

    @property
    def floor(self) -> float:
        """Height of the ground that it stands on [m].

        Without contacts of that below it, or below where it was lowest as the stage began, if
        that is higher: a foot that loses an edge for a step is not yet over the abyss.
        """
        ground = self.model.ground
        found = [ground.height(x, y) for x, y, _ in self.state.contacts.position.tolist()]
        if found:
            return max(found)
        x, y, _ = self.state.momentum.com.tolist()
        own = self.begin.place[is_character(self.model.mj)].tolist()  # a loose box may lie lower
        first_x, first_y, _ = min(own, key=lambda place: place[2])
        return max(ground.height(x, y), ground.height(first_x, first_y))
