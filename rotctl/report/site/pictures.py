"""Filmstrips and replays of the runs that stand for a row."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rotctl.errors import RotctlError
from rotctl.files import encoded
from rotctl.log import RunLog
from rotctl.report import replay
from rotctl.report.filmstrip import strip
from rotctl.report.site.rows import Row
from rotctl.report.title import title
from rotctl.results.stored_runs import StoredRun

FRAMES, SIZE = 6, (240, 188)  # of a filmstrip; pixels of a frame
SCRIPT = "replay.js"


@dataclass(frozen=True)
class Picture:
    """What shows one run.

    Attributes:
        role: `median`, `worst`, or where that one succeeded too `least turned` or `poorest`.
        run: seed, run id, and what it is of where runs of several kinds are taken together.
        verdict: how it ended.
        replay: address of its page; empty if there is none.
        strip: address of its filmstrip; empty if there is none.
        trouble: why something is missing.
    """

    role: str
    run: str
    verdict: str
    replay: str
    strip: str
    trouble: str


Put = Callable[[str, bytes], object]


def pictures(row: Row, folder: Path, name: str, put: Put) -> list[Picture]:
    """Draw the median and the worst run of a row.

    Args:
        folder: of the sweep.
        name: what addresses begin with.
        put: takes an address and the content of every file.
    """
    found = []
    if row.median is not None:
        found.append(_picture("median", row, row.median, folder, f"{name}-median", put))
    if row.poorest is not None:
        least = "poorest" if row.poorest.outcome.get("revolutions") is None else "least turned"
        role = least if row.poorest.outcome.get("success") else "worst"
        found.append(_picture(role, row, row.poorest, folder, f"{name}-worst", put))
    return found


def _picture(role: str, row: Row, run: StoredRun, folder: Path, name: str, put: Put) -> Picture:
    address, drawn, trouble = "", "", ""
    which = f", {row.which[run.run_id]}" if row.which else ""
    if not run.log:
        again = f"its log was not kept; rotctl run --again {folder / run.run_id} makes it again"
        return Picture(role, run.run_id + which, "", "", "", f"no replay: {again}")
    try:
        log = RunLog.open(folder / run.log, linked=False)
        log.verify()
        top = title(log)
        site = replay.Site(f"../{SCRIPT}", "../index.html")
        put(f"replays/{name}.html", encoded(replay.page(log, site=site)))
        address = f"replays/{name}.html"
    except RotctlError as error:
        return Picture(role, run.run_id + which, "", "", "", f"no replay: {_short(error, folder)}")
    try:
        put(f"pictures/{name}.png", strip(log, FRAMES, SIZE))
        drawn = f"pictures/{name}.png"
    except RotctlError as error:
        trouble = f"no filmstrip: {_short(error, folder)}"
    return Picture(role, " ".join(top.about.split()) + which, top.verdict, address, drawn, trouble)


def _short(error: RotctlError, folder: Path) -> str:
    return str(error).replace(f"{folder}/", "")
