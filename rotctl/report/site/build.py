"""The whole report: out of the runs below a folder, one static folder that any server can serve."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rotctl.files import encoded
from rotctl.report import replay
from rotctl.report.site import pages, texts
from rotctl.report.site.charts import charts
from rotctl.report.site.folder import write
from rotctl.report.site.grid import grid
from rotctl.report.site.origin import origin
from rotctl.report.site.pictures import SCRIPT, Picture, pictures
from rotctl.report.site.rows import Row
from rotctl.report.site.study import (
    Line,
    Study,
    answer,
    by_quantity,
    lines,
    of_a_paper,
    question,
    studies,
    tally,
    warnings,
)
from rotctl.report.site.words import Names
from rotctl.results.configs import config_hash
from rotctl.results.groups import grouped
from rotctl.results.sweeps import Sweep, sweeps

MOST_DRAWN = 12  # rows with pictures and replays: about 2 s and 0.6 MB each
MOST_LISTED = 200  # groups in the table of a page
Files = dict[str, bytes]  # address -> content


def report(
    folder: Path,
    out: Path,
    progress: Callable[[int, int], object] = lambda done, total: None,
) -> list[Line]:
    """Make a report.

    Args:
        folder: of a sweep, or of several.
        out: what an earlier report left there is replaced, other files stay.
        progress: called with how much is done of how much.

    Returns:
        The claims, judged.

    Raises:
        InputError: there are no runs below `folder`, or `out` cannot be written.
    """
    found, notes = sweeps(folder)
    every = [study for sweep in found for study in studies(sweep)]
    total = min(MOST_DRAWN, sum(len(study.rows) for study in every)) + len(found)
    steps = iter(range(1, total + 1))
    files: Files = {}
    names = Names()
    shown: list[tuple[Study, list[str], list[Shown]]] = []
    left = MOST_DRAWN
    for study in every:
        shown.append((study, warnings(study), []))
        for row in study.rows:
            into = files if left > 0 else None
            shown[-1][2].append(_shown(row, study, names.give(row.name), into))
            left -= 1
            if into is not None:
                progress(next(steps), total)
    names, addresses = Names(), {}
    for sweep in found:
        addresses[sweep.name] = _page_of(sweep, names.give(sweep.name), files)
        progress(next(steps), total)
    claims = lines(every)
    files |= {
        SCRIPT: replay.code().encode(),
        "claims.csv": encoded(texts.claims_csv(claims)),
        "junit.xml": encoded(texts.junit_xml(claims)),
        "summary.md": encoded(texts.summary_md(every, notes)),
        "index.html": pages.page(
            "index.html",
            question=question(every),
            paper=of_a_paper(every),
            answer=answer(claims),
            tally=tally(claims),
            total=len(claims),
            by_quantity=by_quantity(claims),
            notes=notes,
            studies=shown,
            addresses=addresses,
            sweeps=[(sweep, addresses[sweep.name], origin(sweep)) for sweep in found],
        ),
    }
    write(files, out)
    return claims


@dataclass(frozen=True)
class Shown:
    """A row as the page shows it.

    Attributes:
        anchor: where it stands on the page.
        pictures: of its median and its worst run.
        config: hash of its median run's config; empty without one.
    """

    row: Row
    anchor: str
    pictures: list[Picture]
    config: str


def _shown(row: Row, study: Study, name: str, files: Files | None) -> Shown:
    """A row, with its pictures put into `files`; without pictures where that is None."""
    made = []
    if files is not None:
        made = pictures(row, study.sweep.folder, name, files.__setitem__)
    return Shown(row, f"row-{name}", made, config_hash(row.median.config) if row.median else "")


def _page_of(sweep: Sweep, name: str, files: Files) -> str:
    """Put the page of a sweep and its charts and groups into `files`; its address."""
    laid_out = grid(sweep.table)
    made = charts(laid_out)
    for chart in made:
        files[f"charts/{name}-{chart.name}-light.svg"] = chart.light
        files[f"charts/{name}-{chart.name}-dark.svg"] = chart.dark
    groups = grouped(sweep.table).rows
    files[f"sweeps/{name}.csv"] = encoded(groups.to_csv(index=False))
    address = f"sweeps/{name}.html"
    files[address] = pages.page(
        "sweep.html",
        sweep=sweep,
        name=name,
        charts=made,
        metrics=laid_out.metrics,
        groups=laid_out.groups.head(MOST_LISTED).to_dict("records"),
        more=max(0, len(groups) - MOST_LISTED),
        notes=[*sweep.notes, *laid_out.notes],
    )
    return address
