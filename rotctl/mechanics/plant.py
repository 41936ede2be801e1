"""The simulated character where it is not the one that control knows, drawn from the run's seed.

Control keeps the model of the config, the simulated one has other masses, friction and strength.
What control sees of it may be noisy, and what it asks for may come late.
"""

from collections import deque
from typing import Annotated

import mujoco
import numpy as np
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.engine import quiet
from rotctl.maths.rotations import Array, advance
from rotctl.mechanics.model import Model
from rotctl.settings.fields import STRICT, NonNegative, Range

PLANT_STREAM = 3  # beside those of the start, the terrain and the disturbance

Share = Annotated[NonNegative, Field(le=0.9)]


@validated(frozen=True, config=STRICT)
class PlantSettings:
    """Uniform ranges of what differs, and what is between control and the body.

    Attributes:
        mass: share by which each body's mass and inertia may be off, either way [-].
        torque: share by which each motor's limit may be off, either way [-].
        friction: range of a factor on the ground's friction [-].
        delay: control steps from a decision to the torque that acts.
        predicted: whether control plans for the state in which its torque will act, as far as
            the model that it knows tells.
        angle_noise: of joint angles and the root's attitude, standard deviation [rad].
        rate_noise: of joint velocities and the root's angular velocity [rad/s].
        velocity_noise: of the root's velocity [m/s].
    """

    name: str
    mass: Share
    torque: Share
    friction: Range
    delay: Annotated[int, Strict(), Field(ge=0, le=100)]
    predicted: Annotated[bool, Strict()]
    angle_noise: Annotated[NonNegative, Field(le=1.0)]
    rate_noise: Annotated[NonNegative, Field(le=100.0)]
    velocity_noise: Annotated[NonNegative, Field(le=100.0)]
    description: str = ""

    def __post_init__(self) -> None:
        if not 0.0 < self.friction[0] <= 100.0 or self.friction[1] > 100.0:
            raise ValueError(
                f"friction={list(self.friction)}: must be factors above 0 and at most 100"
            )
        if self.predicted and not self.delay:
            raise ValueError("predicted is about a delay, and there is none")

    @property
    def differs(self) -> bool:
        """Whether the simulated model is another than the one that control knows."""
        return bool(self.mass or self.torque or self.friction != (1.0, 1.0))

    @property
    def noisy(self) -> bool:
        """Whether what control sees is blurred."""
        return bool(self.angle_noise or self.rate_noise or self.velocity_noise)


class Variation:
    """What differs in one run."""

    def __init__(self, settings: PlantSettings, generator: np.random.Generator) -> None:
        """Draw the ground's friction; bodies and motors draw theirs as they are met."""
        self._settings, self._generator = settings, generator
        self.friction = float(generator.uniform(*settings.friction))

    def apply(self, spec: mujoco.MjSpec) -> None:
        """Change a character's masses and motors; nothing else may be in `spec` yet."""
        for body in spec.bodies:
            factor = self._factor(self._settings.mass)
            for geom in body.geoms:
                geom.mass *= factor
        for motor in spec.actuators:
            motor.ctrlrange = motor.ctrlrange * self._factor(self._settings.torque)

    def _factor(self, share: float) -> float:
        return 1.0 + float(self._generator.uniform(-share, share))


class Motors:
    """Torques from control to the body: late, and within what the body has."""

    def __init__(self, plant: Model, delay: int) -> None:
        """Hand each decision on `delay` control steps later."""
        self._limit, self._delay = plant.torque_limit, delay
        self._waiting: deque[Array] = deque()

    @property
    def prompt(self) -> bool:
        """Whether what is decided acts at once."""
        return not self._delay

    @property
    def pending(self) -> list[Array]:
        """Torques (nu,) of the coming control steps that are decided already."""
        return list(self._waiting)[-self._delay :] if self._delay else []

    def act(self, torque: Array) -> Array:
        """What acts (nu,) [N m] in the control step of a decision.

        Until the first decision has come through it is the first one that acts: nobody starts limp.
        """
        waiting = self._waiting
        waiting.extend([torque] * (1 if waiting else self._delay + 1))
        acting = waiting.popleft()
        return np.minimum(np.maximum(acting, -self._limit), self._limit)


class Senses:
    """What control sees of the simulated state.

    Attributes:
        exact: whether that is just what there is.
        remark: what the log should tell of the last look; mostly empty.
    """

    def __init__(
        self,
        known: Model,
        plant: Model,
        settings: PlantSettings,
        motors: Motors,
        substeps: int,
        generator: np.random.Generator,
    ) -> None:
        """Control knows `known`, while `plant` is simulated in so many steps a control period."""
        self._known, self._settings, self._generator = known.mj, settings, generator
        self._motors, self._substeps, self.remark = motors, substeps, ""
        self.exact = known is plant and not settings.noisy and not settings.predicted
        self._seen = None if self.exact else mujoco.MjData(known.mj)

    def look(self, data: mujoco.MjData) -> mujoco.MjData:
        """The data that control reads: the simulated ones, or its own model's in that state."""
        seen = self._seen
        if seen is None:
            return data
        mj, settings = self._known, self._settings
        seen.time = data.time
        seen.qpos[:], seen.qvel[:] = data.qpos, data.qvel
        seen.xfrc_applied[:] = data.xfrc_applied
        if settings.noisy:
            self._blur(seen)
        self.remark = self._predict(seen) if settings.predicted else ""
        seen.time = data.time
        mujoco.mj_step1(mj, seen)
        return seen

    def _predict(self, seen: mujoco.MjData) -> str:
        """Go on to where the coming torque will act; stay, and say so, where that breaks down."""
        mj, position, velocity = self._known, seen.qpos.copy(), seen.qvel.copy()
        wrench = seen.xfrc_applied.copy()
        with quiet() as heard:  # what is simulated is as well as ever
            for torque in self._motors.pending:
                seen.ctrl[:] = torque
                mujoco.mj_step(mj, seen, self._substeps)
        if not heard and not any(seen.warning.number.tolist()):
            return ""
        mujoco.mj_resetData(mj, seen)  # as MuJoCo has done, to a posture that is not ours
        seen.qpos[:], seen.qvel[:], seen.xfrc_applied[:] = position, velocity, wrench
        return "the prediction broke down: control saw the present state"

    def _blur(self, seen: mujoco.MjData) -> None:
        nu, settings, normal = self._known.nu, self._settings, self._generator.normal
        seen.qpos[3:7] = advance(seen.qpos[3:7], normal(0.0, settings.angle_noise, 3))
        seen.qpos[7 : 7 + nu] += normal(0.0, settings.angle_noise, nu)
        seen.qvel[:3] += normal(0.0, settings.velocity_noise, 3)
        seen.qvel[3 : 6 + nu] += normal(0.0, settings.rate_noise, 3 + nu)
