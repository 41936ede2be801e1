"""The paper's physics as numbers: hard contacts and joint limits in one LCP a step."""

from typing import Annotated, Literal

import mujoco
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.physics.options import Capacity, Count, Some, Substeps, disable_flag
from rotctl.settings.fields import STRICT, Fraction, NonNegative, Positive, Vector


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
        option.disableflags = disable_flag("autoreset")
        spec.default.geom.margin = 0.5 * self.margin  # MuJoCo adds those of two geoms
        spec.default.pair.margin = self.margin
        spec.default.joint.margin = self.limit_margin
