"""Every part of a log's content moves its hash; nothing else does."""

import numpy as np
import pytest

from rotctl.log import TrajectoryBuffer
from rotctl.log.digest import content_sha256, simulated
from rotctl.log.schema import ATTRIBUTES, SCHEMA

PLAIN = {int: 1, str: "x", bool: True, float: 1.0}
ATTRIBUTE_VALUES = {name: PLAIN[kind] for name, kind in ATTRIBUTES.items()}


def arrays():
    buffer = TrajectoryBuffer.allocate(steps=2, nq=3, nv=3, nu=3, capacity=1, tasks=2, bodies=2)
    buffer.add_event(0.0, "start")
    return {**buffer.arrays(), "model/mjcf": np.array(b"<mujoco/>")}


def of(some, attributes=ATTRIBUTE_VALUES):
    return content_sha256(simulated(some), attributes)


@pytest.mark.parametrize("name", SCHEMA)
def test_every_dataset_counts(name):
    changed = arrays()
    kind = changed[name].dtype
    one = np.array(b"x", kind) if kind.kind == "S" else np.ones((), kind)
    changed[name] = np.full_like(changed[name], one)
    if kind.kind not in "Sb":
        changed[name] += arrays()[name]
    assert of(changed) != content_sha256(simulated(arrays()), ATTRIBUTE_VALUES)


@pytest.mark.parametrize("name", ATTRIBUTES)
def test_every_attribute_counts_but_the_hash_and_the_end_mark(name):
    changed = {**ATTRIBUTE_VALUES, name: 2}
    same = of(arrays(), changed) == content_sha256(simulated(arrays()), ATTRIBUTE_VALUES)
    assert same == (name in ("content_sha256", "complete"))


def test_the_shape_counts():
    changed = arrays()
    changed["trajectory/qpos"] = changed["trajectory/qpos"].reshape(3, 2)
    assert of(changed) != content_sha256(simulated(arrays()), ATTRIBUTE_VALUES)
