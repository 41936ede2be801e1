"""The name of a choice is what a run is called: it may not be that of another choice."""

import pytest

from rotctl.choices.config_folders import own
from rotctl.config.loading import load
from rotctl.errors import InputError
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
            ["behaviour={name: back_flip, speed: 1.0}"],
            f"behaviour.name=back_flip: {IS_ANOTHER} behaviour; "
            "write behaviour=back_flip, or a name of your own",
        ),
        (
            ["seed=1", "++start.name='standing'"],
            f"start.name=standing: {IS_ANOTHER} start; write start=standing, or a name of your own",
        ),
        (
            ["behaviour=get_up", "start=side", "start.name=prone"],
            f"start.name=prone: {IS_ANOTHER} start; write start=prone, or a name of your own",
        ),
        (
            ["behaviour=chain", "behaviour.parts=['stand criteria.name=rolling']"],
            f"behaviour.parts.0: criteria.name=rolling: {IS_ANOTHER} criteria; "
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
    assert load(["behaviour.name=forward_roll_1"]) == load([]), "as nobody chooses"
    brought = ["behaviour=get_up", "seed=2"]
    assert load([*brought, "start.name='prone'"]) == load(brought)
    swept = list(points([["behaviour=get_up", "start.name=prone", "seed=0,2"]]))
    assert swept[1].config == load(brought)


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


def test_a_part_of_a_chain_by_a_file_of_ones_own_has_a_name_of_its_own(tmp_path):
    path = tmp_path / "behaviour" / "mine.yaml"
    path.parent.mkdir()
    path.write_text("defaults: [stand_step, _self_]\n")
    with own(tmp_path), pytest.raises(InputError) as error:
        load(["behaviour=chain", "behaviour.parts=[back_flip,mine]"])
    assert str(error.value) == (
        f"behaviour.parts.1: {path}: name: stand_step: is another behaviour; write name: mine"
    )
