"""The two physics, as numbers and as what they set in a model: MuJoCo's own, and lockstep."""

from typing import Annotated, ClassVar, Literal

import mujoco
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.settings import STRICT, Fraction, NonNegative, Positive, Vector

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
Count = Annotated[int, Strict(), Field(ge=0, le=10_000)]
Some = Annotated[int, Strict(), Field(ge=1, le=10_000)]
Substeps = Annotated[int, Strict(), Field(ge=1, le=1000)]
Capacity = Annotated[int, Strict(), Field(ge=1, le=1024)]


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
    disable: tuple[Literal["autoreset", "warmstart", "eulerdamp", "filterparent"], ...]
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
        option.disableflags = sum(_flag(name) for name in self.disable)
        for default in (spec.default.geom, spec.default.pair):
            default.solref = self.contact_solref
            default.solimp = self.contact_solimp


@validated(frozen=True, config=STRICT)
class LockstepPhysics:
    """Hard contacts and joint limits in one LCP a step, [Brown2013] Appendix A.

    See `rotctl.simulation.lockstep` for the equations and `conf/physics/lockstep.yaml` for
    reasons.

    Attributes:
        substeps: physics steps a control step; 1 is the paper's lockstep.
        margin: contacts nearer than this are rows of the LCP, open ones too [m].
        limit_margin: so are joint limits nearer than this [rad].
        correction: share of a penetration that a step takes back [-].
        slop: penetration that is left alone [m].
        push_out, limit_push_out: fastest correction of contacts [m/s] and limits [rad/s].
        sweeps: projected Gauss-Seidel stops after so many, whatever is left.
        tolerance: it stops earlier where a sweep changes no row by more [m/s].
        friction_follow: how far a friction bound goes towards mu p_N in a sweep [-].
        alarm: a residual above this becomes an event of the log [m/s].
        backend: `compiled` takes the C solver where it is built, `reference` numpy's.
        touch: a contact nearer than this is there for the controller [m].
        closing: so is one that would close within the control period.
    """

    name: str
    stepper: Literal["lockstep"]
    substeps: Substeps
    gravity: Vector
    margin: Annotated[Positive, Field(le=0.5)]
    limit_margin: Annotated[Positive, Field(le=1)]
    correction: Fraction
    slop: NonNegative
    push_out: NonNegative
    limit_push_out: NonNegative
    sweeps: Some
    tolerance: NonNegative
    friction_follow: Annotated[Positive, Field(le=1)]
    alarm: Positive
    backend: Literal["compiled", "reference"]
    touch: NonNegative
    closing: Annotated[bool, Strict()]
    ccd_iterations: Count
    ccd_tolerance: NonNegative
    contact_capacity: Capacity
    description: str = ""

    def implicit_damping(self, damping: float, step: float) -> float:
        """What the equations add to the mass matrix's diagonal [kg m2]: h D.

        M qddot + D (qdot + h qddot) = ... is (M + h D) qddot + D qdot = ...: to all that
        reads the model, controller included, damping at the end of a step is an armature.
        """
        return step * damping

    def set_options(self, spec: mujoco.MjSpec, control_rate: float) -> None:
        """Set MuJoCo's options for control at `control_rate` [Hz].

        Those of its integrator and constraint solver have no say here: neither ever acts.
        """
        option = spec.option
        option.timestep = 1.0 / (control_rate * self.substeps)
        option.gravity = self.gravity
        option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC  # contact rows are N, T1, T2
        option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        option.ccd_iterations = self.ccd_iterations
        option.ccd_tolerance = self.ccd_tolerance
        option.density = option.viscosity = 0.0
        option.wind = [0.0, 0.0, 0.0]
        option.magnetic = [0.0, 0.0, 0.0]
        option.enableflags = 0
        option.disableflags = _flag("autoreset")
        spec.default.geom.margin = 0.5 * self.margin  # MuJoCo adds those of two geoms
        spec.default.pair.margin = self.margin
        spec.default.joint.margin = self.limit_margin


Physics = Annotated[MujocoPhysics | LockstepPhysics, Field(discriminator="stepper")]


def _flag(name: str) -> int:
    return int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{name.upper()}"))
