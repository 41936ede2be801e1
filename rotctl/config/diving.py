"""Whether a dive that is newly asked for can come over the edge, and enter as it is to."""

import math

from rotctl.behaviours import BehaviourSettings
from rotctl.behaviours.aerial.launch import Launch
from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.behaviours.staged.settings import StagedSettings
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.mechanics.model import Model
from rotctl.mechanics.terrain import Pool
from rotctl.metrics.criteria.dive import DiveCriteria
from rotctl.metrics.criteria.kinds import ChainCriteria, Criteria
from rotctl.motion import make_pose

ROUNDING = 1e-9  # [-] of a cosine


def require_dive(config: Config, known: Model) -> None:
    """See that a dive comes over the edge, and that its straight pose is in reach.

    Raises:
        InputError: it never comes over the edge, or its straight pose is out of a joint's range.
    """
    _require_straight(config.behaviour, config.criteria, known)
    behaviour, criteria, key = config.behaviour, config.criteria, "behaviour.heading"
    if isinstance(behaviour, ChainSettings) and isinstance(criteria, ChainCriteria):
        part = behaviour.parts[0]  # a later one heads where the feet point by then
        between = ": " if part.said else "."
        behaviour, criteria = part.behaviour, criteria.parts[0]
        key = f"{part.place(0)}{between}{key}"
    ground = config.terrain
    if not isinstance(criteria, DiveCriteria) or not isinstance(ground, Pool):
        return
    if not isinstance(behaviour, StagedSettings) or config.start.aloft:  # it is over it already
        return
    launch = _launch(behaviour)
    if launch is None:
        return
    way = 0.0 if launch.forward > 0.0 else 180.0  # [deg] backward it has its back to the edge
    if math.cos(math.radians(behaviour.heading - way)) < ROUNDING:
        raise InputError(
            f"{key}={behaviour.heading:g}: never comes over the edge of "
            f"terrain={ground.name}, which is towards +x; give less than 90 to either side of "
            f"{way:g}"
        )


def _launch(behaviour: StagedSettings) -> Launch | None:
    """Its last take-off that goes anywhere."""
    aims = [task.aim for stage in behaviour.stages for task in stage.tasks.values()]
    return next((a for a in reversed(aims) if isinstance(a, Launch) and a.forward), None)


def _require_straight(
    behaviour: BehaviourSettings, criteria: Criteria, known: Model, key: str = "criteria"
) -> None:
    if isinstance(criteria, DiveCriteria):
        make_pose(known, criteria.straight, f"{key}.straight")
    if isinstance(behaviour, ChainSettings) and isinstance(criteria, ChainCriteria):
        for number, (part, own) in enumerate(zip(behaviour.parts, criteria.parts, strict=True)):
            place = f"{part.place(number)}: criteria" if part.said else f"{key}.parts.{number}"
            _require_straight(part.behaviour, own, known, place)
