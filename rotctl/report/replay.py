"""A run as one HTML file that plays in any browser, offline: 3D view and plots.

The page is put together from `static/`: a template, a style sheet and one script, which is
bundled from `static/source/` (see `static/BUILD.md`). Its Content-Security-Policy allows that
script and that style by their hashes and nothing else, whatever a log may say.
"""

from dataclasses import dataclass
from html import escape
from importlib.resources import files as resources
from pathlib import Path
from string import Template

from rotctl import __version__, files
from rotctl.engine import mujoco_without_opengl
from rotctl.log import RunLog
from rotctl.report.pack import pack
from rotctl.report.policy import BESIDE, policy, this
from rotctl.report.title import Title, title

_LAYERS = (
    ("realised", "used", "Ground force, realised: contact used", True),
    ("dots", "unused dot", "Contact points; grey is left out", True),
    ("predicted", "predicted", "Ground force the controller predicts", True),
    ("trail", "trail", "Centre of mass and its trail", True),
    ("omega", "omega", "Angular velocity \u03c9", True),
    ("momentum", "momentum", "Angular momentum H", True),
)


def replay(log: RunLog, out: Path, compare: RunLog | None = None) -> None:
    """Write a replay.

    Args:
        out: the HTML file; replaced if it is there.
        compare: a run that is laid over as a ghost.

    Raises:
        InputError: `out` cannot be written.
        LogError: a log is damaged or its model is not safe to load.
    """
    files.require_ending(out, ".html", ".htm")
    files.replace(out, files.encoded(page(log, compare)))


@dataclass(frozen=True)
class Site:
    """The site that a replay is one page of.

    Attributes:
        script: address of the script that all its replays share, seen from the page.
        index: address of the page to go back to.
    """

    script: str
    index: str


def page(log: RunLog, compare: RunLog | None = None, site: Site | None = None) -> str:
    """The HTML of a replay; arguments and errors are those of `replay`.

    Args:
        site: None: the page stands alone.
    """
    mujoco_without_opengl()
    # After that only: importing MuJoCo raises where MUJOCO_GL makes no sense.
    from rotctl.report.replay_data import data

    style, script = _static("replay.css"), code()
    told = data(log, compare)
    tree, block = pack(told)
    top = title(log)
    return Template(_static("replay.html")).substitute(
        policy=policy(script=BESIDE if site else this(script), style=this(style)),
        back=f'<a class="back" href="{escape(site.index)}">&larr; report</a>' if site else "",
        version=escape(__version__),
        name=escape(top.name),
        about=escape(top.about),
        verdict=escape(top.verdict),
        mood={True: "good", False: "bad", None: ""}[top.success],
        other=_other(title(compare)) if compare else "",
        arrow=f"{told['arrow']:.2g}",
        layers=_layers(compare is not None),
        style=style,
        script=f'<script src="{escape(site.script)}"></script>'
        if site
        else f"<script>{script}</script>",
        tree=tree,
        bytes=block,
    )


def code() -> str:
    """The script of every replay."""
    return _static("replay.js")


def _other(compared: Title) -> str:
    words = f"compared with {compared.name}, {compared.about}: {compared.verdict}"
    return f'<p class="other">{escape(words)}</p>'


def _layers(compared: bool) -> str:
    """What can be shown and hidden; also the legend."""
    ghost = [("ghost", "ghost", "The run compared with", True)] if compared else []
    return "\n".join(
        f'<label><input type="checkbox" data-layer="{layer}"{" checked" if on else ""}>'
        f'<i class="{look}"></i>{escape(words)}</label>'
        for layer, look, words, on in (*_LAYERS, *ghost)
    )


def _static(name: str) -> str:
    text: str = (resources("rotctl.report") / "static" / name).read_text(encoding="utf-8")
    return text
