"""Cost of a control step against the number of contacts and of degrees of freedom.

Of the compiled one as a roll's control period has it, in C from state to torques; also where poses
are so far off that torques are at their limits, which takes a larger quadratic program twice.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from rotctl import files
from rotctl.behaviours.behaviour import Behaviour
from rotctl.config.loading import load
from rotctl.config.schema import Config
from rotctl.control import Command, Controller
from rotctl.errors import InputError
from rotctl.mechanics import compilation
from rotctl.mechanics.character import Body, Geom, Joint
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import read
from rotctl.native import library

CONTACTS = (0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 24)  # the adult has no more than 25
HINGES = (29, 37, 46, 58)
AT = 8  # contacts, where hinges vary
TRIES = 60  # repeats of one decision; the least disturbed is taken


@dataclass(frozen=True)
class Cost:
    """Microseconds of a control step with so many contacts and hinges."""

    contacts: int
    hinges: int
    compiled: float
    limited: float
    reference: float


def measure() -> list[Cost]:
    """Costs against contacts at the adult's hinges, then against hinges at `AT` contacts."""
    config = load([])
    models_by_hinges = {hinges: _model(config, hinges) for hinges in HINGES}
    settings = [(m, HINGES[0]) for m in CONTACTS] + [(AT, hinges) for hinges in HINGES]
    return [Cost(m, n, *_times(config, models_by_hinges[n], m)) for m, n in settings]


def table(costs: list[Cost]) -> str:
    """The costs as text."""
    lines = ["microseconds a control step (state and both passes), least disturbed of many", ""]
    lines.append(f"{'contacts':>10}{'hinges':>10}{'compiled':>12}{'at limits':>12}{'numpy':>12}")
    lines += [
        f"{c.contacts:10d}{c.hinges:10d}{c.compiled:12.0f}{c.limited:12.0f}{c.reference:12.0f}"
        for c in costs
    ]
    return "\n".join(lines)


def plot(costs: list[Cost], out: Path) -> None:
    """Cost against contacts, both axes logarithmic.

    Raises:
        InputError: matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise InputError("--plot needs matplotlib: pip install matplotlib") from None
    shown = [c for c in costs[: len(CONTACTS)] if c.contacts]
    contacts = [c.contacts for c in shown]
    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    axes.loglog(contacts, [c.reference for c in shown], "o-", color="#0072b2", label="numpy")
    axes.loglog(contacts, [c.compiled for c in shown], "s-", color="#d55e00", label="compiled")
    line = [shown[-1].compiled * m / contacts[-1] for m in contacts]
    axes.loglog(contacts, line, ":", color="0.5", label="proportional to contacts")
    axes.set_xticks(contacts, [str(m) for m in contacts])
    axes.set_xlabel("contacts with the ground")
    axes.set_ylabel("control step [us]")
    axes.grid(which="both", alpha=0.2)
    axes.legend()
    packed = BytesIO()
    figure.savefig(packed, format=out.suffix[1:].lower())
    files.replace(out, packed.getvalue())


def _times(config: Config, model: Model, contacts: int) -> tuple[float, float, float]:
    """Microseconds of the compiled step, within limits and at them, and of the numpy step."""
    data = _lying(model, contacts)
    behaviour: Behaviour[Any] = config.behaviour.make(model, config.controller, config.excursion)
    state = read(model, data)
    far = behaviour.command(behaviour.begin(0.0, state), state)
    near = far._replace(pose_a=np.full(model.mj.nu, 0.3), pose_b=np.zeros(model.mj.nu))
    fast, slow = (
        Controller(model, replace(config.controller, backend=backend))
        for backend in ("compiled", "reference")
    )
    return (
        _least(_in_c(fast, near, data)),
        _least(_in_c(fast, far, data)),
        _least(lambda: slow.decide(slow.read(data), near, 0.5)),
    )


def _in_c(controller: Controller, command: Command, data: mujoco.MjData) -> Callable[[], object]:
    """The compiled step on one state, again and again; without it, the reference."""
    step, found = controller.step, library()
    controller.decide(controller.read(data), command, 0.5)
    if step is None or found is None:
        return lambda: controller.decide(controller.read(data), command, 0.5)
    at, there = step.addresses, data._address
    asked = at["self"], there, at["reading"], at["command"], at["answer"]
    step.ask(command, 0.5)
    return lambda: (found.rotctl_read(*asked[:3]), found.rotctl_decide(*asked))


def _least(once: Callable[[], object]) -> float:
    """Microseconds of the least disturbed of `TRIES`."""
    least = np.inf
    for _ in range(TRIES):
        begin = time.perf_counter()
        once()
        least = min(least, time.perf_counter() - begin)
    return 1e6 * least


def _lying(model: Model, contacts: int) -> mujoco.MjData:
    """The character on its front, with all but the first `contacts` ground contacts removed.

    A contact is removed by telling MuJoCo's data that it has no constraint row, which is
    how both steps know a contact that does not count.
    """
    data = mujoco.MjData(model.mj)
    data.qpos[:7] = [0.0, 0.0, 0.14, np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]
    data.qvel[:] = 0.1 * np.random.default_rng(0).normal(size=model.mj.nv)
    margin = model.mj.geom_margin.copy()
    model.mj.geom_margin[:] = 0.6
    mujoco.mj_step1(model.mj, data)
    model.mj.geom_margin[:] = margin
    ground = np.flatnonzero((model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1))
    if len(ground) < contacts:
        raise InputError(f"the character lies on {len(ground)} points, {contacts} are asked for")
    for i in ground[:contacts]:
        data.contact[int(i)].dist = 0.0  # control counts those that touch
    for i in ground[contacts:]:
        data.contact[int(i)].efc_address = -1
    return data


def _model(config: Config, hinges: int) -> Model:
    """The character with finger-like hinges added until it has `hinges`."""
    character = config.character
    have = sum(len(b.joints) * (2 if b.mirror else 1) for b in character.bodies)
    extra = tuple(
        Body(
            name=f"finger_{i}",
            parent="forearm_l" if i % 2 else "forearm_r",
            position=(0.0, 0.0, -0.34),
            joints=(Joint(f"finger_{i}", (0.0, 1.0, 0.0), (-1.0, 1.0), 10.0),),
            geoms=(Geom(f"finger_{i}", 0.01, (0.0, 0.0, -0.02), 1e-3),),
        )
        for i in range(hinges - have)
    )
    larger = replace(character, bodies=character.bodies + extra)
    return compilation.build(larger, config.terrain, config.physics, config.controller.rate)
