"""What is shown of a run at some of its rows beside the body: turns, contacts, forces, events."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays, in_frame
from rotctl.report.happenings import happenings
from rotctl.report.stage_names import stage_names, stages_of_parts

LEAST_PUSH = 0.5  # [N] less is none
FARTHEST = 1.0  # [m] from the centre of mass to where it acts; a stranger's log may say anything
STEADY = 1e-3  # what varies less over a stage is no blend


@dataclass(frozen=True)
class Moment:
    """What a frame shows beside the model."""

    time: float  # [s]
    turns: float  # about its axis, see `turns_done` [rev]
    note: str  # the blend of the poses where there is one, else the name of the stage
    contacts: Array  # (k, 3)
    forces: Array  # (k, 3) [N]
    used: Array  # (k,)
    push: Array  # (3,) force from outside [N]
    pushed: Array  # (3,) where it acts: on its line, nearest to the centre of mass
    happened: tuple[str, ...] = ()  # since the frame before


def turns_done(log: Arrays, stages: Sequence[int] = ()) -> Array:
    """Excursion about what the behaviour turns about, since the start of the run (n,) [rev].

    Args:
        stages: how many each part of a chain has. A part that turns about another axis than the
            one before begins at 0.
    """
    axis = in_frame(log, "trajectory/trunk_axis")
    angle = in_frame(log, "trajectory/angular_excursion")
    part = np.zeros(len(angle), dtype=int)
    if len(stages) > 1:
        part = np.searchsorted(np.cumsum(stages), log["command/stage"], side="right")
    begins = np.flatnonzero(np.diff(part, prepend=-1)).tolist()
    turns, before = np.zeros(len(angle)), -1
    for first, end in zip(begins, [*begins[1:], len(angle)], strict=True):
        about = int(np.abs(axis[first]).argmax())
        done = turns[first - 1] if about == before else 0.0
        turns[first:end] = done + (angle[first:end, about] - angle[first, about]) / (2.0 * np.pi)
        before = about
    return turns


def moments(log: RunLog, rows: list[int], lasting: float = 0.0) -> list[Moment]:
    """What is drawn over the frames of these rows; what happened for so long [s] from then on."""
    time, turns, notes = log["trajectory/time"], turns_done(log, stages_of_parts(log)), _notes(log)
    filled = log["contacts/body"] >= 0
    position, used = log["contacts/position"], log["contacts/used"]
    force = log["contacts/force_realised"]
    sound = filled & np.isfinite(position).all(axis=2) & np.isfinite(force).all(axis=2)
    push, pushed = _pushes(log)
    changed = happenings(log)
    before = [rows[0] - 1, *rows[:-1]]
    return [
        Moment(
            time=float(time[i]),
            turns=float(turns[i]),
            note=notes[i],
            contacts=position[i, sound[i]].astype(float),
            forces=force[i, sound[i]].astype(float),
            used=used[i, sound[i]],
            push=push[i],
            pushed=pushed[i],
            happened=tuple(
                each.told
                for each in changed
                if each.row <= i and (each.row > last or time[i] < time[each.row] + lasting)
            ),
        )
        for last, i in zip(before, rows, strict=True)
    ]


def _pushes(log: RunLog) -> tuple[Array, Array]:
    """Forces from outside (n, 3), and where each acts: at c + F x M / F2, M about c."""
    com = np.asarray(log["trajectory/com"], dtype=float)
    if "disturbance/wrench" not in log:
        return np.zeros_like(com), com
    wrench = np.nan_to_num(log["disturbance/wrench"], nan=0.0, posinf=0.0, neginf=0.0)
    force, moment = wrench[:, :3], wrench[:, 3:]
    square = (force**2).sum(axis=1, keepdims=True).clip(LEAST_PUSH**2)
    off = np.cross(force, moment) / square
    return force, com + off.clip(-FARTHEST, FARTHEST)


def _notes(log: RunLog) -> list[str]:
    """The blend in every row; where a stage does not blend its name, if the config tells it."""
    blend = log["trajectory/blend"]
    stage = log["command/stage"] if "command/stage" in log else np.zeros(len(blend), dtype=int)
    named, notes = (
        stage_names(log),
        np.array([f"blend {value:.2f}" for value in blend], dtype=object),
    )
    for number in np.unique(stage).tolist():
        here = stage == number
        if np.ptp(blend[here]) < STEADY:
            notes[here] = named[number] if 0 <= number < len(named) else ""
    return [str(note) for note in notes]


def is_pushed(moment: Moment) -> bool:
    """Whether a force from outside is to be seen."""
    return bool(LEAST_PUSH < np.linalg.norm(moment.push) < np.inf)
