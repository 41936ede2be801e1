"""Behaviours one after the other: how a chain is written, when a part is over, how it is judged."""

import re
from dataclasses import replace

import numpy as np
import pytest
from here import swept

from rotctl.behaviours.staged.conditions import After
from rotctl.choices import config_folders
from rotctl.cli.run_wording import readable
from rotctl.config.chains import composed
from rotctl.config.identity import run_id
from rotctl.config.loading import load
from rotctl.config.schema import check
from rotctl.control.similarity import similar_gains
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.mechanics.stature import gains_likeness
from rotctl.metrics.criteria.chain import Link, spans
from rotctl.metrics.criteria.judge import judge
from rotctl.metrics.criteria.kinds import ChainCriteria
from rotctl.report.stage_names import stage_names
from rotctl.results.groups import grouped
from rotctl.results.keys import value_at
from rotctl.results.table import table
from rotctl.runs.run import in_memory, run
from rotctl.runs.scenario import build
from rotctl.runs.summary import links_of, summarise
from rotctl.settings.writing import to_dict
from rotctl.simulation.known import StateSettings
from rotctl.sweep.points import points

QUICK = ["behaviour=chain", "behaviour.rest.seconds=0.2", "controller=standing"]


def chain(*parts, more=()):
    said = ",".join(f'"{part}"' for part in parts)
    return load(["behaviour=chain", f"behaviour.parts=[{said}]", *more])


def simulated(config):
    scenario = build(config)
    buffer, ending = in_memory(scenario)
    return buffer.arrays(), summarise(scenario, buffer, ending, 1.0)


# ---------------------------------------------------------------- how it is written


def test_parts_are_what_they_are_by_themselves():
    made = chain("back_flip", "behaviour=back_flip behaviour.shape=tuck", more=["seed=3"])
    alone = load(["behaviour=back_flip"])
    first, between, last = made.behaviour.parts
    assert first.behaviour == last.behaviour == alone.behaviour
    assert between.behaviour.name == "square"
    assert made.criteria.parts[0] == made.criteria.parts[2] == alone.criteria
    assert made.criteria.parts[1].kind == "landing"
    assert (first.gains, first.excursion) == (None, None)  # the run's are the same by name


def test_a_part_brings_its_gains_where_the_run_has_others():
    made = load(["behaviour=forward_roll_twice"])
    stand, tip, roll = made.behaviour.parts
    assert stand.gains.tasks == load(["behaviour=stand"]).controller.tasks
    assert tip.gains.poses == load(["controller=acrobatic"]).controller.poses
    assert roll.gains is None
    assert made.controller.name == "keeping_pace"
    assert (stand.excursion, tip.excursion.name) == (None, "trunk")


def test_nothing_goes_between_where_a_part_says_when_it_ends():
    """The last stage of `tip_over` has a condition: the roll goes on from there."""
    said = ("tip_over", "forward_roll +finish=stand", "stand")
    names = [part.behaviour.name for part in chain(*said).behaviour.parts]
    assert names == ["tip_over", "forward_roll", "square", "stand"]
    plain = chain(*said, more=["behaviour.between=null"])
    assert len(plain.behaviour.parts) == 3


def test_nothing_goes_between_where_a_finish_says_when_it_ends():
    """The last stage of a roll's finish is the last one of the part."""
    until = {"kind": "after", "seconds": 1.0}

    def compose(words):
        stages = [{}, {"until": until}] if "behaviour=counted" in words else [{"until": until}, {}]
        behaviour = {"name": "any", "kind": "rolling", "finish": {"stages": stages}}
        return {"behaviour": behaviour, "controller": {}, "criteria": {}, "excursion": {}}

    data = {
        "behaviour": {"kind": "chain", "parts": ["counted", "roll", "stand"], "between": "rest"}
    }
    found = composed(data, compose)["behaviour"]
    assert [part["said"] for part in found["parts"]] == ["counted", "roll", "rest", "stand"]


def test_a_chain_out_of_a_log_is_the_same_run():
    made = chain("stand", "back_flip")
    again = check(to_dict(made))
    assert again == made
    assert run_id(again, build(again).known) == run_id(made, build(made).known)


def test_a_table_tells_what_was_said_of_the_parts():
    data = to_dict(chain("stand", "behaviour=back_flip   behaviour.shape=tuck"))
    assert value_at(data, "behaviour.parts") == "stand, square, back_flip behaviour.shape=tuck"
    assert list(value_at(data, "behaviour.rest.feet")) == ["foot_l", "foot_r"]
    for part in data["behaviour"]["parts"]:
        del part["said"]
    assert value_at(data, "behaviour.parts") == "stand, square, back_flip"


def test_parts_of_one_name_and_other_settings_are_two_groups(tmp_path):
    parts = 'behaviour.parts=[stand],["stand behaviour.tasks.balance.aim.gain=1.0"]'
    found = table(swept(tmp_path, "behaviour=chain", parts, "duration=0.1"))
    rows = grouped(found).rows
    other = "stand behaviour.tasks.balance.aim.gain=1.0"
    assert dict(zip(rows["behaviour.parts"], rows["n"], strict=True)) == {"stand": 1, other: 1}


def test_what_was_said_of_a_part_does_not_act():
    alike = chain("stand"), chain("behaviour=stand")
    assert alike[0] == alike[1]
    other = replace(alike[0].behaviour.parts[0], said="other")
    told = replace(alike[0], behaviour=replace(alike[0].behaviour, parts=(other,)))
    assert run_id(told, build(told).known) == run_id(alike[0], build(told).known)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        (["back_flap"], 'behaviour.parts.0: behaviour="back_flap": no such choice; did you mean '
         "back_flip?"),
        (["chain"], 'behaviour.parts.0="chain": is a chain; name its parts'),
        (["forward_roll_twice"], 'behaviour.parts.0="forward_roll_twice": is a chain; name its '
         "parts, stand, tip_over, forward_roll "),
        (["get_up", "back_flip"], 'behaviour.parts.0="get_up": is a chain that is judged as a '
         "whole, and no part of another; press_up of them can be one: see docs/chains.md"),
        (["stand", "rock_up"], 'behaviour.parts.1="rock_up": is a chain that is judged as a whole, '
         "and no part of another: see docs/chains.md"),
        (["stand", ""], 'behaviour.parts.1="": must begin with a behaviour, back_flip or '
         "behaviour=back_flip"),
        (["stand seed=3"], 'behaviour.parts.0: "seed=3": a part may say behaviour, catch, course, '
         "criteria, finish"),
        (["stand character={kind:mjcf,file:/etc/passwd}"], "behaviour.parts.0: "),
        (["stand 'x"], "behaviour.parts.0=\"stand 'x\": No closing quotation"),
        (["forward_roll", "stand"], "behaviour.parts: 'forward_roll': forward_roll rolls on, and "
         "others follow it; 'behaviour=NAME +finish=stand' comes to an end"),
        (["stand"] * 21, "behaviour.parts: has 21 parts, valid: up to 20 in all"),
        (["stand"] * 11, "behaviour.parts: has 11 parts and behaviour.between adds 10, valid: up "
         "to 20 in all"),
        (["back_flip ~criteria"], 'behaviour.parts.0="back_flip ~criteria": leaves no criteria, '
         "it must have one"),
        (["back_flip ~behaviour"], 'behaviour.parts.0="back_flip ~behaviour": leaves no '
         "behaviour, it must have one"),
        (["back_flip behaviour.stages=7", "stand"], "behaviour.parts: 'back_flip "
         "behaviour.stages=7': behaviour.stages=7: must be a list, in brackets"),
        (["back_flip behaviour.heading=" + "9" * 2000, "stand"],
         "behaviour.parts: 'back_flip behaviour.heading=" + "9" * 29 + "...': behaviour.heading="),
        (["back_flip behaviour.stages=[5]", "stand"], "behaviour.parts: \"back_flip "
         "'behaviour.stages=[5]'\": behaviour.stages.0=5: must be keys with values"),
        (["decline_flowing", "stand"], 'behaviour.parts.0="decline_flowing": is for '
         "terrain=decline, and the run has terrain=flat; give the run terrain=decline"),
        (["stand", "baby_roll_over"], 'behaviour.parts.1="baby_roll_over": is for character=baby, '
         "and the run has character=adult; give the run character=baby"),
        (["back_flip", "forward_roll_1"], 'behaviour.parts.1="forward_roll_1": is for '
         "character=adult_free_head, and the run has character=adult; give the run "
         "character=adult_free_head"),
        (["stand", "stand ~behaviour.heading"], "behaviour.parts: \"stand '~behaviour.heading'\": "
         "behaviour.heading: missing, it cannot be left out"),
        (["stand", "back_flip behaviour.heading=90.0"], "behaviour.parts.1: "
         "behaviour.heading=90.0: acts on nothing, a later part heads where the feet point as it "
         "begins"),
    ],
)  # fmt: skip
def test_parts_that_are_wrong(parts, message):
    with pytest.raises(InputError) as caught:
        chain(*parts)
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["~controller"], "controller: missing, it cannot be left out"),
        (["~excursion"], "excursion: missing, it cannot be left out"),
        (["behaviour.parts=[]"], "behaviour.parts=[]: too few values, at least 1"),
        (["behaviour.parts=5"], "behaviour.parts=5: must be a list, in brackets"),
        (["~behaviour.parts"], "behaviour.parts: missing, it cannot be left out"),
        (["behaviour.parts=[[a]]"], 'behaviour.parts.0=["a"]: must be keys with values'),
        (["behaviour.parts=[{a:1}]"], 'behaviour.between="square": goes between parts that are '
         "texts, and these are in full; give null"),
        (["behaviour.parts=[stand,forward_roll]", "+behaviour.again=0.3"], "behaviour.again=0.3: "
         "acts on nothing, forward_roll rolls on; 'behaviour=NAME +finish=stand' comes to an end"),
        (["behaviour.rest.feet=[]"], "behaviour.rest.feet=[]: too few values, at least 1"),
    ],
)  # fmt: skip
def test_a_chain_that_lacks_something(overrides, message):
    with pytest.raises(InputError) as caught:
        load(["behaviour=chain", *overrides])
    assert str(caught.value) == message


ACROBATS = ("behaviour=chain", "behaviour.parts=[stand,back_flip]", "behaviour.between=null")


@pytest.mark.parametrize(
    ("overrides", "idle"),
    [
        (["controller=wheeling"], "controller=wheeling"),
        (["controller=listening", "controller.rate=120"], "controller=listening"),
        (["controller=listening", "controller.pose.stiffness=5"], "controller.pose.stiffness=5"),
    ],
)
def test_gains_that_no_part_takes(overrides, idle):
    """Both parts bring theirs; what they take of the run's controller is its rate, among others."""
    with pytest.raises(InputError) as caught:
        load([*ACROBATS, *overrides])
    assert str(caught.value) == f"{idle}: acts on nothing, stand, back_flip bring their own gains"


@pytest.mark.parametrize("more", [[], ["excursion.phase_time=3"]])
def test_an_excursion_that_no_part_takes(more):
    with pytest.raises(InputError) as caught:
        chain("back_flip", more=["excursion=oriented", *more])
    assert str(caught.value) == (
        "excursion=oriented: acts on nothing, back_flip brings its own excursion"
    )


def test_nor_in_a_sweep():
    """Which does not compose each of its points anew."""
    grid = ["behaviour=chain", "controller=listening", "controller.pose.stiffness=5,6"]
    with pytest.raises(InputError, match=r"^controller.pose.stiffness=5: acts on nothing, "):
        list(points([grid]))


def test_what_the_run_is_told_acts_on_the_parts_that_take_it():
    taken = load([*ACROBATS, "controller.pose.stiffness=5"])
    assert [part.gains is None for part in taken.behaviour.parts] == [False, True]
    assert load([*ACROBATS, "controller=listening"]).controller.rate != taken.controller.rate


def test_a_part_may_be_for_the_terrain_of_the_run():
    made = chain("stand", "incline", more=["terrain=incline", "character=adult_free_head"])
    assert made.behaviour.parts[-1].behaviour.name == "incline"


def test_a_part_may_be_for_the_character_of_the_run():
    """One that asks for none is at home on any."""
    made = chain("tip_over", "forward_roll_1", more=["character=adult_free_head"])
    assert made.behaviour.parts[-1].behaviour.name == "forward_roll_1"
    assert made.character.exclude_from_control == ("head",)


@pytest.mark.parametrize("behaviour", ["forward_roll_twice", "rock_up"])
def test_a_chain_of_an_own_character(tmp_path, behaviour):
    (tmp_path / "character").mkdir()
    own = tmp_path / "character" / "tall.yaml"
    own.write_text("defaults: [adult, _self_]\nname: tall\nheight: 1.9\n")
    with config_folders.own(tmp_path):
        made = load([f"behaviour={behaviour}", "character=tall"])
    assert (made.character.name, made.character.height) == ("tall", 1.9)


def test_the_first_part_heads_where_it_is_told():
    first, _, last = chain("stand behaviour.heading=30", "backward_roll_1_on_head").behaviour.parts
    assert (first.behaviour.heading, last.behaviour.roll_about) == (30.0, "right")


def test_as_many_parts_as_there_may_be():
    assert len(chain(*["stand"] * 10).behaviour.parts) == 19
    assert len(chain(*["stand"] * 20, more=["behaviour.between=null"]).behaviour.parts) == 20


def test_a_log_roll_begins_lying():
    config = chain("stand", "behaviour=sideways_roll", more=["character=adult_free_head"])
    with pytest.raises(InputError) as caught:
        build(config)
    assert str(caught.value) == (
        "behaviour.parts: 'sideways_roll': sideways_roll rolls about the head, lying, and cannot "
        "begin from standing"
    )


def test_a_part_that_does_not_fit_is_told_by_what_was_said_of_it():
    """And not by its number, between which and the user's there are others."""
    said = "stand 'behaviour.tasks.balance.aim.bodies=[tail]'"
    config = chain("stand", said)
    told = "behaviour.tasks.balance.aim.bodies names the unknown body 'tail'; "
    with pytest.raises(InputError) as caught:
        build(config)
    assert str(caught.value).startswith(f"behaviour.parts: {said!r}: {told}")
    unsaid = [replace(part, said="") for part in config.behaviour.parts]
    config = replace(config, behaviour=replace(config.behaviour, parts=tuple(unsaid)))
    with pytest.raises(InputError) as caught:
        build(config)
    assert str(caught.value).startswith(f"behaviour.parts.2: {told}")


def test_criteria_are_as_many_as_parts():
    config = chain("stand", "stand")
    one = replace(config, criteria=ChainCriteria("few", "chain", config.criteria.parts[:1]))
    with pytest.raises(InputError, match=r"criteria.parts: 1 of them, and behaviour=chain has 3"):
        build(one)


def test_gains_of_a_part_fit_the_body():
    """A child's are those of the run scaled by the same law."""
    child = ["character.height=1.2", "character.mass=23"]
    config = load(["behaviour=forward_roll_twice", *child])
    by = gains_likeness(config.character)
    part = config.behaviour.parts[0]
    scaled = similar_gains(part.gains, by, part.behaviour.kinds)
    alone = build(load(["behaviour=stand", *child])).controller.settings
    assert scaled.tasks["balance"] == alone.tasks["balance"]
    assert scaled.contact == alone.contact != part.gains.contact
    assert build(config).behaviour.tasks  # and it is made of them


# ---------------------------------------------------------------- what it does


def test_a_chain_of_one_is_the_behaviour():
    """The same bits, until it is in the air."""
    more = ["seed=2003", "duration=2"]
    alone, _ = simulated(load(["behaviour=back_flip", *more]))
    chained, _ = simulated(chain("back_flip", more=more))
    assert (alone["trajectory/qpos"] == chained["trajectory/qpos"]).all()
    assert (alone["trajectory/ctrl"] == chained["trajectory/ctrl"]).all()


@pytest.fixture(scope="module")
def stands():
    """Three stands, each over after a fifth of a second of rest."""
    config = load([*QUICK, "behaviour.parts=[stand,stand,stand]", "behaviour.between=null",
                   "seed=2000", "duration=3"])  # fmt: skip
    return (config, *simulated(config))


def test_the_next_part_begins_after_a_rest(stands):
    config, log, summary = stands
    stage = np.asarray(log["command/stage"])
    first, second = np.flatnonzero(np.diff(stage)) + 1
    assert stage[[0, first, second, -1]].tolist() == [0, 1, 2, 2]
    assert second - first == round(0.2 * config.controller.rate) + 1  # it rests already
    speed = np.sqrt((log["trajectory/com_velocity"] ** 2).sum(axis=1))
    assert (speed[first - 12 : first] < config.behaviour.rest.speed).all()
    assert summary["parts_begun"] == 3


def test_a_rest_counts_from_the_last_stage_on():
    """`gather` stands still while it has its weight on one foot, and is not over then."""
    more = ["behaviour.between=null", "behaviour.rest.seconds=0.3", "behaviour.rest.speed=1.0"]
    log, _ = simulated(chain("gather", "stand", more=[*more, "seed=2000", "duration=3.5"]))
    stages, times = log["command/stage"], log["trajectory/time"]
    last, following = (times[stages == stage][0] for stage in (4, 5))
    assert last > 2.0  # two feet are put down before it
    assert following - last == pytest.approx(0.3, abs=0.02)


def test_feet_and_arms_between_two_cartwheels_are_as_at_the_start():
    made = load(["behaviour=cartwheel_twice"])
    names = [part.behaviour.name for part in made.behaviour.parts]
    assert names == ["cartwheel", "gather", "raise", "cartwheel"]


def test_a_part_heads_where_the_feet_point(stands):
    _, log, _ = stands
    axes = log["command/axes"]
    assert (axes[0] == np.eye(3)).all()
    x, y, z = axes[-1][0].tolist()
    assert (abs(y) > 0.0, z) == (True, 0.0)  # scattered feet are not quite straight
    assert x > 0.99


@pytest.mark.parametrize(("about", "faces"), [("left", 1.0), ("right", -1.0)])
def test_with_no_foot_down_a_part_heads_where_the_one_before_faced(about, faces):
    """Who rolls about the right goes backward: its way leads where the back points."""
    config = load([*QUICK, "behaviour.parts=[stand,stand]", "behaviour.between=null",
                   "start=symmetric", "duration=0.1"])  # fmt: skip
    first, second = config.behaviour.parts
    (stage,) = first.behaviour.stages
    stage = replace(stage, until=After("after", 0.05))
    begins = replace(first.behaviour, roll_about=about, stages=(stage,))
    parts = (replace(first, behaviour=begins), second)
    facing = (1.0, 0.0, 0.0, 0.0) if faces > 0.0 else (0.0, 0.0, 0.0, 1.0)
    aloft = StateSettings((0.0, 0.0), 1.0, facing, (0.0,) * 3, (0.0,) * 3, {}, {})
    still = dict.fromkeys(("pitch", "speed_x", "angular_velocity_y"), (0.0, 0.0))
    start = replace(config.start, **still, state=aloft)
    behaviour = replace(config.behaviour, parts=parts)
    log, summary = simulated(replace(config, start=start, behaviour=behaviour))
    assert summary["parts_begun"] == 2
    assert log["command/axes"][[0, -1], 0, 0] == pytest.approx([1.0, faces], abs=1e-3)


def test_each_part_is_judged_by_itself(stands):
    """The first two rested for less than their criteria ask for."""
    config, log, summary = stands
    assert summary["failure_reason"].startswith("part 1 of 3, stand: ")
    assert summary["parts_succeeded"] == 1  # the last one stands for more than two seconds
    parts = spans(log, [link.stages for link in links_of(config)])
    for part, words in zip(parts, summary["parts"].split("; "), strict=True):
        assert words.startswith(f"stand {log['trajectory/time'][part.rows.start]:.2f}: ")
        assert part["trajectory/time"][0] == 0.0
        assert part["command/stage"].max() == 0
    assert sum(len(part["trajectory/time"]) for part in parts) == len(log["trajectory/time"])


def test_a_part_that_never_begins(stands):
    """Told by its number, where all that began are successes."""
    config, log, _ = stands
    lenient = replace(config.criteria.parts[0], rest=0.1)
    asked = [Link("stand", 1, {}), Link("stand", 1, {}), Link("stand", 1, {}), Link("fly", 1, {})]
    criteria = ChainCriteria("four", "chain", (lenient,) * 4)
    found = judge(log, criteria, {}, 1 / config.controller.rate, 3.0, links=asked)
    assert found.reason == "part 4 of 4, fly, has not begun"
    assert (found.columns["parts_succeeded"], found.columns["parts_begun"]) == (3, 3)


def test_pictures_name_the_stages_of_all_parts(tmp_path):
    config = load(["behaviour=forward_roll_twice", "duration=0.1"])
    made = run(config, tmp_path)
    names = stage_names(RunLog.open(made.folder / "run.h5"))
    assert names == ["stand", "stand", "squat", "tip", "roll", "stand"]


# ---------------------------------------------------------------- rolls, counted


def test_a_roll_is_told_by_its_revolutions():
    finish = load(["behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=0"])
    counted = replace(finish.behaviour.finish, revolutions=2.0)
    told = [counted.told(5.0, 2 * np.pi * turned) for turned in (0.0, 1.05, 1.15, 2.0)]
    assert told == [False, False, True, True]
    assert replace(counted, after=6.0).told(5.0, 9.0) is False
    asked = replace(finish.behaviour, finish=counted).commanded
    assert asked["revolutions_commanded"] == 2.0
    assert asked["revolutions_told"] == pytest.approx(1.1)
    assert "revolutions_commanded" not in finish.behaviour.commanded


def test_so_few_revolutions_count_nothing():
    overrides = ["behaviour=forward_roll", "+finish=stand", "behaviour.finish.revolutions=0.9"]
    with pytest.raises(InputError) as caught:
        load(overrides)
    assert str(caught.value) == (
        "behaviour.finish.revolutions=0.9: must be more than 0.9, or 0, which counts none"
    )


def test_a_roll_out_of_a_stand_turns_twice_at_the_least():
    roll = "forward_roll +finish=stand behaviour.finish.revolutions="
    for few in ("1", "1.9"):
        with pytest.raises(InputError, match=f"revolutions={few}: a roll out of a stand that is "):
            load(["behaviour=chain", f"behaviour.parts=[stand,'{roll}{few}']"])
    for parts in (f"'{roll}1',stand", f"stand,'{roll}2'", f"stand,'{roll}0'"):
        assert load(["behaviour=chain", f"behaviour.parts=[{parts}]"])


def test_a_roll_that_is_counted_is_seen_and_told():
    """It is looked at as any other, and people read when it was told."""
    counted = ["behaviour.finish.after=0", "behaviour.finish.revolutions=1", "duration=3"]
    _, summary = simulated(load(["behaviour=forward_roll", "+finish=stand", "seed=2000", *counted]))
    for name in ("head_share", "head_peak", "force_p99", "knees_apart", "limb_overlap"):
        assert summary[name] is not None
    assert 0.0 < summary["told_at"] < 1.0
    at = f"{summary['told_at']:.1f}"
    assert f"(told to after 0.1 rev, at {at} s)" in readable(summary)
    never = readable({**summary, "told_at": None})
    assert "(told to after 0.1 rev, which it never did)" in never


def test_two_rolls_out_of_a_stand():
    """Nine of ten starts roll twice and stand up: that none of two does is no chance."""
    rolled = 0
    for seed in (2000, 2003):
        config = load(["behaviour=forward_roll_twice", f"seed={seed}", "duration=11"])
        _, summary = simulated(config)
        assert summary["parts_begun"] == 3
        rolled += summary["success"]
    assert rolled


def test_a_schedule_of_a_part_comes_in_the_run():
    part = "'forward_roll behaviour.pace.schedule=[[9,0.5]]'"
    chain = load(["behaviour=chain", f"behaviour.parts=[stand,{part}]", "duration=9"])
    with pytest.raises(InputError) as raised:
        build(chain)
    assert str(raised.value) == (
        "behaviour.parts: \"forward_roll 'behaviour.pace.schedule=[[9,0.5]]'\": "
        "behaviour.pace.schedule: what it tells from 9 s on never comes, the run is over at 9 s"
    )


def test_a_part_is_told_to_end_in_the_run():
    part = "'forward_roll +finish=stand behaviour.finish.after=9'"
    chain = load(["behaviour=chain", f"behaviour.parts=[stand,{part}]", "duration=9"])
    with pytest.raises(InputError) as raised:
        build(chain)
    assert str(raised.value).startswith(
        "behaviour.parts: 'forward_roll +finish=stand behaviour.finish.after=9': "
        "behaviour.finish.after=9: it is never told to end, the run is over at 9 s"
    )


@pytest.mark.parametrize(
    "key", ["behaviour.parts.2.behaviour.angular_velocity", "criteria.parts.0.lean"]
)
def test_nothing_is_set_inside_a_part(key):
    """To write + before the key, as for others that are not there yet, would not do either."""
    message = f"{key}: is inside a part of a chain; say it in the part's own text, as in "
    with pytest.raises(InputError, match=re.escape(message)):
        load(["behaviour=forward_roll_twice", f"{key}=0.6"])
