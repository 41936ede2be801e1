"""The buffer follows the schema, and its rows are plain arrays."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.log import SCHEMA, TrajectoryBuffer
from rotctl.log.buffer import whole_letters
from rotctl.log.schema import CONSTANTS

SIZES = {"steps": 7, "nq": 5, "nv": 4, "nu": 3, "capacity": 2, "tasks": 2, "bodies": 2}


def test_every_array_has_the_schema_s_type_and_shape():
    arrays = TrajectoryBuffer.allocate(**SIZES).arrays()
    assert list(arrays) == [name for name in SCHEMA if name != "model/mjcf"]
    for name, array in arrays.items():
        spec = SCHEMA[name]
        assert array.dtype == np.dtype(spec.dtype)
        assert array.shape == tuple({**CONSTANTS, **SIZES, "events": 0}[dim] for dim in spec.shape)


def test_a_slash_in_the_schema_is_a_dot_in_the_buffer():
    buffer = TrajectoryBuffer.allocate(**SIZES)
    buffer.trajectory.qpos[3] = np.arange(5)
    buffer.contacts.position[3, 1] = 1, 2, 3
    buffer.solver.status[3] = 2
    arrays = buffer.arrays()
    assert arrays["trajectory/qpos"] is buffer.trajectory.qpos
    assert arrays["trajectory/qpos"][3].tolist() == [0, 1, 2, 3, 4]
    assert arrays["contacts/position"][3, 1].tolist() == [1, 2, 3]
    assert arrays["solver/status"].tolist() == [0, 0, 0, 2, 0, 0, 0]


def test_an_empty_contact_slot_has_body_minus_one():
    assert (TrajectoryBuffer.allocate(**SIZES).contacts.body == -1).all()


def test_a_forgotten_index_and_a_misspelt_name_are_errors():
    buffer = TrajectoryBuffer.allocate(**SIZES)
    with pytest.raises(FrozenInstanceError):
        buffer.trajectory.qpos = np.zeros(5)
    with pytest.raises(AttributeError):
        buffer.trajectory.qpso[0] = 0


def test_trimmed_keeps_the_first_rows_and_all_events():
    buffer = TrajectoryBuffer.allocate(**SIZES)
    buffer.trajectory.time[:] = np.arange(7)
    buffer.add_event(0.5, "push")
    short = buffer.trimmed(3)
    assert short.steps == 3
    assert short.trajectory.time.tolist() == [0, 1, 2]
    assert short.contacts.force_realised.shape == (3, 2, 3)
    assert short.events == [(0.5, "push")]
    assert buffer.steps == 7


@pytest.mark.parametrize("steps", [-1, 8])
def test_trimmed_refuses_rows_that_are_not_there(steps):
    with pytest.raises(InputError, match=f"^steps must be between 0 and 7, got {steps}$"):
        TrajectoryBuffer.allocate(**SIZES).trimmed(steps)


def test_negative_sizes_are_refused():
    with pytest.raises(InputError, match="^nu must be >= 0, got -3$"):
        TrajectoryBuffer.allocate(**{**SIZES, "nu": -3})


def test_long_event_text_is_cut_between_characters():
    buffer = TrajectoryBuffer.allocate(**SIZES)
    buffer.add_event(np.float64(1.5), "é" * 99 + "x" + "é" * 50)
    buffer.add_event(2, "\ud800")
    arrays = buffer.arrays()
    assert arrays["events/time"].tolist() == [1.5, 2.0]
    assert arrays["events/text"].tolist() == [("é" * 99 + "x").encode(), b"?"]


@pytest.mark.parametrize(
    ("text", "size", "there"), [("aé", 2, "a"), ("aé", 3, "aé"), ("é", 1, ""), ("知e", 64, "知e")]
)
def test_a_name_is_cut_at_a_whole_letter(text, size, there):
    assert whole_letters(text, size) == there.encode()
