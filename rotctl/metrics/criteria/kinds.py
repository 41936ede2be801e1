"""The kinds of criteria, one for each class of motion, and the columns that they measure."""

from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics import appearance, disturbed, pace, peaks
from rotctl.metrics import halts as told_to
from rotctl.metrics.criteria import (
    acrobatic,
    chain,
    dive,
    finish,
    flip,
    getting_up,
    one_foot,
    orientation,
    rolling,
    standing,
)
from rotctl.metrics.criteria.acrobatic import AcrobaticCriteria
from rotctl.metrics.criteria.dive import DiveCriteria
from rotctl.metrics.criteria.finish import FinishCriteria
from rotctl.metrics.criteria.flip import FlipCriteria
from rotctl.metrics.criteria.getting_up import GettingUpCriteria
from rotctl.metrics.criteria.one_foot import OneFootCriteria
from rotctl.metrics.criteria.orientation import OrientationCriteria
from rotctl.metrics.criteria.rolling import RollingCriteria
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.settings.fields import MOST_PARTS, STRICT

Single = Annotated[
    AcrobaticCriteria
    | DiveCriteria
    | FinishCriteria
    | FlipCriteria
    | GettingUpCriteria
    | OneFootCriteria
    | OrientationCriteria
    | RollingCriteria
    | StandingCriteria,
    Field(discriminator="kind"),
]


@validated(frozen=True, config=STRICT)
class ChainCriteria:
    """Each part of a chain by criteria of its own; see `conf/criteria/chain.yaml`."""

    name: str
    kind: Literal["chain"]
    parts: Annotated[tuple[Single, ...], Field(max_length=MOST_PARTS)] = ()
    description: str = ""


Criteria = Annotated[Single | ChainCriteria, Field(discriminator="kind")]
KINDS = (
    rolling,
    appearance,
    pace,
    told_to,
    standing,
    orientation,
    flip,
    dive,
    peaks,
    finish,
    acrobatic,
    getting_up,
    one_foot,
    chain,
    disturbed,
)
COLUMNS = {column.name: column for kind in KINDS for column in kind.COLUMNS}


def settling(criteria: Criteria) -> float:
    """What mean speeds of a roll leave out at its start [s]; 0 of what has none."""
    roll = criteria.roll if isinstance(criteria, FinishCriteria) else criteria
    return roll.settle if isinstance(roll, RollingCriteria) else 0.0
