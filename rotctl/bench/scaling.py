"""Cost of a control step against the number of contacts and of degrees of freedom."""

import time
from dataclasses import replace

import mujoco
import numpy as np

from rotctl.config import Config, load
from rotctl.control import Controller, Desired
from rotctl.mechanics import model as models
from rotctl.mechanics.character import Body, Geom, Joint
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State

CONTACTS = (0, 1, 2, 4, 8, 15, 22, 32)
HINGES = (29, 37, 46, 58)
TRIES = 60  # repeats of one decision; the least disturbed is taken


def scale() -> str:
    """Two tables: against contacts at 29 hinges, against hinges at about eight contacts."""
    config = load([])
    lines = ["microseconds a control step (state and both passes), least disturbed of many", ""]
    lines.append(f"{'contacts':>10}{'compiled':>12}{'numpy':>12}")
    model = _model(config, HINGES[0])
    rows = [(m, *_times(config, model, m)) for m in CONTACTS]
    lines += [f"{m:10d}{fast:12.0f}{slow:12.0f}" for m, fast, slow in rows]
    lines += ["", f"{'hinges':>10}{'compiled':>12}{'numpy':>12}   at 8 contacts"]
    for hinges in HINGES:
        fast, slow = _times(config, _model(config, hinges), 8)
        lines.append(f"{hinges:10d}{fast:12.0f}{slow:12.0f}")
    return "\n".join(lines)


def _times(config: Config, model: Model, contacts: int) -> tuple[float, float]:
    """Microseconds of the compiled and the numpy step with that many contacts."""
    data = _lying(model, contacts)
    times = []
    for backend in ("compiled", "reference"):
        controller = Controller(model, replace(config.controller, backend=backend))
        state = controller.read(data)
        desired = _desired(model, state)
        least = np.inf
        for _ in range(TRIES):
            begin = time.perf_counter()
            controller.decide(controller.read(data), desired, 0.5)
            least = min(least, time.perf_counter() - begin)
        times.append(1e6 * least)
    return times[0], times[1]


def _lying(model: Model, contacts: int) -> mujoco.MjData:
    """The character on its front, with all but the first `contacts` ground contacts removed.

    A contact is removed by telling MuJoCo's data that it has no constraint row, which is
    how both steps know a contact that does not count.
    """
    data = mujoco.MjData(model.mj)
    data.qpos[:7] = [0.0, 0.0, 0.14, np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]
    data.qvel[:] = 0.1 * np.random.default_rng(0).normal(size=model.mj.nv)
    margin = model.mj.geom_margin.copy()
    model.mj.geom_margin[:] = 0.2
    mujoco.mj_step1(model.mj, data)
    model.mj.geom_margin[:] = margin
    ground = np.flatnonzero((model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1))
    for i in ground[contacts:]:
        data.contact[int(i)].efc_address = -1
    return data


def _desired(model: Model, state: State) -> Desired:
    upright = np.zeros(model.mj.nu)
    return Desired(
        com=state.momentum.com.copy(),
        com_velocity=np.array([1.2, 0.0, 0.0]),
        excursion_error=np.zeros(3),
        angular_velocity=np.array([0.0, 8.0, 0.0]),
        pose_a=upright + 0.3,
        pose_b=upright,
    )


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
    return models.build(larger, config.terrain, config.physics, config.controller.rate)
