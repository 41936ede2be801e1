"""An attribute that a log cannot have is named, and nothing is written."""

import pytest
from test_log_writer import ATTRIBUTES, MODEL, buffer, write

from rotctl.errors import InputError
from rotctl.log import encode_run


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"seed": "3"}, "attribute 'seed' must be int, got str"),
        ({"seed": True}, "attribute 'seed' must be int, got bool"),
        ({"seed": 2**63}, f"attribute 'seed' must fit in 64 bits, got {2**63}"),
        ({"git_dirty": 0}, "attribute 'git_dirty' must be bool, got int"),
        ({"config": "a\0b"}, "attribute 'config' contains a NUL character"),
        ({"config": "\ud800"}, "attribute 'config' is not valid Unicode text"),
        ({"outcome": {"x": object()}}, "cannot store a object as JSON"),
        (
            {"colour": "red"},
            "unknown attribute 'colour'; valid names: config, run_id, seed, versions, "
            "git_commit, git_dirty, machine, wall_time, outcome",
        ),
        (
            {"complete": True},
            "unknown attribute 'complete'; valid names: config, run_id, seed, "
            "versions, git_commit, git_dirty, machine, wall_time, outcome",
        ),
    ],
)
def test_bad_attributes_are_named(tmp_path, attributes, message):
    path = tmp_path / "run.h5"
    with pytest.raises(InputError) as caught:
        write(path, **attributes)
    assert str(caught.value) == f"cannot write {path}: {message}"
    assert list(tmp_path.iterdir()) == []


def test_a_missing_attribute_is_named():
    without = {name: value for name, value in ATTRIBUTES.items() if name != "seed"}
    with pytest.raises(InputError, match="^missing attribute 'seed'$"):
        encode_run(buffer(), model_xml=MODEL, attributes=without)
