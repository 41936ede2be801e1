"""The controller's numbers: gains and weights by objective, supervisor thresholds."""

from dataclasses import field
from typing import Annotated, Literal

from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.control.supervisor import SupervisorName, Thresholds
from rotctl.mechanics.merging import Merging
from rotctl.settings.fields import STRICT, NonNegative, NonNegativeVector, Positive

FormName = Literal["condensed", "literal"]
BackendName = Literal["compiled", "reference"]
TrackedBy = Literal["force", "acceleration"]


@validated(frozen=True, config=STRICT)
class TaskGains:
    """How a task is pursued, each along its three axes.

    Attributes:
        weight: on the squared error of its rows; see its kind in `rotctl.control.kinds` for
            the unit. An axis of weight 0 is left out.
        stiffness: [1/s2].
        damping: [1/s].
    """

    weight: NonNegativeVector
    stiffness: NonNegativeVector
    damping: NonNegativeVector


@validated(frozen=True, config=STRICT)
class PoseGains:
    """How the poses are tracked, [Brown2013] eq. 6 and 7.

    Attributes:
        stiffness: K_s [1/s2]; damping: K_d [1/s].
        horizon: both act as they will be so long ahead, at least one control period [s].
        weight: on the torques' distance from the blend [1/(N m)2]; by acceleration, on the
            joints' accelerations' [1/(rad/s2)2].
        blend: on the rate of the blend gamma, relative to the pose objective [s2].
        explicit: eq. 6 as printed, at this instant and without the horizon.
    """

    stiffness: NonNegative
    damping: NonNegative
    horizon: NonNegative
    weight: NonNegative
    blend: Positive
    explicit: Annotated[bool, Strict()] = False


@validated(frozen=True, config=STRICT)
class ContactGains:
    """How contacts are held: the W_v term of [Brown2013] eq. 2, in numbers free of the rate.

    Attributes:
        damping: a contact's velocity should fade at this rate [1/s], at most to zero in one
            control period, which is the paper's wish.
        weight: on the acceleration's distance from that [1/(m/s2)2].
        force: on the contact forces, makes them unique [1/N2].
        centripetal: whether the acceleration that the limbs' own turning gives a contact, Jdot
            qdot, is reckoned with; in a roll it is small, in a jump it lifts the toes.
    """

    damping: Positive
    weight: NonNegative
    force: Positive
    centripetal: Annotated[bool, Strict()] = False


@validated(frozen=True, config=STRICT)
class Gains:
    """What of a controller a behaviour brings along; see `ControllerSettings`."""

    supervisor: SupervisorName
    thresholds: Thresholds
    contact: ContactGains
    pose: PoseGains
    tasks: dict[str, TaskGains]
    poses: dict[str, PoseGains] = field(default_factory=dict)
    contacts: dict[str, ContactGains] = field(default_factory=dict)


@validated(frozen=True, config=STRICT)
class ControllerSettings:
    """Everything the whole-body controller can be told.

    Attributes:
        rate: control steps a second [Hz].
        solver: `boxqp`, `osqp` or `qpsolvers:<name>`.
        form: `condensed` (torques and accelerations eliminated) or `literal` (eq. 2).
        backend: `compiled` takes the C step where it serves (condensed boxqp) and is built;
            `reference` is the same mathematics in numpy.
        supervisor: inclusion test for contacts, see `rotctl.control.supervisor`.
        merging: which contacts count as one.
        friction: half-width of the controller's friction pyramid, mu of eq. 2 [-].
        sees_disturbance: whether control knows of the forces from outside.
        tracking: poses by the torques that lead to them, eq. 7, or by such accelerations, as the
            paper says that others do.
        poses, contacts: further gains of poses and contacts, by the name that a stage asks for.
        tasks: gains by the name of a behaviour's task, or by the name that a task asks for.
    """

    name: str
    rate: Annotated[Positive, Field(le=10_000)]
    solver: str
    form: FormName
    backend: BackendName
    supervisor: SupervisorName
    thresholds: Thresholds
    merging: Merging
    friction: Positive
    sees_disturbance: Annotated[bool, Strict()]
    contact: ContactGains
    pose: PoseGains
    tasks: dict[str, TaskGains]
    tracking: TrackedBy = "force"
    poses: dict[str, PoseGains] = field(default_factory=dict)
    contacts: dict[str, ContactGains] = field(default_factory=dict)
    description: str = ""
