"""What a stage of a behaviour says: its tasks with their aims, its poses, and what ends it."""

from collections.abc import Iterable, Mapping
from dataclasses import field, fields, replace
from typing import Any

from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.flight_settings import FlightSettings
from rotctl.behaviours.facing import Lying
from rotctl.behaviours.staged.aims import SERVES, Aim
from rotctl.behaviours.staged.conditions import Leaves, Turned, Until
from rotctl.behaviours.staged.following import RiseSettings, TurnSettings
from rotctl.behaviours.staged.gliding import GlideSettings, ReachSettings
from rotctl.behaviours.staged.posing import Beyond
from rotctl.behaviours.standing.stepping import Stepping
from rotctl.control.kinds import KINDS
from rotctl.control.supervisor import SupervisorName
from rotctl.mechanics.model import Model
from rotctl.motion import Angle, Poses
from rotctl.motion.sides import exchanged, mirrored_angles, other_side
from rotctl.settings.fields import SPARSE, STRICT, Finite, Names, NonNegative, Vector
from rotctl.suggestion import instead


@validated(frozen=True, config=STRICT)
class TaskSettings:
    """One task of a stage.

    Attributes:
        kind: see `rotctl.control.kinds`.
        aim: what it aims at; none for `limits`.
        body: that it is about; a name without a side stands for a task on both sides.
        point: of the body, in its frame [m]; for `limits` the margin is its first.
        gains: name of the controller's gains; those of the task's own name, if empty.
    """

    kind: str
    aim: Aim | None = None
    body: str = ""
    point: Vector = (0.0, 0.0, 0.0)
    gains: str = ""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"no kind {self.kind!r}; {instead(self.kind, KINDS)}")
        if (self.aim is None) != (self.kind == "limits"):
            raise ValueError(f"a task of kind {self.kind} has {'no' if self.aim else 'an'} aim")
        if bool(self.body) != (self.kind in ("point", "attitude", "joints")):
            raise ValueError(f"a task of kind {self.kind} has {'no' if self.body else 'a'} body")
        if self.aim and self.kind not in (kinds := SERVES[type(self.aim)]):
            raise ValueError(
                f"the aim {self.aim.law} is for tasks of kind {' or '.join(kinds)}, not {self.kind}"
            )
        if self.point != (0.0, 0.0, 0.0) and self.kind not in ("point", "limits"):
            raise ValueError(f"a task of kind {self.kind} has no point")
        if any(self.point[1:]) and self.kind == "limits":
            raise ValueError("of the point of a task of kind limits the first acts alone")


@validated(frozen=True, config=STRICT)
class Otherwise:
    """Where a stage goes when it comes to nothing.

    Attributes:
        when: it has come to nothing.
        stage: name of the one that begins then.
    """

    when: Until
    stage: str


@validated(frozen=True, config=STRICT)
class Stage:
    """One part of a behaviour.

    Attributes:
        poses: key poses over the phase; or in their place
        rise: poses over the height of the centre of mass, or
        turn: over how far it has turned, or
        glide: over time, or
        reach: a pose that is reached in a time, or
        flight: poses that bring the body to its landing, see `rotctl.behaviours.aerial.flight`.
        tasks: by name, beside those of every stage.
        until: what ends it; nothing for the last stage alone.
        otherwise: what ends it before that, and where it goes on then.
        supervisor: in place of the controller's.
        pose: name of the controller's pose gains in place of its usual ones.
        contact: name of its gains of contacts, likewise.
        lead: poses are looked up so far ahead of the phase, at most at the target [rad].
        beyond: how they go on beyond the target, no further ahead than `lead`; not, if None.
        held_out: bodies whose contacts control may not use;
        toes: of which it may use those in front of their middle alone, so that heels can rise.
        lying: the way, left and phase are from here on those of how the body lies as the stage
            begins; see `rotctl.behaviours.facing.Lying`.
        to: phase that is the target of this stage, in place of the behaviour's; whichever way is
            nearer [deg].
    """

    name: str
    poses: Poses | None = None
    rise: RiseSettings | None = None
    turn: TurnSettings | None = None
    glide: GlideSettings | None = None
    reach: ReachSettings | None = None
    flight: FlightSettings | None = None
    tasks: dict[str, TaskSettings] = field(default_factory=dict)
    until: Until | None = None
    otherwise: Otherwise | None = None
    supervisor: SupervisorName | None = None
    pose: str = ""
    contact: str = ""
    lead: NonNegative = 0.0
    beyond: Beyond | None = field(default=None, metadata=SPARSE)
    held_out: Names = ()
    toes: Names = ()
    lying: Lying | None = None
    to: Finite | None = None

    def __post_init__(self) -> None:
        laws = (self.poses, self.rise, self.turn, self.glide, self.reach, self.flight)
        given = sum(law is not None for law in laws)
        if given != 1:
            raise ValueError(
                f"the stage {self.name!r} must have one of poses, rise, turn, glide, reach and "
                f"flight, not {given}"
            )
        if self.beyond and not (self.poses and self.lead):
            raise ValueError(
                f"beyond: the stage {self.name!r} must have poses and a lead, which is how far "
                "ahead they go"
            )
        if self.lead and not (self.poses and _vary(self.poses)):
            raise ValueError(
                f"lead={self.lead:g}: the stage {self.name!r} has no poses that vary over the phase"
            )


def _vary(poses: Poses) -> bool:
    """Whether key poses are others at other phases."""
    angles = [*poses.a.values(), *(poses.b or {}).values()]
    return any(isinstance(angle, tuple) and any(angle[1:]) for angle in angles)


def kinds_of(tasks: Mapping[str, TaskSettings], stages: Iterable[Stage]) -> dict[str, str]:
    """Kinds of the tasks of all stages and of each, by the names of their gains."""
    every = [tasks, *(stage.tasks for stage in stages)]
    return {task.gains or name: task.kind for some in every for name, task in some.items()}


def mirrored(stage: Stage, model: Model) -> Stage:
    """The same with the mirror images of its poses and bodies, for a turn the other way."""
    poses, rise, turn, flight = stage.poses, stage.rise, stage.turn, stage.flight
    glide, reach = stage.glide, stage.reach
    if poses:
        other = None if poses.b is None else _over_phase(model, poses.b)
        poses = Poses(_over_phase(model, poses.a), other)
    if rise:
        start, end = mirrored_angles(model, rise.start), mirrored_angles(model, rise.end)
        rise = replace(rise, start=start, end=end, parts=exchanged(rise.parts))
    if turn:
        start, end = mirrored_angles(model, turn.start), mirrored_angles(model, turn.end)
        first, last = turn.angles
        turn = replace(turn, start=start, end=end, angles=(-first, -last))
    if glide:
        start, end = mirrored_angles(model, glide.start), mirrored_angles(model, glide.end)
        glide = replace(glide, start=start, end=end)
    if reach:
        reach = replace(reach, pose=mirrored_angles(model, reach.pose))
    if flight:
        tuck, stretch = (mirrored_angles(model, a) for a in (flight.tuck, flight.stretch))
        shapes = {name: mirrored_angles(model, a) for name, a in flight.shapes.items()}
        flight = replace(flight, tuck=tuck, stretch=stretch, shapes=shapes)
        if flight.midway:
            pose = mirrored_angles(model, flight.midway.pose)
            flight = replace(flight, midway=replace(flight.midway, pose=pose))
        if flight.entry:
            pose = mirrored_angles(model, flight.entry.pose)
            flight = replace(flight, entry=replace(flight.entry, pose=pose))
        if flight.feet:
            pose = mirrored_angles(model, flight.feet.pose)
            flight = replace(flight, feet=replace(flight.feet, pose=pose))
    return replace(
        stage,
        poses=poses,
        rise=rise,
        turn=turn,
        glide=glide,
        reach=reach,
        flight=flight,
        tasks={name: _of_other_side(task) for name, task in stage.tasks.items()},
        until=stage.until and _of_other_side(stage.until),
        otherwise=stage.otherwise and _of_other_side(stage.otherwise),
        held_out=tuple(map(other_side, stage.held_out)),
        toes=tuple(map(other_side, stage.toes)),
    )


def _of_other_side(said: Any) -> Any:
    """What is said of bodies, said of their mirror images.

    Steps are of a left foot and a right one, whatever turns.
    """
    if isinstance(said, Stepping):
        return said
    changed: dict[str, object] = {}
    for named in fields(said):
        value = getattr(said, named.name)
        if named.name in ("body", "beyond"):
            changed[named.name] = other_side(value)
        elif named.name in ("bodies", "hands"):
            changed[named.name] = tuple(map(other_side, value))
        elif named.name == "angle" and value is not None and isinstance(said, Turned | Leaves):
            changed[named.name] = -value
        elif named.name == "point" and getattr(said, "kind", "") != "limits":  # no margin
            x, y, z = value
            changed[named.name] = (x, -y, z)
        elif named.name in ("aim", "when") and value is not None:
            changed[named.name] = _of_other_side(value)
    return replace(said, **changed)


def _over_phase(model: Model, pose: Mapping[str, Angle]) -> dict[str, Angle]:
    """A pose over a phase that runs the other way."""
    full = {name: a if isinstance(a, tuple) else (a, 0.0, 0.0) for name, a in pose.items()}
    signs = mirrored_angles(model, dict.fromkeys(full, 1.0))
    return {
        name: tuple(
            sign * (-wave if i and i % 2 == 0 else wave)  # sines turn round
            for i, wave in enumerate(full[other_side(name)])
        )
        for name, sign in signs.items()
    }
