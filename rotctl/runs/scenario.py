"""The composition root: the only place that knows all the parts of a run."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import mujoco
import numpy as np

from rotctl.behaviours import BehaviourSettings
from rotctl.behaviours.behaviour import Behaviour
from rotctl.behaviours.similarity import similar as asking
from rotctl.caching import kept
from rotctl.config.fit import require_fit
from rotctl.config.identity import run_id
from rotctl.config.schema import Config
from rotctl.config.sense import require_sense
from rotctl.control import Controller, ControllerSettings
from rotctl.control.similarity import similar
from rotctl.mechanics import compilation
from rotctl.mechanics.disturbance import DISTURBANCE_STREAM, Disturbance
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.physics import LockstepPhysics, Physics
from rotctl.mechanics.plant import PLANT_STREAM, Motors, Senses, Variation
from rotctl.mechanics.stature import gains_likeness
from rotctl.mechanics.terrain import FASTEST, Basin
from rotctl.mechanics.water import Water
from rotctl.simulation import aloft, falling, sampling
from rotctl.simulation.lockstep import LockstepStepper
from rotctl.simulation.start import Start
from rotctl.simulation.stepping import MujocoStepper, Stepper


@dataclass(frozen=True)
class Scenario:
    """One run, ready to be simulated once.

    Attributes:
        model: what is simulated.
        known: what control and behaviour know of it; mostly the same.
        observer: reads what is simulated; the controller itself, where it sees just that.
        data: makes MuJoCo's memory of a model, which a run resets.
        run_id: 12 hex digits; the same for the same config, log schema and model.
    """

    config: Config
    model: Model
    known: Model
    behaviour: Behaviour[Any]
    controller: Controller
    observer: Controller
    stepper: Stepper
    senses: Senses
    motors: Motors
    disturbance: Disturbance
    start: Start
    data: Callable[[mujoco.MjModel], mujoco.MjData]
    run_id: str


def behaviour_of(
    settings: BehaviourSettings,
    known: Model,
    control: ControllerSettings,
    measured: ExcursionSettings,
) -> Behaviour[Any]:
    """The behaviour that settings ask for; what it remembers of a run is handed to it anew.

    Raises:
        InputError: it does not fit the model, or how it is measured.
    """
    return settings.make(known, control, measured)


class Making(NamedTuple):
    """How the parts of a run are made that depend on nothing that is drawn.

    To make a flip takes as long as to simulate a quarter of a second of it, and MuJoCo's memory,
    page by page, as long as a tenth of a roll's second: see `shared`.
    """

    controller: Callable[[Model, ControllerSettings], Controller] = Controller
    behaviour: Callable[..., Behaviour[Any]] = behaviour_of
    data: Callable[[mujoco.MjModel], mujoco.MjData] = mujoco.MjData


ANEW = Making()


def shared() -> Making:
    """For runs each of which is over before the next one begins: the same parts serve them all."""
    keep, few = kept(most=8), kept(most=2)  # MuJoCo's memory is of some megabytes
    return Making(keep(Controller), keep(behaviour_of), few(mujoco.MjData))


def build(config: Config, making: Making = ANEW, *, again: bool = False) -> Scenario:
    """Make all parts of a run.

    Args:
        again: whether it repeats one, of which no more is asked than when it was made.

    Raises:
        InputError: parts that do not fit together, with one clear line.
    """
    by = gains_likeness(config.character)
    control = similar(config.controller, by, config.behaviour.kinds)
    known, plant = model_of(config), _of_plant(config)
    require_fit(config, known)
    if not again:
        require_sense(config, known)
    model = _simulated(config, plant)
    asked = asking(config.behaviour, by)
    behaviour = making.behaviour(asked, known, control, config.excursion)
    generator = np.random.default_rng([config.seed, DISTURBANCE_STREAM])
    controller = making.controller(known, control)
    motors = Motors(model, config.plant.delay)
    substeps = config.physics.substeps
    senses = Senses(known, model, config.plant, motors, substeps, plant)
    return Scenario(
        config=config,
        model=model,
        known=known,
        behaviour=behaviour,
        disturbance=_outside(model, config.disturbance.make(model, behaviour.axes, generator)),
        controller=controller,
        observer=controller if senses.exact else Controller(model, control),
        stepper=_stepper(config.physics, model),
        senses=senses,
        motors=motors,
        start=sampling.draw(
            asking(config.start, by, falling.UNITS | aloft.UNITS),
            known,
            config.behaviour.roll_about,
            np.random.default_rng(config.seed),
        ),
        data=making.data,
        run_id=run_id(config, known),
    )


def _outside(model: Model, disturbance: Disturbance) -> Disturbance:
    """What acts from outside: the disturbance, and water where there is some."""
    pool = model.ground
    return Water(model.mj, pool, disturbance) if isinstance(pool, Basin) else disturbance


def _stepper(physics: Physics, model: Model) -> Stepper:
    if isinstance(physics, LockstepPhysics):
        return LockstepStepper(model, physics)
    return MujocoStepper(model, physics.substeps)


# Nobody changes a model, so runs that differ in their seed or gains share one.
model_from = kept(most=8)(lru_cache(maxsize=8)(compilation.build))


def model_of(config: Config) -> Model:
    """The model that a config describes, compiled once a process.

    Raises:
        InputError: the numbers do not make a model.
    """
    return model_from(*model_parts(config))


def simulated_model_of(config: Config) -> Model:
    """The model that is simulated: what control knows, or what its plant differs by.

    Raises:
        InputError: as for `model_of`.
    """
    return _simulated(config, _of_plant(config))


def _of_plant(config: Config) -> np.random.Generator:
    """What draws how a plant differs, and afterwards its noise."""
    return np.random.default_rng([config.seed, PLANT_STREAM])


def _simulated(config: Config, generator: np.random.Generator) -> Model:
    apart = config.plant.differs or config.disturbance.changes_model
    return _varied(config, Variation(config.plant, generator)) if apart else model_of(config)


def model_parts(config: Config) -> tuple[Any, ...]:
    """What its model is built of: character, terrain, and what `_world` gives."""
    return config.character, config.terrain, *_world(config)


def _varied(config: Config, variation: Variation) -> Model:
    """The same with what differs in this run."""
    terrain = replace(config.terrain, friction=variation.friction * config.terrain.friction)
    return compilation.build(config.character, terrain, *_world(config), variation.apply)


def _world(config: Config) -> tuple[Physics, float, int, float]:
    """Physics, control rate [Hz], the terrain's seed and its reach [m]."""
    terrain = config.terrain
    seed = config.seed if terrain.seeded else 0
    reach = 0.0 if terrain.endless else FASTEST * config.duration
    return config.physics, config.controller.rate, seed, reach
