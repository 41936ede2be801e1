"""Behaviours as stages: what is wanted changes when the motion has come so far, not with time.

A stage has poses, tasks with aims, and a condition that ends it; see `staged.aims` and
`staged.conditions`. The last stage goes on. Everything is measured along the behaviour's
forward, left and up; the phase is the excursion about left, [AlBorno2014], or about up.
"""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rotctl.behaviours.aerial import feasibility
from rotctl.behaviours.behaviour import Placement, Signals
from rotctl.behaviours.facing import Frame, frame_of, lying
from rotctl.behaviours.scene import Begin, Scene, Step
from rotctl.behaviours.staged import take_off
from rotctl.behaviours.staged.named_tasks import require_named_tasks
from rotctl.behaviours.staged.posing import OverPhase
from rotctl.behaviours.staged.preparation import pose_law, prepared, task_names
from rotctl.behaviours.staged.stages import mirrored
from rotctl.control import Command, ControllerSettings
from rotctl.control.settings import PoseGains
from rotctl.maths.rotations import advance, rotation_between
from rotctl.mechanics import excursion
from rotctl.mechanics.excursion import Excursion, ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State

if TYPE_CHECKING:  # which makes this one
    from rotctl.behaviours.staged.settings import StagedSettings

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
        law: of the present stage's law of poses.
        step: with a foot.
    """

    stage: int
    begin: Begin
    first: Excursion
    excursion: Excursion
    frame: Frame
    airborne: float = 0.0
    still: float = 0.0
    law: Any = None
    step: Step = Step()


class Staged:
    """A staged behaviour, of one run at a time."""

    def __init__(
        self,
        settings: "StagedSettings",
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
        place: str = "behaviour",
    ) -> None:
        """Prepare the stages.

        Args:
            place: where the settings stand, for messages.

        Raises:
            InputError: a body or a joint is not there, or a task has no gains.
        """
        self._settings, self._model, self._control = settings, model, control
        self._measured, self._period = measured, 1.0 / control.rate
        self._frame = frame_of(settings.roll_about, settings.heading, settings.turn_about)
        self.axes = self._frame.axes
        self._target = math.radians(settings.target_excursion)
        to_left = {"left": 0.0, "up": self._target, "forward": -self._target}
        right = to_left[settings.turn_about] < 0.0
        stages = [take_off.at_speed(stage, settings.take_off) for stage in settings.stages]
        self._stages = tuple(mirrored(s, model) if right else s for s in stages)
        found: dict[str, None] = {}
        keyed = [(f"{place}.stages.{i}", stage) for i, stage in enumerate(self._stages)]
        for key, stage in keyed:
            for name, wanted in (settings.tasks | stage.tasks).items():
                said = f"{key if name in stage.tasks else place}.tasks.{name}"
                found.update(dict.fromkeys(task_names(model, said, name, wanted)))
            if stage.until:
                stage.until.check(model, f"{key}.until")
            if stage.otherwise:
                stage.otherwise.when.check(model, f"{key}.otherwise.when")
        require_named_tasks(place, keyed, settings.tasks)
        self.tasks = tuple(found)
        self._nothing = np.zeros(len(model.joint_names))
        self._parts = [
            prepared(place, key, stage, settings.tasks, self.tasks, self.axes, control, model)
            for key, stage in keyed
        ]
        self._poses = [
            pose_law(key, stage, settings.shape, self._frame, self._target, model)
            for key, stage in keyed
        ]
        self._laws = {s.name: law for s, law in zip(self._stages, self._poses, strict=True)}
        for part in self._parts:
            feasibility.check(
                model, self.axes, self._target, part.aims, self._laws, settings.take_off
            )

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
            begin = _begin(self._model, state, now)
            memory = memory._replace(stage=following, begin=begin, law=None)
            memory = self._lying(memory, state)
            scene = self._scene(memory, state)
        law = self._poses[memory.stage]
        return memory._replace(law=law.advance(memory.law, scene, self._period))

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
        poses, speeds = self._poses[memory.stage].poses(scene, memory.law)
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


def _lag(pose: PoseGains) -> float:
    """How far a pose must be ahead of a motion, for its damper not to brake that [s]."""
    return pose.damping / pose.stiffness + pose.horizon if pose.stiffness else 0.0


def _begin(model: Model, state: State, now: Excursion) -> Begin:
    data = state.data
    com = state.momentum.com
    angles = state.position[model.angles].copy()
    return Begin(state.time, com, data.xpos.copy(), data.xquat.copy(), angles, now)
