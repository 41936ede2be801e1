"""Kinds of numbers and flags that both physics have."""

from typing import Annotated

import mujoco
from pydantic import Field, Strict

Count = Annotated[int, Strict(), Field(ge=0, le=10_000)]
Some = Annotated[int, Strict(), Field(ge=1, le=10_000)]
Substeps = Annotated[int, Strict(), Field(ge=1, le=1000)]
Capacity = Annotated[int, Strict(), Field(ge=1, le=1024)]


def disable_flag(name: str) -> int:
    """MuJoCo's bit for what is disabled."""
    return int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{name.upper()}"))
