"""One simulated episode, control step by control step: the loop that everybody reads.

Read the state, ask the behaviour, decide, disturb, step the physics. Runs record the moments; the
bench, the search and the tests look at them.
"""

from collections.abc import Callable, Iterator
from math import nan
from typing import Any, NamedTuple, Protocol

import mujoco

from rotctl.behaviours.behaviour import Behaviour, Signals
from rotctl.control import Command, Controller, Decision
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.disturbance import Disturbance
from rotctl.mechanics.model import Model
from rotctl.mechanics.plant import Motors, Senses
from rotctl.mechanics.state import State
from rotctl.mechanics.terrain import Ground
from rotctl.simulation.ground_forces import GroundForces
from rotctl.simulation.placing import beginning, place
from rotctl.simulation.start import Start
from rotctl.simulation.stepping import Stepper

INITIAL_BLEND = 0.5  # gamma before the first decision: no preference
STAGES = ("physics", "state", "command", "decision")
Mark = Callable[[str], object]


class Parts(Protocol):
    """What an episode is made of."""

    @property
    def model(self) -> Model:
        """The character in its world, as it is simulated."""
        ...

    @property
    def senses(self) -> Senses:
        """What control sees of it."""
        ...

    @property
    def motors(self) -> Motors:
        """What comes of control's torques."""
        ...

    @property
    def behaviour(self) -> Behaviour[Any]:
        """What it does."""
        ...

    @property
    def controller(self) -> Controller:
        """What moves it."""
        ...

    @property
    def observer(self) -> Controller:
        """What reads the character as it is."""
        ...

    @property
    def stepper(self) -> Stepper:
        """The physics."""
        ...

    @property
    def disturbance(self) -> Disturbance:
        """What disturbs it."""
        ...

    @property
    def start(self) -> Start:
        """How it starts."""
        ...

    @property
    def data(self) -> Callable[[mujoco.MjModel], mujoco.MjData]:
        """Makes MuJoCo's memory of a model, or gives that of an earlier run, to be reset."""
        ...


class Moment(NamedTuple):
    """One control step.

    Attributes:
        truth: the state there was.
        state: what the controller saw of it; mostly the same.
        command, signals: of the behaviour.
        blend: gamma of the step before.
        decision: of the controller.
        torque: (nu,) that acted [N m].
        wrench: (6,) from outside, about the centre of mass [N, N m].
        forces: what the ground did.
        ground_height: below the centre of mass [m].
        remark: of the physics, or of what disturbs; mostly empty.
    """

    truth: State
    state: State
    command: Command
    signals: Signals
    blend: float
    decision: Decision
    torque: Array
    wrench: Array
    forces: GroundForces
    ground_height: float
    remark: str


class Episode:
    """An iterator over moments that ends where the physics breaks down, or the ground ends.

    Attributes:
        data: MuJoCo's, which a reader must leave alone.
        breakdown: what broke down; empty if nothing did.
        left: where the character left the ground; empty if it did not.
        memory, blend, phase: what the control period before left: the behaviour's memory, gamma
            and the behaviour's phase [rad].
    """

    def __init__(self, parts: Parts, mark: Mark = lambda stage: None) -> None:
        """Place the character.

        Args:
            mark: called at the end of each of `STAGES`, for a clock.
        """
        self.breakdown = self.left = ""
        self._parts, self._mark = parts, mark
        self.memory: Any = None
        self.blend, self.phase = INITIAL_BLEND, nan
        self.data = parts.data(parts.model.mj)
        self._pitch = beginning(parts.start, parts.behaviour)
        usual = parts.behaviour.start(parts.start.pitch)
        place(parts.model, self.data, parts.start, usual, parts.behaviour.axes)

    def __iter__(self) -> Iterator[Moment]:
        """The moments, one a control period."""
        while (moment := self.step()) is not None:
            yield moment

    def step(self) -> Moment | None:
        """The next control period; None where the episode is over.

        Raises:
            InputError: there is no ground where it starts.
        """
        parts, data, mark = self._parts, self.data, self._mark
        model, behaviour, controller = parts.model, parts.behaviour, parts.controller
        period = 1.0 / controller.settings.rate
        parts.stepper.evaluate(data)
        self.breakdown = parts.stepper.complaint(data)
        if self.breakdown:
            return None
        outside = parts.disturbance.apply(data, period, self.phase)
        mark("physics")
        if parts.senses.exact:
            truth = state = controller.read(data)
        else:
            truth = parts.observer.read(data)
            state = controller.read(parts.senses.look(data))
        mark("state")
        before, beside = self.memory, _beside(model.ground, truth)
        if beside and before is None:
            raise InputError(f"start: begins beside the ground, at {beside}")
        if beside:
            self.left = f"left the ground at t = {truth.time:.2f} s, {beside}"
            return None
        if before is None:
            before = behaviour.begin(self._pitch, state)
        self.memory = memory = behaviour.advance(before, state)
        command = behaviour.command(memory, state)
        signals = behaviour.signals(memory, state)
        mark("command")
        blend = self.blend
        decision = controller.decide(state, command, blend)
        mark("decision")
        torque = parts.motors.act(decision.torque)
        forces = parts.stepper.advance(data, torque, state.contacts)
        x, y, _ = truth.momentum.com.tolist()
        height = model.ground.height(x, y)
        remarks = (parts.disturbance.remark, parts.senses.remark, parts.stepper.remark())
        remark = "; ".join(filter(None, remarks))
        self.blend, self.phase = decision.blend, signals.phase
        mark("physics")
        return Moment(
            truth=truth,
            state=state,
            command=command,
            signals=signals,
            blend=blend,
            decision=decision,
            torque=torque,
            wrench=outside,
            forces=forces,
            ground_height=height,
            remark=remark,
        )


def _beside(ground: Ground, state: State) -> str:
    """Where the centre of mass is, and where there is ground; empty while it is over that."""
    x, y, _ = state.momentum.com.tolist()
    return (
        ""
        if ground.extent.has(x, y)
        else f"x = {x:.2f} m, y = {y:.2f} m: it reaches {ground.extent}"
    )
