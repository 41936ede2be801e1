"""The history of a search: what it keeps, and one line for a file that is none."""

import sqlite3

import pytest

from rotctl.errors import InputError
from rotctl.tune.history import Trial, open_history
from rotctl.tune.space import load_space

pytest.importorskip("optuna", reason="not installed: pip install 'rotctl[tune]'")

SPACE = load_space("rolling_gains")
VALUES = {parameter.key: parameter.low for parameter in SPACE.parameters}
TRIAL = Trial(0, 1, VALUES, score=0.5, finished=0.25, lost=2, seconds=3.0)


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "search"
    path.mkdir()
    return path


def test_a_trial_comes_back(folder):
    open_history(folder, SPACE, {"a": 1}).add(TRIAL)
    assert open_history(folder, SPACE, {"a": 1}).trials() == [TRIAL]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("update trial_user_attributes set value_json = '\"x\"' where key = 'generation'",
         'it holds no trials: generation="x": must be a valid integer'),
        ("update trial_user_attributes set value_json = '1000000000' where key = 'generation'",
         "it holds no trials: generation=1000000000: must be less than or equal to 1000000"),
        ("update trial_user_attributes set value_json = '-1' where key = 'index'",
         "it holds no trials: index=-1: must be greater than or equal to 0"),
        ("delete from trial_user_attributes where key = 'lost'",
         "it holds no trials: lost: missing, it cannot be left out"),
        ("delete from trial_params where param_id = 1",
         "it holds no trials: its candidates have other parameters"),
        ("update trial_user_attributes set value_json = '{torn' where key = 'lost'",
         "Expecting property name enclosed in double quotes"),
        ("update study_user_attributes set value_json = '{torn'",
         "Expecting property name enclosed in double quotes"),
        ("update trial_params set distribution_json = '{}'", ""),
    ],
)  # fmt: skip
def test_a_file_that_somebody_changed_is_one_line(folder, change, said):
    open_history(folder, SPACE, {"a": 1}).add(TRIAL)
    with sqlite3.connect(folder / "study.db") as base:
        base.execute(change)
    with pytest.raises(InputError) as caught:
        open_history(folder, SPACE, {"a": 1}).trials()
    assert str(caught.value).startswith(f"cannot use {folder / 'study.db'}: {said}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["a?b=c", "a%20b", "a#b", "?mode=memory", "ü b"])
def test_no_name_of_a_folder_leads_out_of_it(tmp_path, name):
    """To SQLAlchemy a path is part of an address."""
    (tmp_path / name).mkdir()
    open_history(tmp_path / name, SPACE, {"a": 1}).add(TRIAL)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert [path.name for path in (tmp_path / name).iterdir()] == ["study.db"]
