"""A run as one HTML file that plays in any browser, offline: 3D view and plots.

The page is put together from `static/`: a template, a style sheet and one script, which is
bundled from `static/source/` (see `static/BUILD.md`). Its Content-Security-Policy allows that
script and that style by their hashes and nothing else, whatever a log may say.
"""

from base64 import b64encode
from hashlib import sha256
from html import escape
from importlib.resources import files as resources
from pathlib import Path
from string import Template

from rotctl import __version__
from rotctl.log import RunLog
from rotctl.report import files, gl
from rotctl.report.pack import pack
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
    files.replace(out, page(log, compare).encode())


def page(log: RunLog, compare: RunLog | None = None) -> str:
    """The HTML of a replay; arguments and errors are those of `replay`."""
    gl.not_needed()
    # After that only: importing MuJoCo raises where MUJOCO_GL makes no sense.
    from rotctl.report.replay_data import data

    style, script = _static("replay.css"), _static("replay.js")
    tree, block = pack(data(log, compare))
    top = title(log)
    return Template(_static("replay.html")).substitute(
        policy=_policy(style, script),
        version=escape(__version__),
        name=escape(top.name),
        about=escape(top.about),
        verdict=escape(top.verdict),
        mood={True: "good", False: "bad", None: ""}[top.success],
        other=_other(title(compare)) if compare else "",
        layers=_layers(compare is not None),
        style=style,
        script=script,
        tree=tree,
        bytes=block,
    )


def _policy(style: str, script: str) -> str:
    """Nothing but this very style and this very script; nothing is loaded or sent."""
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src {_hash(script)}",
            f"style-src {_hash(style)}",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )


def _hash(text: str) -> str:
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode('ascii')}'"


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
