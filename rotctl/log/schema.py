"""What a run's log contains: every dataset and every root attribute.

State at row ``i`` is the state that the controller saw at ``time[i]``; ``ctrl`` row ``i`` is the
torque held from ``time[i]`` on. Everything is SI, in world axes, about the centre of mass.
"""

from dataclasses import dataclass

SCHEMA_VERSION = 4
OLDEST_READ = 2

MODEL_PATH = "model/mjcf"
EVENT_BYTES = 200
MAX_TOTAL_BYTES = 2 * 2**30
# Dimensions of a size that is always the same; what is along them is `LABELS`.
CONSTANTS = {"xyz": 3, "axis": 3, "row": 3, "part": 4, "force_moment": 6}
LOG_NAME = "run.h5"  # in a folder that the run id names


@dataclass(frozen=True)
class DatasetSpec:
    """One dataset of the log.

    Attributes:
        dtype: NumPy type string; plain ``"S"`` stands for bytes of any one fixed length.
        shape: dimensions, each of `CONSTANTS` or one of ``steps``, ``nq``, ``nv``, ``nu``,
            ``capacity``, ``events``, ``tasks``, ``bodies``.
        unit: SI unit; ``"1"`` where there is none.
        description: one line for the reader of the file.
        fill: value of the rows and slots that nobody has written.
        since: schema version that brought it.
    """

    dtype: str
    shape: tuple[str, ...]
    unit: str
    description: str
    fill: int = 0
    since: int = OLDEST_READ


def _per_step(unit: str, description: str, *row: str, since: int = OLDEST_READ) -> DatasetSpec:
    return DatasetSpec("<f8", ("steps", *row), unit, description, since=since)


def _per_contact(unit: str, description: str) -> DatasetSpec:
    return DatasetSpec("<f4", ("steps", "capacity", "xyz"), unit, description)


def _per_task(unit: str, description: str, *row: str) -> DatasetSpec:
    return DatasetSpec("<f8", ("steps", "tasks", *row), unit, description, since=3)


_SLOTS = ("steps", "capacity")

SCHEMA: dict[str, DatasetSpec] = {
    "trajectory/time": _per_step("s", "simulated time at which the controller saw this row"),
    "trajectory/qpos": _per_step("m, rad, quaternion", "generalised positions, MuJoCo order", "nq"),
    "trajectory/qvel": _per_step("m/s, rad/s", "generalised velocities, MuJoCo order", "nv"),
    "trajectory/ctrl": _per_step("N m", "joint torques held from this row's time on", "nu"),
    "trajectory/com": _per_step("m", "centre of mass", "xyz"),
    "trajectory/ground_height": _per_step(
        "m", "height of the ground below the centre of mass", since=3
    ),
    "trajectory/com_velocity": _per_step("m/s", "velocity of the centre of mass", "xyz"),
    "trajectory/linear_momentum": _per_step("kg m/s", "linear momentum L", "xyz"),
    "trajectory/angular_momentum": _per_step(
        "kg m2/s", "angular momentum H about the centre of mass", "xyz"
    ),
    "trajectory/angular_velocity": _per_step(
        "rad/s", "whole-body angular velocity, I_c^-1 H with I_c the composite inertia", "xyz"
    ),
    "trajectory/angular_excursion": _per_step(
        "rad", "angular excursion: integral of the whole-body angular velocity", "xyz"
    ),
    "trajectory/linear_momentum_rate_desired": _per_step(
        "N", "rate of L that was asked for", "xyz"
    ),
    "trajectory/linear_momentum_rate_predicted": _per_step(
        "N", "rate of L that the controller's solution predicts", "xyz"
    ),
    "trajectory/angular_momentum_rate_desired": _per_step(
        "N m", "rate of H that was asked for", "xyz"
    ),
    "trajectory/angular_momentum_rate_predicted": _per_step(
        "N m", "rate of H that the controller's solution predicts", "xyz"
    ),
    "trajectory/blend": _per_step("1", "weight between the torques of the two pose objectives"),
    "trajectory/phase": _per_step("rad", "phase angle of the behaviour"),
    "trajectory/trunk_axis": _per_step(
        "1", "the trunk's mean axis that it rolls about, unit", "xyz"
    ),
    "trajectory/trunk_axes": _per_step(
        "1",
        "the trunk's mean front, left and up as columns, each unit, world",
        "xyz",
        "axis",
        since=3,
    ),
    "command/axes": _per_step(
        "1", "the behaviour's forward, left and up as rows, world", "axis", "xyz", since=3
    ),
    "command/stage": DatasetSpec(
        "<i4", ("steps",), "1", "number of the behaviour's stage", since=3
    ),
    "command/target": _per_task("m, rad", "of each task, see its kind; world axes", "part"),
    "command/velocity": _per_task("m/s, rad/s", "that each task asks for; world axes", "xyz"),
    "command/error": _per_task("m, rad", "to the target, along the task's axes", "row"),
    "command/wanted": _per_task(
        "N, N m, m/s2, rad/s2", "what the task's rows should give, along its axes", "row"
    ),
    "command/predicted": _per_task(
        "N, N m, m/s2, rad/s2", "what the controller's solution gives them", "row"
    ),
    "contacts/count": DatasetSpec(
        "<i4", ("steps",), "1", "contacts that the controller saw; may exceed the recorded capacity"
    ),
    "contacts/body": DatasetSpec(
        "<i4",
        _SLOTS,
        "1",
        "MuJoCo body id, -1 where empty; after the contacts that the controller saw, those that "
        "came within the control step (schema 2: none)",
        fill=-1,
    ),
    "contacts/position": _per_contact("m", "contact point, where the contact begins"),
    "contacts/normal": _per_contact("1", "contact normal, out of the ground, unit vector"),
    "contacts/force_predicted": _per_contact("N", "contact force in the controller's solution"),
    "contacts/force_realised": _per_contact(
        "N", "mean contact force over the control step (schema 2: in its first physics step)"
    ),
    "contacts/force_peak": DatasetSpec(
        "<f4", _SLOTS, "N", "largest contact force in a physics step of the control step", since=3
    ),
    "contacts/used": DatasetSpec("?", _SLOTS, "1", "contact kept by the supervisor"),
    "contacts/ground_force": _per_step(
        "N",
        "mean over the control step of the ground's whole force on the character",
        "xyz",
        since=3,
    ),
    "contacts/ground_force_peak": _per_step(
        "N", "largest whole ground force in a physics step of the control step", since=3
    ),
    "contacts/penetration": _per_step(
        "m", "deepest overlap with the ground in a physics step of the control step", since=3
    ),
    "disturbance/wrench": _per_step(
        "N, N m", "force and moment from outside about the centre of mass", "force_moment", since=3
    ),
    "solver/status": DatasetSpec(
        "i1",
        ("steps",),
        "1",
        "0 solved, 1 solved by a fallback, 2 all solvers failed and the pose torque was used",
    ),
    "solver/iterations": DatasetSpec(
        "<i4", ("steps",), "1", "iterations, 0 where the solver does not tell"
    ),
    "solver/residual": _per_step("1", "largest residual of the solution, in the solver's scaling"),
    "solver/fallback": DatasetSpec(
        "i1", ("steps",), "1", "link of the chain that gave the torque, 0 = the chosen solver"
    ),
    "events/time": DatasetSpec("<f8", ("events",), "s", "simulated time of the event"),
    "events/text": DatasetSpec(f"S{EVENT_BYTES}", ("events",), "text", "what happened, UTF-8"),
    "model/joint": DatasetSpec("S64", ("nu",), "text", "name of each actuated joint, UTF-8"),
    "model/body": DatasetSpec("S64", ("bodies",), "text", "name of each body, UTF-8", since=3),
    "model/task": DatasetSpec("S64", ("tasks",), "text", "name of each task, UTF-8", since=3),
    "model/torque_limit": DatasetSpec("<f8", ("nu",), "N m", "largest torque of each joint"),
    MODEL_PATH: DatasetSpec("S", (), "text", "self-contained MJCF of the simulated model, UTF-8"),
}

GROUPS = tuple(dict.fromkeys(name.partition("/")[0] for name in SCHEMA))

ATTRIBUTES: dict[str, type] = {
    "schema_version": int,
    "config": str,  # YAML
    "run_id": str,
    "seed": int,
    "versions": str,  # JSON
    "git_commit": str,
    "git_dirty": bool,
    "machine": str,  # JSON
    "wall_time": float,  # [s]
    "outcome": str,  # JSON, the summary row
    "content_sha256": str,
    "complete": bool,
}
WRITER_ATTRIBUTES = ("schema_version", "content_sha256", "complete")


def names_of(version: int) -> tuple[str, ...]:
    """The datasets that a log of that schema version has, in the order of ``SCHEMA``."""
    return tuple(name for name, spec in SCHEMA.items() if spec.since <= version)
