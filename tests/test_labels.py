"""The name of a choice is what a run is called: it may not be that of another choice."""

import pytest

from rotctl.config import load
from rotctl.errors import InputError
from rotctl.listing import own
from rotctl.sweep.points import points

IS_ANOTHER = "would only call it so, and that is another"


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (
            ["behaviour.name=back_flip"],
            f"behaviour.name=back_flip: {IS_ANOTHER} behaviour; "
            "write behaviour=back_flip, or a name of your own",
        ),
        (
            ["seed=1", "++start.name='standing'"],
            f"start.name=standing: {IS_ANOTHER} start; write start=standing, or a name of your own",
        ),
        (
            ["behaviour=chain", "behaviour.parts=['stand criteria.name=rolling']"],
            f"behaviour.parts[0]: criteria.name=rolling: {IS_ANOTHER} criteria; "
            "write criteria=rolling, or a name of your own",
        ),
    ],
)
def test_the_name_of_another_choice_is_refused(overrides, said):
    with pytest.raises(InputError) as error:
        load(overrides)
    assert str(error.value) == said


def test_any_other_name_will_do_and_ones_own():
    assert load(["controller.name=whole"]).controller.name == "whole"
    assert load(["behaviour=stand", "behaviour.name=stand"]).behaviour.name == "stand"


def test_a_sweep_asks_of_each_value():
    with pytest.raises(InputError) as error:
        list(points([["controller.name=whole,standing", "seed=0"]]))
    assert str(error.value).startswith(f"controller.name=standing: {IS_ANOTHER} controller")


@pytest.mark.parametrize(
    "text", ["name: still\n", "defaults: [still, _self_]\ndescription: Mine.\n"]
)
def test_a_file_of_ones_own_has_a_name_of_its_own(tmp_path, text):
    path = tmp_path / "start" / "mine.yaml"
    path.parent.mkdir()
    path.write_text(text)
    with own(tmp_path), pytest.raises(InputError) as error:
        load(["start=mine"])
    assert str(error.value) == f"{path}: name: still: is another start; write name: mine"
