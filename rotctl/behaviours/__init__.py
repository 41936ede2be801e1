"""Classes of motion: each a kind of settings that makes the behaviour of one run."""

from typing import Annotated

from pydantic import Field

from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.staged.settings import StagedSettings

BehaviourSettings = Annotated[
    RollingSettings | StagedSettings | ChainSettings, Field(discriminator="kind")
]

__all__ = ["BehaviourSettings"]
