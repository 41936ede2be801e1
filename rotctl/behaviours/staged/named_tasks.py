"""Whether the tasks and stages that laws and conditions name are there, and such as they need."""

from collections.abc import Mapping, Sequence

from rotctl.behaviours.aerial.launch import Launch, Whirl
from rotctl.behaviours.staged.stages import Stage, TaskSettings
from rotctl.behaviours.staged.touching import Launched
from rotctl.behaviours.standing.balance import Capture, Lunge
from rotctl.errors import InputError
from rotctl.settings.complaints import brief

Keyed = Sequence[tuple[str, Stage]]


def require_named_tasks(place: str, keyed: Keyed, common: Mapping[str, TaskSettings]) -> None:
    """See that they are there before a run comes to the stage.

    Args:
        place: where the stages and the common tasks stand, `behaviour`.
        keyed: where each stage stands, and the stage.
        common: tasks that the behaviour has in all stages, by name.

    Raises:
        InputError: one is not.
    """
    flights = [stage.name for _, stage in keyed if stage.flight]
    for key, stage in keyed:
        every = {**common, **stage.tasks}
        for name, task in every.items():
            said, aim = f"{key if name in stage.tasks else place}.tasks.{name}.aim", task.aim
            if isinstance(aim, Lunge):
                _require_task(f"{said}.task", aim.task, every, Capture)
            if isinstance(aim, Whirl):
                _require_task(f"{said}.task", aim.task, every, Launch)
                _require(f"{said}.flight", aim.flight, flights, "stage that flies")
        ends = {"until": stage.until, "otherwise.when": stage.otherwise and stage.otherwise.when}
        for name, end in ends.items():
            if isinstance(end, Launched) and end.turning:
                _require_task(f"{key}.{name}.turning", end.turning, every, Whirl)


def _require_task(key: str, named: str, every: Mapping[str, TaskSettings], law: type) -> None:
    such = [name for name, task in every.items() if isinstance(task.aim, law)]
    _require(key, named, such, f"task of its stage with the aim {law.__name__.lower()}")


def _require(key: str, named: str, valid: Sequence[str], what: str) -> None:
    if named not in valid:
        raise InputError(f"{key}={brief(named)}: no {what}; valid: {', '.join(valid) or 'none'}")
