"""A stage made ready for one model: its tasks, what fills them, its gains and its law of poses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.behaviours.aerial.flight import Flight
from rotctl.behaviours.behaviour import contact_gains_of, gains_of, pose_gains_of
from rotctl.behaviours.facing import Frame
from rotctl.behaviours.staged.aims import Aim
from rotctl.behaviours.staged.posing import OverPhase, PoseLaw
from rotctl.behaviours.staged.stages import Stage, TaskSettings
from rotctl.behaviours.standing.stepping import Stepping
from rotctl.control import ControllerSettings
from rotctl.control.kinds import kind
from rotctl.control.settings import ContactGains, PoseGains
from rotctl.control.task import TASK, Tasks, task
from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import SIDES, body_ids
from rotctl.mechanics.model import Model
from rotctl.motion import make_pose_pair


@dataclass(frozen=True)
class Prepared:
    """A stage, ready: its tasks, what fills them, and their places among the behaviour's.

    An aim may take a task's weight for a step, and leave the rest of it as it was; `fresh` is what
    tasks begin a run with. Each filler has its task as a view of its row.
    """

    tasks: Tasks
    fillers: list[tuple[Tasks, str, Aim]]
    slots: list[int]
    held_out: NDArray[np.bool_]
    behind: Array | None
    pose: PoseGains
    contact: ContactGains
    aims: dict[str, Aim]
    stepping: Stepping | None
    fresh: Tasks


def prepared(
    place: str,
    key: str,
    stage: Stage,
    common: Mapping[str, TaskSettings],
    names: Sequence[str],
    axes: Array,
    control: ControllerSettings,
    model: Model,
) -> Prepared:
    """Make a stage ready.

    Args:
        place: where the settings of the stages and of common tasks stand, `behaviour`.
        key: where the stage stands, `behaviour.stages.0`.
        common: tasks that the behaviour has in all stages, by name.
        names: of all tasks of the behaviour, see `task_names`.
        axes: rows are the behaviour's forward, left and up.

    Raises:
        InputError: a body is not there, or a task has no gains.
    """
    every = {**common, **stage.tasks}
    rows: list[Tasks] = []
    filled: list[tuple[int, str, Aim]] = []
    slots: list[int] = []
    named = {name: wanted.gains or name for name, wanted in every.items()}
    gains = gains_of(control, tuple(named.values()))
    for name, wanted in every.items():
        said = f"{key if name in stage.tasks else place}.tasks.{name}"
        bodies = body_ids(model.mj, [wanted.body], f"{said}.body") if wanted.body else [0]
        for body, slot in zip(bodies, task_names(model, said, name, wanted), strict=True):
            if wanted.aim:
                wanted.aim.check(model, f"{said}.aim")
                filled.append((len(rows), wanted.kind, wanted.aim))
            rows.append(
                task(kind(wanted.kind).number, gains[named[name]], axes, body, wanted.point)
            )
            slots.append(names.index(slot))
    held_out = model.excluded.copy()
    held_out[body_ids(model.mj, stage.held_out, f"{key}.held_out")] = 1
    tasks = np.concatenate([np.zeros(0, TASK), *rows])
    aims = {name: wanted.aim for name, wanted in every.items() if wanted.aim}
    return Prepared(
        tasks=tasks,
        fillers=[(tasks[row], kind_name, aim) for row, kind_name, aim in filled],
        slots=slots,
        held_out=held_out,
        behind=_behind(f"{key}.toes", stage, model),
        pose=pose_gains_of(control, stage.pose),
        contact=contact_gains_of(control, stage.contact),
        aims=aims,
        stepping=next((aim for aim in aims.values() if isinstance(aim, Stepping)), None),
        fresh=tasks.copy(),
    )


def task_names(model: Model, key: str, name: str, wanted: TaskSettings) -> list[str]:
    """A task's names: one for each side where its body stands for both; it stands at a key."""
    both = wanted.body and len(body_ids(model.mj, [wanted.body], f"{key}.body")) == 2
    return [name + side for side in SIDES] if both else [name]


def pose_law(
    key: str, stage: Stage, shape: str, frame: Frame, target: float, model: Model
) -> PoseLaw[Any]:
    """What says a stage's pose.

    Args:
        key: where the stage stands.
        shape: in which it flies, if it does.
        target: to turn [rad].

    Raises:
        InputError: a joint or a body is not there.
    """
    if stage.flight:
        return Flight(stage.flight, model, frame, target, f"{key}.flight", shape)
    if stage.rise:
        return stage.rise.make(model, f"{key}.rise")
    if stage.turn:
        return stage.turn.make(model, f"{key}.turn")
    if stage.glide:
        return stage.glide.make(model, f"{key}.glide")
    if stage.reach:
        return stage.reach.make(model, f"{key}.reach")
    assert stage.poses  # one of the six is there
    return OverPhase(make_pose_pair(model, stage.poses, f"{key}.poses"), stage.lead, stage.beyond)


def _behind(key: str, stage: Stage, model: Model) -> Array | None:
    """What of each body (nbody,) may only be used where it stands on its front."""
    if not stage.toes:
        return None
    mj = model.mj
    behind = np.full(mj.nbody, -np.inf)
    for body in body_ids(mj, stage.toes, key):
        solid = (mj.geom_bodyid == body) & (mj.geom_contype > 0)
        behind[body] = mj.geom_pos[solid, 0].mean()
    return behind
