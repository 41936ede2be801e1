"""Every number and every choice of a config acts: something else in the log, or a refusal.

A setting that makes a new run id and nothing else makes two results out of one. Each is changed by
itself, in a run in which it should count, and the log must differ by more than rounding. What does
nothing there is listed with the reason, and must do nothing: a list that is out of date fails.
"""

import copy
import re
from dataclasses import dataclass, field

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.settings.writing import to_dict

TINY = 1e-9  # of any number in the log; in so short a run rounding makes 1e-13
NAMES = (
    r"(.*\.)?(name|description|source|clip|found_for)|disturbance\.body"
    r"|character\.(trunk|self_collision)\..*"
)


@dataclass(frozen=True)
class Case:
    """A run, and the settings that should act in it.

    Attributes:
        keys: pattern of the settings that are tried.
        inert: patterns of those that do nothing here, and why.
        seconds: simulated.
    """

    overrides: tuple[str, ...]
    keys: str
    inert: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.4


CASES = {
    "default": Case(
        # listening also has the gains of getting up; alighting and catch have cases; from seed 0
        # rounding decides whether the first solver is content with a step
        ("controller=rolling", "behaviour.alighting=null", "behaviour.catch=null", "seed=1"),
        r"(?!character\.bodies|criteria|controller\.thresholds).*",
        {
            r"character\.flesh\.(depth|onset)": "of the back, which is not down yet",
            r"controller\.merging\.angle": "of hills, where contacts are near each other",
            r"controller\.backend": "the same mathematics, slower",
            r"controller\.sees_disturbance": "of disturbances",
            r"behaviour\.align_with_slope": "of slopes",
            r"physics\.ccd_(iterations|tolerance)": "of boxes and heightfields",
            r"physics\.noslip_tolerance": "of noslip_iterations, which is 0",
        },
    ),
    "flesh": Case((), r"character\.flesh\..*", seconds=2.0),
    "as written": Case((), r"controller\.thresholds\.(force|torque)", seconds=2.0),
    "hull": Case(
        ("behaviour=forward_roll_1_on_head", "controller.supervisor=convex_hull"),
        r"controller\.thresholds\.hull",
        seconds=2.0,
    ),
    "push": Case(
        ("disturbance=push", "disturbance.time=[0.05,0.2]"),
        r"disturbance\..*|controller\.sees_disturbance",
    ),
    "push at a phase": Case(
        ("disturbance=push", "disturbance.time=0", "disturbance.phase=10"),
        r"disturbance\.phase",
    ),
    "wind": Case(("disturbance=wind",), r"disturbance\..*"),
    "gust": Case(
        ("disturbance=gust", "disturbance.time=[0.05,0.2]", "disturbance.duration=0.1"),
        r"disturbance\..*",
    ),
    "load": Case(("disturbance=load", "disturbance.time=[0.05,0.2]"), r"disturbance\..*"),
    "slippery": Case(("disturbance=slippery", "disturbance.time=[0.05,0.2]"), r"disturbance\..*"),
    "load at a phase": Case(
        ("disturbance=load", "disturbance.time=0", "disturbance.phase=10"), r"disturbance\.phase"
    ),
    "plant": Case(("plant=randomised",), r"plant\..*"),
    "modified": Case(
        ("controller.supervisor=modified",), r"controller\.thresholds\.separation", seconds=0.8
    ),
    "noslip": Case(("physics.noslip_iterations=3",), r"physics\.noslip_.*"),
    "clip": Case(("behaviour=reference_roll",), r"behaviour\.(?!align_with_slope).*"),
    "pace that waits": Case(
        ("behaviour=forward_roll", "behaviour.angular_velocity=0.4"),
        r"behaviour\.pace\.(?!most|travel).*",
        seconds=2.5,
    ),
    "pace that waits down a slope": Case(
        ("behaviour=decline",),
        r"behaviour\.pace\.(approach|leave|back|patience|pose\..*)",
        seconds=2.5,
    ),
    "pace that halts": Case(
        ("behaviour=forward_roll", "behaviour.pace.schedule=[[0.2,0]]"),
        r"behaviour\.pace\.easing",
        seconds=2.0,
    ),
    "pace that hurries": Case(
        ("behaviour=forward_roll", "behaviour.angular_velocity=1.4"),
        r"behaviour\.pace\.(most|travel)",
        seconds=1.5,
    ),
    "finish": Case(
        (
            "behaviour=forward_roll",
            "+finish=stand",
            "behaviour.finish.after=0.3",
            "behaviour.finish.reach=1",
            "behaviour.finish.turning=1",
        ),
        r"behaviour\.finish\.(after|reach|turning|within)",
        seconds=1.5,
    ),
    "finish by revolutions": Case(
        (
            "behaviour=forward_roll",
            "+finish=stand",
            "behaviour.finish.after=0",
            "behaviour.finish.revolutions=2",
        ),
        r"behaviour\.finish\.revolutions",
        seconds=1.5,
    ),
    "chain": Case(
        (
            "behaviour=chain",
            "behaviour.parts=[stand,stand]",
            "behaviour.between=null",
            "behaviour.rest.seconds=0.1",
            "controller=standing",
        ),
        r"behaviour\.rest\..*",
        seconds=0.3,
    ),
    "catch": Case(
        ("behaviour=forward_roll", "+catch=arm", "disturbance=push", "disturbance.time=0.3"),
        r"behaviour\.catch\..*",
        seconds=1.5,
    ),
    "alighting": Case(
        ("disturbance=push", "disturbance.time=0.3", "disturbance.direction=90"),
        r"behaviour\.alighting\..*",
        seconds=2.0,
    ),
    "oblique": Case(("+behaviour.oblique=[12,5,-3]",), r"behaviour\.oblique.*"),
    "lift": Case(("+behaviour.lift=[0.2,0.1,-0.3]",), r"behaviour\.lift.*"),
    "path": Case(
        ("behaviour=forward_roll", "+course=slalom", "behaviour.course.legs=[[0.3,10],[0.3,-5]]"),
        r"behaviour\.course\..*",
        seconds=1.2,
    ),
    "rates": Case(
        ("behaviour=forward_roll", "+course=turn", "behaviour.course.schedule=[[0.1,20]]"),
        r"behaviour\.course\..*",
    ),
    "slope": Case(("behaviour=decline",), r"terrain\..*|behaviour\.align_with_slope"),
    "posture": Case(
        ("start=still",),
        r"start\.(?!postures\.(right|head)\.).*",  # the others are of backward and log rolls
    ),
    "known state": Case(
        (
            "start=rest",
            "+start.state={place:[0.5,0.1],gap:0.05,orientation:[0.9,0.1,0.2,0.1],"
            "velocity:[0.5,0.1,-0.1],angular_velocity:[0.3,2.0,0.2],pose:{hip_y:1.0},"
            "speeds:{knee_l:1.0}}",
        ),
        r"start\..*",
        seconds=0.05,
    ),
    "lockstep": Case(
        ("physics=lockstep",),
        r"physics\..*",
        {
            r"physics\.backend": "the same mathematics, slower",
            r"physics\.ccd_(iterations|tolerance)": "of boxes and heightfields",
            r"physics\.limit_push_out": "of limits that are met too late",
        },
        seconds=1.2,
    ),
    "lockstep limits": Case(
        ("physics=lockstep", "physics.limit_margin=0.001"), r"physics\.limit_push_out"
    ),
    "lockstep on hills": Case(("physics=lockstep", "terrain=uneven"), r"physics\.ccd_.*"),
    "uneven": Case(
        ("terrain=uneven", "terrain.bumps=2000", "terrain.bump_height=0.1", "terrain.run_in=0.2"),
        r"terrain\..*|controller\.merging\..*|physics\.ccd_.*",
        seconds=0.8,
    ),
    "stairs": Case(("terrain=stairs_down", "terrain.run_in=0.3"), r"terrain\..*", seconds=1.2),
    "water": Case(
        ("terrain=pool", "terrain.height=0.3", "terrain.edge=0.05"),  # who rolls off the edge
        r"terrain\..*",
        seconds=1.2,
    ),
    "hazards": Case(
        ("terrain=hazards", "terrain.run_in=0", "terrain.spacing=0.4", "seed=3"),
        r"terrain\..*",
        seconds=0.8,
    ),
    "steps": Case(
        (
            "behaviour=stand_step",
            "seed=2000",
            "disturbance=push",
            "disturbance.impulse=45",
            "disturbance.time=0.05",
            "disturbance.direction=60",
        ),
        r"behaviour\.tasks\.(balance|swing)\..*",
        {
            r"behaviour\.tasks\.balance\.aim\.lunge(_margin|_most)?": "of lunges, all together",
            r"behaviour\.tasks\.swing\.aim\.twist": "of turns about the upright",
        },
        seconds=0.8,
    ),
    "turning onto the front": Case(
        ("behaviour=press_up", "start=supine"), r"behaviour\.stages\.0\.(to|lead)"
    ),
    "lying short of the target": Case(
        ("behaviour=turn_over", "behaviour.target_excursion=30"),
        r"behaviour\.stages\.1\.beyond\..*",
        seconds=3.0,
    ),
    "reaching": Case(("behaviour=press_up",), r"behaviour\.stages\.1\.reach\.seconds"),
    "coming to lie first": Case(
        ("behaviour=press_up", "start.speed_x=[2.0,2.0]"),
        r"behaviour\.stages\.0\.until\.speed",
        seconds=0.05,
    ),
    "again": Case(
        (
            "behaviour=rock_up",
            "seed=2012",
            "disturbance=push",
            "disturbance.impulse=200",
            "disturbance.time=2.5",
            "disturbance.direction=180",
        ),
        r"behaviour\.again",
        seconds=3.0,
    ),
    "ways": Case(("behaviour=get_up",), r"behaviour\.ways\.2\.when\.angle", seconds=0.05),
    "patience on a way": Case(
        ("behaviour=get_up", "start=supine"), r"behaviour\.ways\.3\.patience", seconds=1.5
    ),
    "calm on the back": Case(
        ("behaviour=rock_back", "start=side"),
        r"behaviour\.stages\.0\.until\.turning",
        seconds=0.8,
    ),
    "thrown over the shoulders": Case(
        ("behaviour=rock_back",), r"behaviour\.stages\.2\.until\.(after|angle)", seconds=1.0
    ),
    "striding into a cartwheel": Case(
        ("behaviour=cartwheel",),
        r"behaviour\.stages\.1\.(until\.after|tasks\.(carry|stride)\.aim\.(?!law).*)",
        {r".*\.carry\.aim\.angles\.[01]": "of heights that differ"},
        seconds=1.2,
    ),
    "hands of a cartwheel": Case(
        ("behaviour=cartwheel",),
        r"behaviour\.stages\.(2\.until\.distance|3\.tasks\.(carry|reach)\.aim\.(?!law).*)",
        seconds=2.0,
    ),
    "first foot of a cartwheel": Case(
        ("behaviour=cartwheel",),
        r"behaviour\.stages\.6\.tasks\.step_down\.aim\.(room|short)",
        seconds=2.8,
    ),
    "onto the hands": Case(
        ("behaviour=handstand",),
        r"behaviour\.stages\.(1\.glide\.seconds|2\.tasks\.shift\.aim\.(?!law).*)",
        seconds=2.4,
    ),
    "onto one foot": Case(
        ("behaviour=pirouette_one_foot",),
        r"behaviour\.stages\.1\.tasks\.over\.aim\.(?!law).*",
        seconds=1.5,
    ),
    "onto the other foot": Case(
        ("behaviour=pirouette_one_foot",),
        r"behaviour\.stages\.(3\.until\.angle|4\.tasks\.swing\.aim\.(time|lift|width))",
        seconds=2.8,
    ),
    "over the hands": Case(
        ("behaviour=handstand",),
        r"behaviour\.stages\.(3\.until|4\.tasks\.poise\.aim)\.(within|speed|rate|gain|margin)",
        seconds=4.3,
    ),
    "landing": Case(("behaviour=land",), r"start\.falling\..*", seconds=0.1),
    "spawned in the air": Case(("behaviour=flight",), r"start\.aloft\..*", seconds=0.02),
    "arms in the air": Case(
        ("behaviour=flight", "seed=2015"),
        r"behaviour\.stages\.1\.flight\.(levelling|midway)\.(?!pose).*",
        seconds=0.25,
    ),
}


def leaves(data, path=""):
    """Dotted paths and values of all that is no list and no dictionary in plain data."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        here = f"{path}.{key}" if path else str(key)
        if isinstance(value, dict | list | tuple):
            yield from leaves(value, here)
        else:
            yield here, value


def inside(data, parts):
    """What is at a path."""
    for part in parts:
        data = data[int(part) if isinstance(data, list) else part]
    return data


def changed(data, path, value):
    """A copy with another value at a path."""
    made, (*parts, last) = copy.deepcopy(data), path.split(".")
    inner = inside(made, parts)
    inner[int(last) if isinstance(inner, list) else last] = value
    return made


def plain(data):
    """With lists for tuples."""
    if isinstance(data, dict):
        return {key: plain(value) for key, value in data.items()}
    return [plain(value) for value in data] if isinstance(data, list | tuple) else data


def others(data, path, value):
    """Other values that a setting might have, the milder first."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, 2 * value + 3, 1, 0]
    if isinstance(value, float):
        near = [1.2 * value + 0.01, 0.5 * value, value - 0.5]
        far = [0.01 * value, -value, 100.0 * value + 1.0]
        around = inside(data, path.split(".")[:-1])
        if isinstance(around, list) and len(around) == 2:  # a range: nearly shut
            far += [around[0] + 0.01, around[1] - 0.01]
        return [other for other in near + far if other != value]
    if isinstance(value, str):  # a choice: the complaint on a wrong one names them all
        with pytest.raises(InputError) as error:
            build(check(changed(data, path, "no such")))
        return sorted(set(re.findall(r"'(\w+)'", str(error.value))) - {value, "no such"})
    return []


def logged(data):
    """The log of a config, None if it is refused."""
    try:
        buffer, _ = in_memory(build(check(data)))
    except InputError:
        return None
    return buffer.arrays()


def same(one, other):
    """Whether two logs are, but for rounding."""
    for name, array in one.items():
        if array.shape != other[name].shape:
            return False
        if array.dtype.kind in "SUb":
            if not (array == other[name]).all():
                return False
        elif not np.allclose(array, other[name], rtol=0.0, atol=TINY, equal_nan=True):
            return False
    return True


def inert(data, settings):
    """Of these settings those with which nothing changes, whatever their value."""
    usual, found = logged(data), []
    for path, value in settings:
        logs = (logged(changed(data, path, other)) for other in others(data, path, value))
        accepted = False
        for log in logs:
            if log is None:
                continue
            accepted = True
            if not same(usual, log):
                break
        else:
            found += [path] if accepted else []
    return found


@pytest.mark.parametrize("name", CASES)
def test_every_setting_acts(name):
    case = CASES[name]
    data = plain(to_dict(load([*case.overrides, f"duration={case.seconds}"])))
    settings = [
        (path, value)
        for path, value in leaves(data)
        if re.fullmatch(case.keys, path) and not re.fullmatch(NAMES, path) and value is not None
    ]
    assert settings
    found = inert(data, settings)
    assert [path for path in found if not any(re.fullmatch(p, path) for p in case.inert)] == []
    assert [p for p in case.inert if not any(re.fullmatch(p, path) for path in found)] == []


def numbers_of_the_body(data):
    """All numbers of bodies, joints and solid geoms, and their paths."""
    for i, body in enumerate(data["character"]["bodies"]):
        solid = {j for j, geom in enumerate(body["geoms"]) if geom["mass"] > 0}
        for path, value in leaves(body, f"character.bodies.{i}"):
            geom = re.search(r"geoms\.(\d+)", path)
            seen_only = "colour" in path or (geom and int(geom[1]) not in solid)
            if isinstance(value, int | float) and not isinstance(value, bool) and not seen_only:
                yield path, value


@pytest.mark.parametrize("every", [9, pytest.param(1, marks=pytest.mark.slow)])
def test_every_number_of_the_body_acts(every):
    data = plain(to_dict(load(["duration=0.4"])))
    numbers = list(numbers_of_the_body(data))[::every]
    assert len(numbers) > 20
    assert inert(data, numbers) == []
