"""The report in a real browser, offline: no complaint, in both colour schemes, wide and narrow."""

import io

import numpy as np
import pytest
from browser import PAGE_READY
from here import swept
from PIL import Image

from rotctl.report.site.build import report


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweeps")
    swept(folder, "behaviour=forward_roll_1", "seed=range(0,2)", "duration=1")
    report(folder, folder / "site")
    return folder / "site"


def quiet(browser):
    return (browser.complaints, browser.requests) == ([], [])


@pytest.mark.parametrize("page", ["index.html", "sweeps/*.html"])
@pytest.mark.parametrize("dark", [False, True])
def test_pages_open_wide_and_narrow(browser, site, page, dark):
    (path,) = site.glob(page)
    for width in (1280, 390):
        browser.open(path, width, 900, dark=dark, phone=width < 800, ready=PAGE_READY)
        assert browser.evaluate("document.documentElement.scrollWidth") <= width
        with Image.open(io.BytesIO(browser.screenshot())) as image:
            corner = np.asarray(image.convert("L"))[4, -4]
        assert (corner < 60) == dark
    browser.evaluate("document.querySelectorAll('img').forEach(i => i.loading = 'eager')")
    browser.wait("[...document.images].every(i => i.complete)")
    assert browser.evaluate("[...document.images].every(i => i.naturalWidth > 0)")
    assert browser.evaluate("getComputedStyle(document.querySelector('.top')).display") == "block"
    assert quiet(browser)


def test_the_first_key_press_skips_to_the_results(browser, site):
    browser.open(site / "index.html", ready=PAGE_READY)
    browser.press("Tab")
    assert browser.evaluate("document.activeElement.textContent") == "Skip to the results"


def test_a_replay_finds_the_script_beside_it_and_the_way_back(browser, site):
    assert (pages := sorted(site.glob("replays/*.html")))
    for path in pages:
        browser.open(path)
        browser.click("#play")
        browser.wait("replay.clock.time > 0.2")
        assert browser.evaluate("document.querySelector('.back').href").endswith("/index.html")
        assert quiet(browser)
