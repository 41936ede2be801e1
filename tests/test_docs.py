"""The pages: links lead somewhere, lines are no wider than others, all is on the site and told."""

import pkgutil
import re
from importlib import import_module
from pathlib import Path

import pytest

from rotctl import metrics
from rotctl.metrics.columns import Column

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
SITE = sorted([*DOCS.glob("*.md"), *DOCS.glob("trials/*.md")])
PAGES = [*SITE, ROOT / "README.md", ROOT / "CHANGELOG.md"]
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
ALONE = re.compile(r"!?\[[^\]]*\]\([^)\s]+\)[.,]?")
WIDTH = 110
FENCE = re.compile(r"^```.*?^```", flags=re.MULTILINE | re.DOTALL)


def headings(page):
    """What GitHub and the site call the headings of a page."""
    found = re.findall(r"^#+ (.*)$", FENCE.sub("", page.read_text(encoding="utf-8")), re.MULTILINE)
    plain = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in found)
    return {heading.strip().replace(" ", "-") for heading in plain}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for target in LINK.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
        path, _, heading = target.partition("#")
        there = page.parent / path if path else page
        assert "://" in target or there.exists(), target
        if heading:
            assert heading in headings(there), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_lines_of_prose_are_no_longer_than_the_others(page):
    """Tables, code and a link or a picture that stands alone cannot be broken."""
    prose = FENCE.sub("", page.read_text(encoding="utf-8")).splitlines()
    assert [
        line
        for line in prose
        if len(line) > WIDTH and not line.startswith("|") and not ALONE.fullmatch(line)
    ] == []


def test_every_page_is_on_the_site():
    listed = re.findall(r"^([a-z_0-9/]+)$", (DOCS / "index.md").read_text(), re.MULTILINE)
    named = {str(page.relative_to(DOCS).with_suffix("")) for page in SITE}
    assert sorted(listed) == sorted(named - {"index"})


def test_every_column_of_a_summary_is_told():
    page = (DOCS / "log.md").read_text(encoding="utf-8")
    found = pkgutil.walk_packages(metrics.__path__, f"{metrics.__name__}.")
    modules = [import_module(module.name) for module in found]
    named = [c.name for m in modules for c in getattr(m, "COLUMNS", ()) if isinstance(c, Column)]
    assert len(named) > 40
    assert [name for name in named if f"`{name}`" not in page] == []
