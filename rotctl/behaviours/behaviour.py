"""What the simulation asks of a behaviour."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeVar

from rotctl.control import Command, ControllerSettings
from rotctl.control.settings import ContactGains, PoseGains, TaskGains
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.state import State

Memory = TypeVar("Memory")


@dataclass(frozen=True)
class Placement:
    """How a character is put on the ground.

    Attributes:
        orientation: (4,) of the root, unit quaternion.
        pose: (nu,) joint angles [rad], unless the start has its own.
    """

    orientation: Array
    pose: Array


class Signals(NamedTuple):
    """What the log keeps of a behaviour at one instant.

    Attributes:
        angle: (3,) angular excursion [rad], world.
        phase: by which poses are looked up [rad].
        axis: (3,) the trunk's axis that should stay on the behaviour's, unit, world.
        axes: (3, 3) rows are the behaviour's forward, left and up, world.
        stage: number of the stage.
    """

    angle: Array
    phase: float
    axis: Array
    axes: Array
    stage: int = 0


class Behaviour(Protocol[Memory]):
    """A class of motion in one run; its memory is passed from step to step, never kept."""

    @property
    def tasks(self) -> tuple[str, ...]:
        """Names of the tasks that its commands hold, in their order."""
        ...

    @property
    def axes(self) -> Array:
        """(3, 3) rows are forward, left and up, world; a start's velocities are along them."""
        ...

    def start(self, pitch: float) -> Placement:
        """How a run starts; `pitch` is what was drawn [rad]."""
        ...

    def begin(self, pitch: float, state: State) -> Memory:
        """Memory before the first step."""
        ...

    def advance(self, before: Memory, state: State) -> Memory:
        """Memory now, from that of the previous control step."""
        ...

    def command(self, memory: Memory, state: State) -> Command:
        """Wishes at this instant."""
        ...

    def signals(self, memory: Memory, state: State) -> Signals:
        """For the log."""
        ...


def gains_of(control: ControllerSettings, tasks: tuple[str, ...]) -> dict[str, TaskGains]:
    """The gains of a behaviour's tasks.

    Raises:
        InputError: the controller has none for one of them.
    """
    for name in tasks:
        if name not in control.tasks:
            raise InputError(
                f"controller={control.name} has no gains for the task {name!r}; "
                f"it has: {', '.join(control.tasks) or 'none'}"
            )
    return {name: control.tasks[name] for name in tasks}


def pose_gains_of(control: ControllerSettings, name: str) -> PoseGains:
    """The controller's pose gains of that name; its usual ones, if empty.

    Raises:
        InputError: it has none of that name.
    """
    if name and name not in control.poses:
        raise InputError(
            f"controller={control.name} has no pose gains {name!r}; "
            f"it has: {', '.join(control.poses) or 'none'}"
        )
    return control.poses[name] if name else control.pose


def contact_gains_of(control: ControllerSettings, name: str) -> ContactGains:
    """The controller's gains of contacts of that name; its usual ones, if empty.

    Raises:
        InputError: it has none of that name.
    """
    if name and name not in control.contacts:
        raise InputError(
            f"controller={control.name} has no gains of contacts {name!r}; "
            f"it has: {', '.join(control.contacts) or 'none'}"
        )
    return control.contacts[name] if name else control.contact
