"""MuJoCo's own physics: every option set, so that a new default cannot change a result."""

from typing import Annotated, ClassVar, Literal

import mujoco
from pydantic import AfterValidator
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.physics.options import Capacity, Count, Some, Substeps, disable_flag
from rotctl.settings.fields import STRICT, Fraction, NonNegative, Positive, Vector, each_once

IMPEDANCES = 1e-4, 0.9999  # [-] least and most that MuJoCo has of a contact
# In one order, however it is written: the flags add up, and one that comes twice is another one.
Disabled = Annotated[
    tuple[Literal["autoreset", "warmstart", "eulerdamp", "filterparent"], ...],
    AfterValidator(each_once),
    AfterValidator(lambda names: tuple(sorted(names))),
]
PLAIN_OPTIONS = (
    "iterations",
    "tolerance",
    "ls_iterations",
    "ls_tolerance",
    "noslip_iterations",
    "noslip_tolerance",
    "ccd_iterations",
    "ccd_tolerance",
    "impratio",
    "density",
    "viscosity",
)


@validated(frozen=True, config=STRICT)
class MujocoPhysics:
    """Every option of MuJoCo's physics; see `conf/physics/mujoco.yaml` for units and reasons."""

    name: str
    stepper: Literal["mujoco"]
    substeps: Substeps
    gravity: Vector
    integrator: Literal["euler", "implicit", "implicitfast"]
    cone: Literal["elliptic", "pyramidal"]
    solver: Literal["newton", "cg", "pgs"]
    jacobian: Literal["dense"]
    iterations: Some
    tolerance: NonNegative
    ls_iterations: Some
    ls_tolerance: NonNegative
    noslip_iterations: Count
    noslip_tolerance: NonNegative
    ccd_iterations: Count
    ccd_tolerance: NonNegative
    impratio: Positive
    density: NonNegative
    viscosity: NonNegative
    disable: Disabled
    contact_solref: tuple[Positive, Positive]
    contact_solimp: tuple[Fraction, Fraction, Positive, Fraction, Positive]
    contact_capacity: Capacity
    description: str = ""

    touch: ClassVar[float] = 0.0  # no open contacts exist
    closing: ClassVar[bool] = False

    def implicit_damping(self, damping: float, step: float) -> float:
        """What the equations add to the mass matrix's diagonal [kg m2]: MuJoCo does it itself."""
        return 0.0

    def set_options(self, spec: mujoco.MjSpec, control_rate: float) -> None:
        """Set MuJoCo's options for control at `control_rate` [Hz]."""
        option = spec.option
        option.timestep = 1.0 / (control_rate * self.substeps)
        option.gravity = self.gravity
        option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{self.integrator.upper()}")
        option.cone = getattr(mujoco.mjtCone, f"mjCONE_{self.cone.upper()}")
        option.solver = getattr(mujoco.mjtSolver, f"mjSOL_{self.solver.upper()}")
        option.jacobian = getattr(mujoco.mjtJacobian, f"mjJAC_{self.jacobian.upper()}")
        for name in PLAIN_OPTIONS:
            setattr(option, name, getattr(self, name))
        option.wind = [0.0, 0.0, 0.0]
        option.magnetic = [0.0, 0.0, 0.0]
        option.enableflags = 0
        option.disableflags = sum(disable_flag(name) for name in self.disable)
        for default in (spec.default.geom, spec.default.pair):
            default.solref = self.contact_solref
            default.solimp = self.contact_solimp
