"""The keys in complaints about stages and parts are those that one may write."""

import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.scenario import build


def complaint(overrides):
    with pytest.raises(InputError) as error:
        build(load(overrides))
    return str(error.value)


@pytest.mark.parametrize(
    ("behaviour", "key"),
    [
        (["behaviour=press_up"], "behaviour.stages.1.held_out"),
        (["behaviour=get_up"], "behaviour.ways.1.when.feet"),
        (["behaviour=back_flip"], "behaviour.stages.2.until.bodies"),
        (["behaviour=back_flip"], "behaviour.stages.2.tasks.lean.aim.bodies"),
        (["behaviour=stand_step"], "behaviour.tasks.balance.aim.bodies"),
        (["behaviour=forward_roll", "+finish=stand"], "behaviour.finish.tasks.balance.aim.bodies"),
    ],
)
def test_a_body_that_is_not_there_is_told_by_its_key(behaviour, key):
    build(load([*behaviour, f"{key}=[foot]"]))
    assert complaint([*behaviour, f"{key}=[tail]"]).startswith(
        f"{key} names the unknown body 'tail'; "
    )


@pytest.mark.parametrize("behaviour", ["back_flip", "press_up"])
def test_two_stages_of_one_name_are_refused(behaviour):
    """`otherwise` would not know which one it goes to, nor a reader of the log which one it was."""
    first = load([f"behaviour={behaviour}"]).behaviour.stages[0].name
    told = complaint([f"behaviour={behaviour}", f"behaviour.stages.1.name={first}"])
    assert told == f"behaviour: two stages are called {first!r}; each needs a name of its own"


@pytest.mark.parametrize(
    ("key", "known"),
    [("catch.out", "behaviour.catch.out"), ("course.radius", "behaviour.course.radius")],
)
@pytest.mark.parametrize("sign", ["", "+", "++"])
def test_what_a_choice_adds_is_told_where_it_adds_it(key, known, sign):
    group = key.partition(".")[0]
    assert complaint([f"{sign}{key}=1"]) == (
        f"unknown key '{key}'; what +{group}=CHOICE adds is {known}"
    )


@pytest.mark.parametrize(
    ("override", "known"),
    [
        ("speed=2", "behaviour.speed"),
        ("pace.brake=9", "behaviour.pace.brake"),
        ("mass=60", "character.mass or plant.mass"),
    ],
)
def test_a_key_without_its_group_is_told_with_it(override, known):
    key = override.partition("=")[0]
    assert complaint(["behaviour=forward_roll", override]).startswith(
        f"unknown key {key!r}; did you mean {known}? valid keys: behaviour, "
    )


def test_a_name_that_many_keys_have_is_nobodys():
    assert complaint(["name=x"]).startswith("unknown key 'name'; valid keys: behaviour, ")
