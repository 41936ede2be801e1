"""The controller's numbers: weights, gains, supervisor thresholds; see `conf/controller/`."""

from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.control.supervisor import SupervisorName, Thresholds
from rotctl.mechanics.excursion import ExcursionName
from rotctl.settings import STRICT, NonNegative, NonNegativeVector, Positive

FormName = Literal["condensed", "literal"]
BackendName = Literal["compiled", "reference"]


@validated(frozen=True, config=STRICT)
class Weights:
    """Weights of the objectives, for errors in N, N m and m/s.

    Attributes:
        linear_momentum: on Ldot, [Brown2013] E_L [1/N^2].
        angular_momentum: on Hdot in-plane, E_H [1/(N m)^2].
        out_of_plane: factor on `angular_momentum` for the two out-of-plane axes [-].
        pose: on the torques' distance from the blend, eq. 7 [1/(N m)^2].
        contact_velocity: W_v of eq. 2 [1/(m/s)^2].
        contact_force: on the contact forces, makes them unique [1/N^2].
        blend: on the change of the blend, relative to the pose objective [-].
    """

    linear_momentum: NonNegative
    angular_momentum: NonNegative
    out_of_plane: NonNegative
    pose: NonNegative
    contact_velocity: NonNegative
    contact_force: Positive
    blend: Positive


@validated(frozen=True, config=STRICT)
class Gains:
    """Spring [1/s^2] and damping [1/s] gains of eq. 3, 4 (per world axis) and 6."""

    linear_stiffness: NonNegativeVector
    linear_damping: NonNegativeVector
    angular_stiffness: NonNegativeVector
    angular_damping: NonNegativeVector
    pose_stiffness: NonNegative
    pose_damping: NonNegative


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
        excursion: how AE is measured, see `rotctl.mechanics.excursion`.
        correction_time: of the `oriented` excursion [s].
        phase_time: of the phase by which poses are looked up [s].
        friction: half-width of the controller's friction pyramid, mu of eq. 2 [-].
    """

    name: str
    rate: Annotated[Positive, Field(le=10_000)]
    solver: str
    form: FormName
    backend: BackendName
    supervisor: SupervisorName
    thresholds: Thresholds
    excursion: ExcursionName
    correction_time: Positive
    phase_time: Positive
    friction: Positive
    weights: Weights
    gains: Gains
    description: str = ""
