"""Behaviours as stages: what is wanted changes when the motion has come so far, not with time.

A stage has poses, tasks with aims, and a condition that ends it; see `rotctl.behaviours.aims` and
`rotctl.behaviours.until`. The last stage goes on. Everything is measured along the behaviour's
forward, left and up; the phase is the excursion about left, [AlBorno2014], or about up.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rotctl.behaviours import possible, take_off
from rotctl.behaviours.aims import Aim
from rotctl.behaviours.behaviour import (
    Placement,
    Signals,
    contact_gains_of,
    gains_of,
    pose_gains_of,
)
from rotctl.behaviours.facing import Frame, frame_of, lying
from rotctl.behaviours.flight import Aloft, Flight
from rotctl.behaviours.posing import OverPhase, PoseLaw
from rotctl.behaviours.scene import Begin, Scene, Step
from rotctl.behaviours.stages import Stage, TaskSettings, mirrored
from rotctl.behaviours.stepping import Stepping
from rotctl.control import Command, ControllerSettings
from rotctl.control.kinds import kind
from rotctl.control.settings import ContactGains, PoseGains
from rotctl.control.task import TASK, Tasks, task
from rotctl.errors import InputError
from rotctl.mechanics import excursion
from rotctl.mechanics.bodies import SIDES, body_ids
from rotctl.mechanics.excursion import Excursion, ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.motion import make_pose_pair
from rotctl.rotations import Array, advance, rotation_between

if TYPE_CHECKING:  # which makes this one
    from rotctl.behaviours.staged_settings import StagedSettings

SLOW = 0.5  # [m/s, rad/s] the fastest that something still may move


class StagedMemory(NamedTuple):
    """What a staged behaviour remembers from one control step to the next.

    Attributes:
        stage: its number.
        begin: of that stage.
        first: excursion at the start of the run, or of the frame.
        excursion: now.
        frame: of the way.
        airborne, still: for how long [s].
        aloft: of the present stage's flight.
        step: with a foot.
    """

    stage: int
    begin: Begin
    first: Excursion
    excursion: Excursion
    frame: Frame
    airborne: float = 0.0
    still: float = 0.0
    aloft: Aloft | None = None
    step: Step = Step()


@dataclass(frozen=True)
class _Part:
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


class Staged:
    """A staged behaviour, of one run at a time."""

    def __init__(
        self,
        settings: "StagedSettings",
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
    ) -> None:
        """Prepare the stages.

        Raises:
            InputError: a body or a joint is not there, or a task has no gains.
        """
        self._settings, self._model, self._control = settings, model, control
        if measured.measure == "clock":
            raise InputError(
                f"excursion=clock: looks poses up by time, which behaviour={settings.name}, "
                "a list of stages, does not; choose excursion=oriented"
            )
        self._measured, self._period = measured, 1.0 / control.rate
        self._frame = frame_of(settings.roll_about, settings.heading, settings.turn_about)
        self.axes = self._frame.axes
        self._target = math.radians(settings.target_excursion)
        to_left = {"left": 0.0, "up": self._target, "forward": -self._target}
        right = to_left[settings.turn_about] < 0.0
        stages = [take_off.at_speed(stage, settings.take_off) for stage in settings.stages]
        self._stages = tuple(mirrored(s, model) if right else s for s in stages)
        found: dict[str, None] = {}
        for stage in self._stages:
            for name, wanted in (settings.tasks | stage.tasks).items():
                found.update(dict.fromkeys(_names(model, name, wanted)))
            if stage.until:
                stage.until.check(model)
            if stage.otherwise:
                stage.otherwise.when.check(model)
        self.tasks = tuple(found)
        self._nothing = np.zeros(len(model.joint_names))
        self._parts = [self._part(stage) for stage in self._stages]
        self._poses = [self._law(stage) for stage in self._stages]
        self._laws = {s.name: law for s, law in zip(self._stages, self._poses, strict=True)}
        for part in self._parts:
            possible.check(model, self.axes, self._target, part.aims, self._laws, settings.take_off)

    def _part(self, stage: Stage) -> _Part:
        model = self._model
        rows: list[Tasks] = []
        filled: list[tuple[int, str, Aim]] = []
        slots: list[int] = []
        every = self._settings.tasks | stage.tasks
        named = {name: wanted.gains or name for name, wanted in every.items()}
        gains = gains_of(self._control, tuple(named.values()))
        for name, wanted in every.items():
            key = f"behaviour.stages.{stage.name}.tasks.{name}.body"
            bodies = body_ids(model.mj, [wanted.body], key) if wanted.body else [0]
            for body, slot in zip(bodies, _names(model, name, wanted), strict=True):
                if wanted.aim:
                    wanted.aim.check(model)
                    filled.append((len(rows), wanted.kind, wanted.aim))
                number = kind(wanted.kind).number
                rows.append(task(number, gains[named[name]], self.axes, body, wanted.point))
                slots.append(self.tasks.index(slot))
        held_out = model.excluded.copy()
        held_out[body_ids(model.mj, stage.held_out, f"behaviour.stages.{stage.name}.held_out")] = 1
        tasks = np.concatenate([np.zeros(0, TASK), *rows])
        fillers = [(tasks[row], kind_name, aim) for row, kind_name, aim in filled]
        aims = {name: wanted.aim for name, wanted in every.items() if wanted.aim}
        pose = pose_gains_of(self._control, stage.pose)
        contact = contact_gains_of(self._control, stage.contact)
        stepping = next((aim for aim in aims.values() if isinstance(aim, Stepping)), None)
        behind = self._behind(stage)
        return _Part(
            tasks, fillers, slots, held_out, behind, pose, contact, aims, stepping, tasks.copy()
        )

    def _behind(self, stage: Stage) -> Array | None:
        """What of each body (nbody,) may only be used where it stands on its front."""
        if not stage.toes:
            return None
        mj, key = self._model.mj, f"behaviour.stages.{stage.name}.toes"
        behind = np.full(mj.nbody, -np.inf)
        for body in body_ids(mj, stage.toes, key):
            solid = (mj.geom_bodyid == body) & (mj.geom_contype > 0)
            behind[body] = mj.geom_pos[solid, 0].mean()
        return behind

    def _law(self, stage: Stage) -> PoseLaw:
        key = f"behaviour.stages.{stage.name}"
        if stage.flight:
            flies, shape = stage.flight, self._settings.shape
            key = f"{key}.flight"
            return Flight(flies, self._model, self._frame, self._target, key, shape)
        if stage.rise:
            return stage.rise.make(self._model, f"{key}.rise")
        if stage.turn:
            return stage.turn.make(self._model, f"{key}.turn")
        if stage.glide:
            return stage.glide.make(self._model, f"{key}.glide")
        if stage.reach:
            return stage.reach.make(self._model, f"{key}.reach")
        assert stage.poses  # one of the six is there
        return OverPhase(make_pose_pair(self._model, stage.poses, f"{key}.poses"), stage.lead)

    def start(self, pitch: float) -> Placement:
        """How a run starts at a pitch [rad] about what it turns about."""
        tilt, first = pitch * self._frame.turning, self._poses[0]
        assert isinstance(first, OverPhase)  # as the settings ask for
        return Placement(advance(self._frame.orientation, tilt), first.pair.start(pitch))

    def begin(self, pitch: float, state: State) -> StagedMemory:
        """Memory at the start."""
        for part in self._parts:
            part.tasks[:] = part.fresh
        first = excursion.start(pitch, self._frame.turning)
        memory = StagedMemory(0, _begin(self._model, state, first), first, first, self._frame)
        return self._lying(memory, state)

    def advance(self, before: StagedMemory, state: State) -> StagedMemory:
        """Memory now, and the next stage where the present one's condition is met."""
        measured = self._measured
        now = excursion.integrate(
            before.excursion,
            state.momentum.angular_velocity,
            before.frame.axis(state.trunk_axes),
            before.frame.turning,
            self._period,
            measured.correction_time,
        )
        turned = before.frame.turned(state.trunk_axes)
        now = excursion.keep_phase(now, turned, self._period, measured.phase_time)
        slow = float(np.abs(state.velocity).max()) < SLOW
        airborne = 0.0 if state.contacts.count else before.airborne + self._period
        still = before.still + self._period if slow else 0.0
        memory = before._replace(excursion=now, airborne=airborne, still=still)
        stepping = self._parts[memory.stage].stepping
        scene = self._scene(memory, state)
        memory = memory._replace(step=stepping.next(scene) if stepping else Step())
        scene = scene._replace(step=memory.step)
        following = self._following(memory.stage, scene)
        if following is not None:
            memory = memory._replace(
                stage=following, begin=_begin(self._model, state, now), aloft=None
            )
            memory = self._lying(memory, state)
            scene = self._scene(memory, state)
        law = self._poses[memory.stage]
        return memory._replace(aloft=law.advance(memory.aloft, scene, self._period))

    def at_last(self, memory: StagedMemory) -> bool:
        """Whether it is in its last stage."""
        return memory.stage + 1 == len(self._stages)

    def over(self, memory: StagedMemory, state: State) -> bool | None:
        """Whether the condition of its last stage is met, for what follows; None without one."""
        until = self._stages[-1].until
        if until is None:
            return None
        return self.at_last(memory) and until.met(self._scene(memory, state))

    def _following(self, number: int, scene: Scene) -> int | None:
        """The stage that begins now, if one does."""
        stage, last = self._stages[number], number + 1 == len(self._parts)
        if not last and stage.until is not None and stage.until.met(scene):
            return number + 1
        if stage.otherwise and stage.otherwise.when.met(scene):
            return [one.name for one in self._stages].index(stage.otherwise.stage)
        return None

    def _lying(self, memory: StagedMemory, state: State) -> StagedMemory:
        """The same, in the frame that the stage which begins asks for."""
        how = self._stages[memory.stage].lying
        if how is None:
            return memory
        frame = lying(how, state.trunk_axes)
        first = excursion.start(frame.turned(state.trunk_axes), frame.turning)
        axis = frame.axis(state.trunk_axes)
        tilt = np.array(rotation_between(frame.turning.tolist(), axis.tolist()))
        first = first._replace(orientation=advance(first.orientation, tilt))
        begin = _begin(self._model, state, first)
        return memory._replace(frame=frame, excursion=first, first=first, begin=begin)

    def command(self, memory: StagedMemory, state: State) -> Command:
        """What the present stage wants at this instant."""
        part, stage = self._parts[memory.stage], self._stages[memory.stage]
        scene = self._scene(memory, state)
        poses, speeds = self._poses[memory.stage].poses(scene, memory.aloft)
        scene = scene._replace(pose=poses[0], speed=speeds[0])
        part.tasks["weight"] = part.fresh["weight"]
        part.tasks["axes"] = memory.frame.axes
        for row, kind_name, aim in part.fillers:
            aim.fill(row, kind_name, scene)
        held_out = part.held_out.copy()
        held_out[memory.step.swing] = True  # where none swings, the world's
        pose_a, pose_b = poses + _lag(part.pose) * speeds
        return Command(
            tasks=part.tasks,
            pose_a=pose_a,
            pose_b=pose_b,
            forward=memory.frame.axes[0],
            pose=part.pose,
            contact=part.contact,
            supervisor=stage.supervisor or self._control.supervisor,
            thresholds=self._control.thresholds,
            held_out=held_out,
            behind=part.behind,
            slots=part.slots,
        )

    def signals(self, memory: StagedMemory, state: State) -> Signals:
        """What the log keeps of it."""
        now = memory.excursion
        frame = memory.frame
        axis = frame.axis(state.trunk_axes)
        return Signals(now.angle, now.phase, axis, frame.axes, memory.stage)

    def _scene(self, memory: StagedMemory, state: State) -> Scene:
        return Scene(
            model=self._model,
            state=state,
            axes=memory.frame.axes,
            turning=memory.frame.turning,
            excursion=memory.excursion,
            measure=self._measured.measure,
            begin=memory.begin,
            first=memory.first,
            aims=self._parts[memory.stage].aims,
            laws=self._laws,
            pose=self._nothing,
            speed=self._nothing,
            target=self._goal(memory),
            turned=memory.excursion.phase - memory.first.phase,
            airborne=memory.airborne,
            still=memory.still,
            step=memory.step,
        )

    def _goal(self, memory: StagedMemory) -> float:
        """In-plane excursion that the stage is to reach, since the start [rad]."""
        to = self._stages[memory.stage].to
        if to is None:
            return self._target
        phase, first = memory.excursion.phase, memory.first.phase
        return phase - first + (math.radians(to) - phase + math.pi) % math.tau - math.pi


def _names(model: Model, name: str, wanted: TaskSettings) -> list[str]:
    """A task's names: one for each side where its body stands for both."""
    both = wanted.body and len(body_ids(model.mj, [wanted.body], f"tasks.{name}.body")) == 2
    return [name + side for side in SIDES] if both else [name]


def _lag(pose: PoseGains) -> float:
    """How far a pose must be ahead of a motion, for its damper not to brake that [s]."""
    return pose.damping / pose.stiffness + pose.horizon if pose.stiffness else 0.0


def _begin(model: Model, state: State, now: Excursion) -> Begin:
    data = state.data
    com = state.momentum.com
    angles = state.position[model.angles].copy()
    return Begin(state.time, com, data.xpos.copy(), data.xquat.copy(), angles, now)
