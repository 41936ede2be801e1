"""The page of plots: its signals against independent sums, its formats, and the words of errors."""

import re

import mujoco
import numpy as np
import pytest
from logs import changed
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.report import plot as module
from rotctl.report import stored_model
from rotctl.report.panels import panels
from rotctl.report.plan import plan
from rotctl.report.plot import plot
from rotctl.report.prints import borne, outlines, prints
from rotctl.report.replay import page
from rotctl.report.rows import drawable, moderate
from rotctl.report.signals import (
    angular_rates,
    joint_group,
    linear_rates,
    signals,
    torque_fractions,
)
from rotctl.report.timeline import contact_bars
from rotctl.runs.run import LOG_NAME, run

ALL = slice(None)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    result = run(load(["seed=1", "duration=1"]), tmp_path_factory.mktemp("runs"))
    return RunLog.open(result.folder / LOG_NAME)


def words(path):
    return re.findall(r"<text[^>]*>([^<]*)</text>", path.read_text(encoding="utf-8"))


def finite_points(path):
    """How many points the lines of a plot have; all of them must be numbers."""
    lines = re.findall(r"<path[^>]* d=\"([^\"]*)\"", path.read_text(encoding="utf-8"))
    numbers = [word for line in lines for word in line.split() if word not in set("MLCQz")]
    assert np.isfinite(np.array(numbers, dtype=float)).all()
    return len(numbers) // 2


# ---------------------------------------------------------------- signals


def test_realised_rates_are_those_of_the_ground_and_gravity(log):
    model = stored_model.load(log)
    weight = model.body_subtreemass[1] * model.opt.gravity
    linear = linear_rates(log, ALL, weight).realised
    angular = angular_rates(log, ALL).realised
    gained = np.diff(log["trajectory/linear_momentum"], axis=0) * 60
    assert np.abs(gained).max() > 500.0
    assert np.corrcoef(linear[:-1].ravel(), gained.ravel())[0, 1] > 0.99
    quiet = [i for i in range(log.steps) if not (log["contacts/body"][i] >= 0).any()]
    np.testing.assert_array_equal(angular[quiet], 0.0)
    row = int(np.argmax((log["contacts/body"] >= 0).sum(axis=1)))
    forces = log["contacts/force_realised"][row].astype(float)
    arms = log["contacts/position"][row].astype(float) - log["trajectory/com"][row]
    np.testing.assert_allclose(linear[row], forces.sum(axis=0) + weight, rtol=1e-5)
    moments = [np.cross(arm, force) for arm, force in zip(arms, forces, strict=True)]
    np.testing.assert_allclose(angular[row], np.sum(moments, axis=0), rtol=1e-9)


def test_units_are_turns_and_the_start_is_zero(log):
    found = signals(log, ALL)
    angle = log["trajectory/angular_excursion"]
    np.testing.assert_allclose(2 * np.pi * found.turns[:, 1], angle[:, 1] - angle[0, 1])
    np.testing.assert_allclose(2 * np.pi * found.spin, log["trajectory/angular_velocity"])
    assert (found.commanded_spin, found.commanded_speed) == (1.3, 1.2)
    assert (found.used <= found.count).all()
    assert (found.force_peak >= found.force - 1e-9).all()
    height = log["trajectory/com"][:, 2] - log["trajectory/ground_height"]
    np.testing.assert_array_equal(found.height, height)


@pytest.mark.parametrize("value", [None, "1.3", True, 1e10])
def test_a_command_that_is_no_number_is_none(log, tmp_path, value):
    outcome = {"angular_velocity_commanded": value}
    assert np.isnan(signals(changed(log, tmp_path, outcome=outcome), ALL).commanded_spin)


@pytest.mark.parametrize(
    ("outcome", "until"),
    [
        ({}, 0.5),
        ({"finish_commanded": 0.3}, 0.3),
        ({"finish_commanded": 0.8}, 0.5),
        ({"finish_commanded": 0.0, "revolutions_told": 0.1}, 0.5),
    ],
)
def test_what_is_commanded_ends_where_the_roll_does(log, tmp_path, outcome, until):
    """In the plots and beside the replay: told to end, or, of one that counts, standing up."""
    row = int(np.argmax(log["trajectory/time"] >= 0.5 - 1e-9))
    stage = (np.arange(log.steps) >= row).astype(np.int32)
    both = {"angular_velocity_commanded": 0.6, "speed_commanded": 1.0}
    ends = changed(log, tmp_path, {"command/stage": stage}, outcome=both | outcome)
    found = signals(ends, ALL)
    np.testing.assert_allclose(found.commanded_time, [0.0, until])
    lines = [
        line
        for panel in panels(found, None)
        for line in panel["series"]
        if line["role"] == "commanded"
    ]
    assert [float(line["time"][-1]) for line in lines] == pytest.approx([until] * 3)
    assert float(lines[1]["values"][-1]) == pytest.approx(0.6 * until)
    later = signals(ends, slice(row + 1, None))
    assert len(later.commanded_time) == 0
    assert not any(
        line["role"] == "commanded" for panel in panels(later, None) for line in panel["series"]
    )
    plot(ends, tmp_path / "late.svg", start=0.6)
    assert "wanted" in words(tmp_path / "late.svg")  # of the momenta's rates alone
    assert words(tmp_path / "late.svg").count("wanted") == 1


def test_iterations_have_an_axis_where_the_solver_tells_them(log, tmp_path):
    plot(log, tmp_path / "none.svg")
    some = {"solver/iterations": np.full(log.steps, 7, dtype=np.int32)}
    plot(changed(log, tmp_path, some), tmp_path / "some.svg")
    assert not any("iterations" in word for word in words(tmp_path / "none.svg"))
    assert {"iterations", "iterations (right)"} <= set(words(tmp_path / "some.svg"))


def test_a_blend_is_shown_where_there_are_two_poses_to_blend(log, tmp_path):
    flat = changed(log, tmp_path, {"trajectory/blend": np.full(log.steps, 0.5)})
    plot(flat, tmp_path / "flat.svg")
    assert not any("pose" in word or "Blend" in word for word in words(tmp_path / "flat.svg"))
    assert "Contacts" in words(tmp_path / "flat.svg")
    blends, still = signals(log, ALL), signals(flat, ALL)
    pairs = [(blends, None), (still, None), (still, blends), (blends, still)]
    shown = [any("Blend" in panel["title"] for panel in panels(*pair)) for pair in pairs]
    assert shown == [True, False, True, True]


def test_joints_are_grouped_over_sides_and_axes(log):
    assert [joint_group(name) for name in ("hip_y_l", "knee_r", "waist_z")] == [
        "hip",
        "knee",
        "waist",
    ]
    groups = torque_fractions(log, ALL)
    fraction = np.abs(log["trajectory/ctrl"]) / log["model/torque_limit"]
    assert max(each.max() for each in groups.values()) == fraction.max()
    assert {"waist", "hip", "knee", "ankle"} <= set(groups)


def test_bars_cover_exactly_the_rows_with_contact(log):
    model = stored_model.load(log)
    bars, time = contact_bars(log, ALL, model), log["trajectory/time"]
    for name, of_part in bars.items():
        touches = log["contacts/body"] == model.body(name).id
        covered, used = np.zeros(len(time), bool), np.zeros(len(time), bool)
        for bar in of_part:
            inside = (time >= bar.start - 1e-6) & (time < bar.start + bar.duration - 1e-6)
            covered |= inside
            used |= inside & bar.used
        np.testing.assert_array_equal(covered, touches.any(axis=1))
        np.testing.assert_array_equal(used, (touches & log["contacts/used"]).any(axis=1))
    assert bars


# ---------------------------------------------------------------- the page


def test_png_pdf_and_svg(log, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "DOTS", 80)
    for ending, magic in ((".png", b"\x89PNG"), (".PDF", b"%PDF"), (".svg", b"<?xml")):
        out = tmp_path / f"plot{ending}"
        plot(log, out)
        assert out.read_bytes().startswith(magic)
    with Image.open(tmp_path / "plot.png") as image:
        assert image.size == tuple(int(80 * side) for side in module.SIZE)
        assert len(image.convert("RGB").getcolors(10**7)) > 50
    said = words(tmp_path / "plot.svg")
    assert {"realised", "predicted", "wanted", "rev/s", "N m", "used", "left out"} <= set(said)
    assert {"Blend γ", "Torque as a fraction of its limit", "Contacts by body part"} <= set(said)
    assert {"Ground force", "body weights", "Centre of mass above the ground"} <= set(said)


def test_the_same_log_gives_the_same_bytes_and_a_window_shows_less(log, tmp_path):
    first, second = tmp_path / "a.svg", tmp_path / "b.svg"
    plot(log, first, start=0.2, end=0.6)
    plot(log, second, start=0.2, end=0.6)
    assert first.read_bytes() == second.read_bytes()
    assert "0.8" not in words(first)


def test_a_strangers_names_are_text(log, tmp_path):
    evil = "<script>$\\frac{$</script>"
    outcome = {"behaviour": evil, "success": False, "failure_reason": evil}
    hostile = changed(log, tmp_path, outcome=outcome, run_id=evil)
    plot(hostile, tmp_path / "plot.svg")
    assert "<script" not in (tmp_path / "plot.svg").read_text(encoding="utf-8")
    assert "&lt;script&gt;$\\frac{$&lt;/script&gt;" in words(tmp_path / "plot.svg")


def test_a_run_that_broke_down_is_plotted_until_there(log, tmp_path):
    states, rates = log["trajectory/qpos"].copy(), log["trajectory/angular_velocity"].copy()
    states[20:], rates[10:20] = np.nan, np.inf
    arrays = {"trajectory/qpos": states, "trajectory/angular_velocity": rates}
    arrays["trajectory/linear_momentum_rate_desired"] = np.full_like(rates, np.nan)
    broken = changed(log, tmp_path, arrays)
    plot(log, tmp_path / "whole.svg")
    plot(broken, tmp_path / "plot.svg")
    assert finite_points(tmp_path / "plot.svg") < finite_points(tmp_path / "whole.svg")
    states[1:] = np.nan
    plot(changed(log, tmp_path, {"trajectory/qpos": states}), tmp_path / "plot.svg")
    assert finite_points(tmp_path / "plot.svg") > 0


@pytest.mark.parametrize("value", [1e308, 1e6, np.nan, -1e308])
def test_times_that_no_run_has_are_not_shown(log, tmp_path, value):
    time = log["trajectory/time"]
    time[40:] = value
    broken = changed(log, tmp_path, {"trajectory/time": time})
    assert len(drawable(broken, broken["trajectory/qpos"])) == 40
    plot(broken, tmp_path / "plot.svg")
    plot(changed(log, tmp_path, {"trajectory/time": np.zeros(60)}), tmp_path / "plot.svg")
    time[:] = value
    with pytest.raises(LogError, match=r"has no step that could be drawn$"):
        plot(changed(log, tmp_path, {"trajectory/time": time}), tmp_path / "plot.svg")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["com", "com_velocity", "angular_momentum", "angular_excursion"])
def test_numbers_that_are_too_large_are_gaps(log, tmp_path, name):
    array = log[f"trajectory/{name}"]
    array[::2] = 1e308
    broken = moderate(changed(log, tmp_path, {f"trajectory/{name}": array}))
    assert np.isnan(broken[f"trajectory/{name}"][::2]).all()
    assert np.array_equal(broken[f"trajectory/{name}"][1::2], array[1::2])
    plot(broken, tmp_path / "plot.svg")
    page(broken)


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("plot.jpg", {}, "{out}: valid endings: .png, .svg, .pdf"),
        ("plot", {}, "{out}: valid endings: .png, .svg, .pdf"),
        ("plot.png", {"start": -1.0}, "start (--from) is -1 s, valid: 0 to 0.983333 s"),
        ("plot.png", {"end": 2.0}, "end (--to) is 2 s, valid: 0 to 0.983333 s"),
        (
            "plot.png",
            {"start": 0.5, "end": 0.5},
            "start (--from) is 0.5 s, valid: less than end = 0.5 s",
        ),
        ("nowhere/plot.svg", {}, "cannot write {out}: No such file or directory"),
    ],
)
def test_bad_arguments_are_named(log, tmp_path, name, arguments, message):
    out = tmp_path / name
    with pytest.raises(InputError) as caught:
        plot(log, out, **arguments)
    assert str(caught.value) == message.format(out=out)
    assert not list(tmp_path.iterdir())


def test_a_model_that_names_files_is_refused(log, tmp_path):
    hostile = log.model_xml.replace("<worldbody>", "<worldbody><include file='/etc/passwd'/>")
    with pytest.raises(LogError) as caught:
        plot(changed(log, tmp_path, model_xml=hostile), tmp_path / "plot.svg")
    assert str(caught.value) == (
        f"{tmp_path / 'changed.h5'}: model/mjcf has <include>, which a log's model may not have"
    )


def test_the_command_writes_beside_the_log(log, capsys):
    assert main(["plot", str(log.path), "--from", "0.5"]) == 0
    out = log.path.with_name("plot.png")
    assert capsys.readouterr() == (f"{out}\n", "")
    assert out.stat().st_size > 50_000
    assert main(["plot", "nothing.h5"]) == 2
    assert capsys.readouterr() == ("", "rotctl: nothing.h5: no such file\n")


# ---------------------------------------------------------------- from above


def test_a_plan_has_the_way_and_where_it_rolled(tmp_path):
    config = load(["behaviour=forward_roll", "+course=circle", "duration=3", "seed=2003"])
    folder = run(config, tmp_path).folder
    out = tmp_path / "plan.svg"
    assert main(["plot", str(folder / LOG_NAME), "--from-above", "--out", str(out)]) == 0
    assert {"the way", "centre of mass", "trunk's axis, once a revolution", "0 s"} <= {*words(out)}


def test_a_plan_of_who_rolls_straight_on_has_no_way(log, tmp_path):
    out = tmp_path / "plan.svg"
    plan(log, out)
    assert "the way" not in words(out)
    with pytest.raises(InputError, match=r"plan\.txt"):
        plan(log, tmp_path / "plan.txt")


# ---------------------------------------------------------------- prints


def test_a_print_is_on_the_surface_of_what_bore_it(log):
    """By MuJoCo's own geoms: a contact lies on one of its body's, to within the overlap."""
    mj = stored_model.load(log)
    body, place, load, row = borne(log, mj, ALL)
    assert len(body) > 50
    assert load.min() > 0.02
    assert row.max() < log.steps
    data = mujoco.MjData(mj)
    mujoco.mj_kinematics(mj, data)
    for which, there in list(zip(body, place, strict=True))[::25]:
        spot = data.xpos[which] + data.xmat[which].reshape(3, 3) @ there
        gaps = []
        for geom in np.flatnonzero((mj.geom_bodyid == which) & (mj.geom_contype > 0)):
            axis = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            half = mj.geom_size[geom, 1] if mj.geom_type[geom] == 3 else 0.0
            along = np.clip((spot - data.geom_xpos[geom]) @ axis, -half, half)
            off = np.linalg.norm(spot - data.geom_xpos[geom] - along * axis)
            gaps.append(off - mj.geom_size[geom, 0])
        assert min(np.abs(gaps)) < 0.03


def test_prints_read_each_dataset_once(log):
    """A read unpacks the whole dataset: of a long run one for each print took a minute."""
    names = []

    class Counted:
        def __getitem__(self, name):
            names.append(name)
            return log[name]

    borne(Counted(), stored_model.load(log), ALL)
    assert "trajectory/qpos" in names
    assert len(names) == len(set(names))


def test_outlines_are_as_tall_as_the_body():
    from rotctl.runs.scenario import model_of

    mj = model_of(load([])).mj
    data = mujoco.MjData(mj)
    mujoco.mj_kinematics(mj, data)
    found = np.concatenate(outlines(mj, data))
    assert np.ptp(found[:, 1]) == pytest.approx(1.75, abs=0.02)
    assert found[:, 0].min() == pytest.approx(-found[:, 0].max())


def test_prints_are_drawn(log, tmp_path):
    prints(log, tmp_path / "prints.svg")
    assert "phase of the roll [rev]" in " ".join(words(tmp_path / "prints.svg"))
    again = tmp_path / "again.svg"
    prints(log, again)
    assert again.read_bytes() == (tmp_path / "prints.svg").read_bytes()
    assert main(["plot", str(log.path), "--from-behind", "--out", str(tmp_path / "p.png")]) == 0
    with pytest.raises(InputError, match="valid: 0 to 0.983"):
        prints(log, tmp_path / "x.png", 9.0, 9.5)


def test_a_long_reason_ends_where_the_page_does(log, tmp_path):
    outcome = {"behaviour": "roll", "success": False, "failure_reason": "much to say " * 20}
    long = changed(log, tmp_path, outcome=outcome)
    figure = Figure(figsize=module.SIZE)
    FigureCanvasAgg(figure)
    module.heading(figure, long)
    verdict = figure.texts[-1].get_window_extent()
    assert figure.texts[-1].get_text().startswith("FAILED: much")
    assert verdict.x1 <= 0.936 * figure.bbox.width


def test_rates_are_told_along_the_way(log, tmp_path):
    """As they are drawn: forward is x only for a heading of 0."""
    plot(log, tmp_path / "plot.svg")
    told = words(tmp_path / "plot.svg")
    assert {"dL/dt, forward", "dL/dt, left", "dH/dt, left (in-plane)", "dH/dt, up"} <= {*told}


def test_what_is_nothing_is_drawn_as_0(log, tmp_path):
    """And not as a billionth, whose power of ten would stand over the title."""
    arrays = log.arrays()
    names = [name for name in arrays if "_momentum_rate_" in name]
    none = {name: np.zeros_like(arrays[name]) for name in names}
    none["contacts/body"] = np.full_like(arrays["contacts/body"], -1)
    plot(changed(log, tmp_path, none), tmp_path / "plot.svg")
    assert not any(word.startswith("1e") for word in words(tmp_path / "plot.svg"))
