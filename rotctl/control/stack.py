"""The numbers every form of the optimisation is written with, once per control step.

All objectives but two small ones are rows over the acceleration, 1/2 |R qddot - wanted|^2_W:
contacts, whose velocity should fade, then the tasks of the behaviour. Rows of momenta are kept
apart, as contact forces alone meet them. With M qddot + C = S' tau + J' lambda,

    R qddot = B tau + A lambda + c,    B = R M^-1 S',   A = R M^-1 J',   c = -R M^-1 C.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rotctl.control.contact_rows import along, stopping
from rotctl.control.kinds import KINDS, Rows
from rotctl.control.settings import ContactGains, ControllerSettings, PoseGains
from rotctl.control.task import Command
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import contact_momentum_maps
from rotctl.mechanics.state import State


@dataclass(frozen=True)
class Stack:
    """One control step's problem over m contacts, before it is given a form.

    Attributes:
        contacts: m.
        friction: half-width of the friction pyramid [-].
        period: of the control [s].
        torque_limit: (nu,) [N m].
        joints: degrees of freedom that have motors.
        contact, pose: gains of contacts and poses.
        pose_a, pose_b: (nu,) torques tau_a, tau_b of eq. 7 [N m].
        blend: gamma of the previous step [-].
        rows: (n, nv) R over qddot, first N, T1, T2 of each contact.
        wanted: (n,) what they should give.
        weight: (n,); rows of weight 0 count nowhere.
        blending: (n,) what they should give beside that, times gamma.
        solved: (n, nv) R M^-1.
        drift: (n,) c - wanted.
        maps: (6, 3m) contact forces to rates of [L, H].
        rate_rows: (p, 6) rows over [Ldot, Hdot].
        rate_wanted, rate_weight: (p,) likewise.
        mobility: A (n, 3m) [1/kg for contacts].
        actuation_square: B B' (n, n).
        free_rates: (6,) of [L, H] without contacts: gravity's, and those of the forces from
            outside that control knows of [N, N m].
        frame: (m, 3, 3) the contacts' N, T1, T2, world axes.
        tasks: of the command, and where their rows stand.
    """

    contacts: int
    friction: float
    period: float
    torque_limit: Array
    joints: slice
    contact: ContactGains
    pose: PoseGains
    pose_a: Array
    pose_b: Array
    blend: float
    rows: Array
    wanted: Array
    weight: Array
    blending: Array
    solved: Array
    drift: Array
    maps: Array
    rate_rows: Array
    rate_wanted: Array
    rate_weight: Array
    mobility: Array
    actuation_square: Array
    free_rates: Array
    frame: Array
    tasks: tuple["TaskRows", ...]

    @property
    def jacobian(self) -> Array:
        """J (3m, nv): the contacts' rows."""
        return self.rows[: 3 * self.contacts]

    @cached_property
    def counting(self) -> NDArray[np.int64]:
        """The rows that have a weight."""
        return np.flatnonzero(self.weight > 0)

    @property
    def actuation(self) -> Array:
        """B (n, nu)."""
        return self.solved[:, self.joints]

    @cached_property
    def _push(self) -> Array:
        """The momentum rows over contact forces (p, 3m)."""
        return product(self.rate_rows, self.maps)

    @property
    def momentum_square(self) -> Array:
        """What the momentum rows put on contact forces squared (3m, 3m)."""
        return product(self._push.T * self.rate_weight, self._push)

    @property
    def momentum_pull(self) -> Array:
        """And on contact forces (3m,): towards what is wanted beyond the free rates."""
        miss = self.rate_wanted - product(self.rate_rows, self.free_rates)
        return product(self.rate_weight * miss, self._push)

    @property
    def blend_weight(self) -> float:
        """Weight on the squared change of gamma in one period."""
        difference = self.pose_a - self.pose_b
        moved = self.pose.weight * float(product(difference, difference))
        moved += float(product(self.weight, self.blending * self.blending))
        return self.pose.blend / self.period**2 * max(1.0, moved)

    def subset(self, keep: NDArray[np.bool_]) -> "Stack":
        """The same step over the contacts where `keep` (m,) is True."""
        columns = np.repeat(keep, 3)
        rows = np.concatenate((columns, np.ones(len(self.rows) - len(columns), dtype=bool)))
        return replace(
            self,
            contacts=int(keep.sum()),
            rows=self.rows[rows],
            wanted=self.wanted[rows],
            weight=self.weight[rows],
            blending=self.blending[rows],
            solved=self.solved[rows],
            drift=self.drift[rows],
            maps=self.maps[:, columns],
            # Products over all contacts contain those over a subset.
            mobility=self.mobility[np.ix_(rows, columns)],
            actuation_square=self.actuation_square[np.ix_(rows, rows)],
            frame=self.frame[keep],
        )


@dataclass(frozen=True)
class TaskRows:
    """A task's rows and where they stand: in `rate_rows`, or past the contacts' in `rows`."""

    rows: Rows
    momentum: bool
    first: int


def collect(
    model: Model,
    state: State,
    command: Command,
    settings: ControllerSettings,
    torques: Array,
    blend: float,
    accelerations: Array | None = None,
) -> Stack:
    """The stack over all contacts that are not held out.

    Args:
        torques: (2, nu) pose torques tau_a, tau_b.
        blend: gamma of the previous step.
        accelerations: (2, nu) towards both poses; where they are given, poses are tracked by
            them, as rows after those of the tasks, and the torques only where nothing solves.
    """
    keep = command.candidates(state)
    frame, jacobian = along(model, state, command.forward, keep)
    stop = stopping(model, state, command.contact, settings.rate, frame, jacobian, keep)
    tasks = _evaluate(command, model, state)
    motion = [task.rows for task in tasks if not task.momentum]
    momentum = [task.rows for task in tasks if task.momentum]
    pose, blending = command.pose, np.zeros(len(jacobian) + sum(len(r.wanted) for r in motion))
    if accelerations is not None:
        a, b = accelerations
        weight = np.full(len(a), pose.weight)
        motion = [*motion, Rows(np.eye(model.mj.nv)[model.joints], b, weight, np.zeros(3))]
        pose, blending = replace(pose, weight=0.0), np.concatenate((blending, a - b))
    rows = np.concatenate((jacobian, *(rows.matrix for rows in motion)))
    wanted = np.concatenate((stop, *(rows.wanted for rows in motion)))
    solved = state.solve_mass(model.mj, np.concatenate((rows, state.bias[None])))
    actuation = solved[:-1, model.joints]
    held = np.full(len(jacobian), command.contact.weight)
    return Stack(
        contacts=int(keep.sum()),
        friction=settings.friction,
        period=1.0 / settings.rate,
        torque_limit=model.torque_limit,
        joints=model.joints,
        contact=command.contact,
        pose=pose,
        pose_a=torques[0],
        pose_b=torques[1],
        blend=blend,
        rows=rows,
        wanted=wanted,
        weight=np.concatenate((held, *(rows.weight for rows in motion))),
        blending=blending,
        solved=solved[:-1],
        drift=-product(rows, solved[-1]) - wanted,
        maps=contact_momentum_maps(state.momentum, jacobian),
        rate_rows=np.concatenate((np.zeros((0, 6)), *(rows.matrix for rows in momentum))),
        rate_wanted=np.concatenate((np.zeros(0), *(rows.wanted for rows in momentum))),
        rate_weight=np.concatenate((np.zeros(0), *(rows.weight for rows in momentum))),
        mobility=product(solved[:-1], jacobian.T),
        actuation_square=product(actuation, actuation.T),
        free_rates=_free_rates(model, state, settings.sees_disturbance),
        frame=frame,
        tasks=tasks,
    )


def _free_rates(model: Model, state: State, sees_disturbance: bool) -> Array:
    """Rates of [L, H] (6,) without contacts."""
    rates = np.concatenate((model.mass * model.gravity, np.zeros(3)))
    if sees_disturbance:  # what the bias holds beside gravity and the motion itself
        outside = state.data.qfrc_bias - state.bias
        rates += contact_momentum_maps(state.momentum, outside[None])[:, 0]
    return rates


def _evaluate(command: Command, model: Model, state: State) -> tuple[TaskRows, ...]:
    """Every task's rows, in the order of the command."""
    found, following = [], {True: 0, False: 0}
    kinds = list(KINDS.values())
    for task in command.tasks:
        kind = kinds[task["kind"]]
        rows = kind.rows(task, model, state)
        found.append(TaskRows(rows, kind.momentum, following[kind.momentum]))
        following[kind.momentum] += len(rows.wanted)
    return tuple(found)
