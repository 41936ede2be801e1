"""A replay in a real browser, offline: it plays, obeys, looks right, and runs nobody's script."""

import io
import os
from pathlib import Path

import numpy as np
import pytest
from logs import changed
from PIL import Image

from rotctl.config.loading import load
from rotctl.log import RunLog
from rotctl.report import stored_model
from rotctl.report.replay import replay
from rotctl.runs.run import LOG_NAME, run

STORED = Path(__file__).parent / "pictures" / "replay.png"
SMALL = (160, 120)  # pixels of the stored picture
EVIL = "<script>window.hacked=1</script><img src=x onerror=window.hacked=1>"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """Stands upright and glides along, so that no tuning changes the picture."""
    folder = tmp_path_factory.mktemp("runs")
    rolled = RunLog.open(run(load(["seed=1", "duration=2"]), folder).folder / LOG_NAME)
    states, time = np.zeros_like(rolled["trajectory/qpos"]), rolled["trajectory/time"]
    states[:] = stored_model.load(rolled).qpos0
    states[:, 0] += time
    return changed(rolled, folder, {"trajectory/qpos": states})


@pytest.fixture(scope="module")
def file(log, tmp_path_factory):
    out = tmp_path_factory.mktemp("page") / "replay.html"
    replay(log, out, log)
    return out


def quiet(browser):
    return (browser.complaints, browser.requests) == ([], [])


def test_it_loads_plays_and_stops_at_the_end(browser, file):
    browser.open(file)
    assert browser.evaluate("replay.stage !== null")
    before, picture = browser.evaluate("replay.pose()"), browser.screenshot()
    assert browser.evaluate("document.getElementById('play').ariaLabel") == "Play"
    browser.evaluate("replay.clock.speed = 0")  # not over before it was looked at
    browser.click("#play")
    browser.wait("document.getElementById('play').ariaLabel === 'Pause'")
    browser.evaluate("replay.clock.speed = 4")
    browser.wait("replay.clock.time > 0.5")
    assert abs(np.subtract(browser.evaluate("replay.pose()"), before)).max() > 0.3
    assert browser.screenshot() != picture
    browser.wait("!replay.clock.playing")
    assert browser.evaluate("replay.clock.time === replay.clock.duration")
    assert quiet(browser)


def test_keys_step_seek_speed_up_and_free_the_camera(browser, file):
    browser.open(file)
    steps = [
        (("ArrowRight",), "Math.abs(replay.clock.time - 1 / 30) < 1e-3"),
        (("ArrowLeft",), "replay.clock.time === 0"),
        (("ArrowRight", None, "", True), "replay.clock.time === 1"),
        (("ArrowUp",), "replay.clock.speed === 2"),
        (("ArrowDown",), "replay.clock.speed === 1"),
        (("f", "KeyF", "f"), "document.getElementById('follow').ariaPressed === 'false'"),
        (("End",), "replay.clock.time === replay.clock.duration"),
        (("Home",), "replay.clock.time === 0"),
        ((" ", "Space", " "), "replay.clock.playing"),
        ((" ", "Space", " "), "!replay.clock.playing"),
    ]
    for key, expected in steps:
        browser.press(*key)
        browser.wait(expected)
        if key == ("Home",):
            browser.evaluate("replay.clock.speed = 0")  # not over before it was looked at
    assert quiet(browser)


def test_plots_the_address_and_layers_do_what_they_say(browser, file):
    browser.open(file, fragment="#t=1.5")
    assert browser.evaluate("replay.clock.time") == 1.5
    browser.click(".chart")
    browser.wait("Math.abs(replay.clock.time - 1) < 0.25")
    assert browser.evaluate("document.querySelectorAll('.plot').length") == 5
    assert browser.evaluate("document.querySelector('.key.ghost output').textContent") != ""
    assert browser.evaluate("replay.stage.ghost.group.visible")
    browser.click("[data-layer=ghost]")
    assert not browser.evaluate("replay.stage.ghost.group.visible")


@pytest.mark.parametrize("dark", [False, True])
def test_on_a_phone_it_fits_and_follows_the_colour_scheme(browser, file, dark):
    browser.open(file, 390, 844, dark=dark, phone=True)
    assert browser.evaluate("document.documentElement.scrollWidth") <= 390
    with Image.open(io.BytesIO(browser.screenshot())) as image:
        corner = np.asarray(image.convert("L"))[4, 4]
    assert (corner < 60) == dark
    assert quiet(browser)


def test_it_looks_as_it_did(browser, file):
    browser.open(file, 640, 800, fragment="#t=1")
    box = browser.evaluate(
        "(() => {const b = document.querySelector('.view').getBoundingClientRect();"
        "return [b.left, b.top + 60, b.right, b.bottom];})()"
    )
    with Image.open(io.BytesIO(browser.screenshot())) as image:
        seen = image.convert("RGB").crop(tuple(map(round, box))).resize(SMALL, Image.Resampling.BOX)
    if os.environ.get("ROTCTL_RENEW_PICTURES") == "1":
        STORED.parent.mkdir(exist_ok=True)
        seen.save(STORED, optimize=True)
    with Image.open(STORED) as image:
        difference = np.abs(np.subtract(seen, image.convert("RGB"), dtype=float))
    assert difference.mean() < 6.0, "if it shall look different: ROTCTL_RENEW_PICTURES=1 pytest"


def test_a_strangers_names_run_nothing(browser, log, tmp_path):
    outcome = {"behaviour": EVIL, "success": False, "failure_reason": EVIL}
    hostile = changed(log, tmp_path, outcome=outcome, run_id=EVIL)
    replay(hostile, tmp_path / "replay.html", hostile)
    browser.open(tmp_path / "replay.html")
    assert browser.evaluate("document.querySelector('h1').textContent") == EVIL
    assert browser.evaluate("document.querySelectorAll('img').length") == 0
    assert browser.evaluate("typeof window.hacked") == "undefined"
    assert quiet(browser)


def test_the_policy_stops_what_is_put_in_later(browser, file):
    browser.open(file)
    browser.evaluate(
        "(() => {const s = document.createElement('script'); s.textContent = 'window.hacked=1';"
        "document.body.append(s); const i = new Image(); i.src = 'https://example.org/x.png';"
        "document.body.append(i);})()"
    )
    browser.wait("document.images[0].complete")
    assert browser.evaluate("typeof window.hacked") == "undefined"
    assert browser.requests == []
    assert sum("Content Security Policy" in text for text in browser.complaints) == 2
