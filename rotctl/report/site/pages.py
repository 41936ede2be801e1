"""The HTML of the report, out of `templates/`, with everything escaped that is not ours."""

from collections.abc import Callable
from functools import cache
from importlib.resources import files as resources
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup

from rotctl import __version__
from rotctl.amounts import count
from rotctl.files import encoded
from rotctl.metrics.claims import NOT_REPRODUCED, NOT_TESTED, PARTLY, REPRODUCED
from rotctl.metrics.measured import SUCCESS_RATE
from rotctl.report.policy import BESIDE, policy, this
from rotctl.report.site import words

# What a verdict looks like: not by its colour alone.
LOOKS = {
    REPRODUCED: ("good", "\u2713"),
    PARTLY: ("half", "\u25d0"),
    NOT_REPRODUCED: ("bad", "\u2717"),
    NOT_TESTED: ("none", "\u2013"),
}


def page(template: str, **values: Any) -> bytes:
    """A page.

    Args:
        template: a file in `templates/`.
        values: what it shows.
    """
    style = _read("site.css")
    text = (
        _environment()
        .get_template(template)
        .render(
            values,
            policy=policy(style=this(style), img=BESIDE),
            style=Markup(style),  # ours, and no HTML
            version=__version__,
        )
    )
    return encoded(text)


@cache
def _environment() -> Environment:
    made = Environment(
        loader=FunctionLoader(_read),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    names = ("quantity", "claimed", "number", "with_unit", "outcome", "expectation")
    helpers: dict[str, Callable[..., Any]] = {name: getattr(words, name) for name in names}
    made.globals.update(helpers, count=count, looks=LOOKS, success_rate=SUCCESS_RATE)
    return made


def _read(name: str) -> str:
    text: str = (resources("rotctl.report.site") / "templates" / name).read_text(encoding="utf-8")
    return text
