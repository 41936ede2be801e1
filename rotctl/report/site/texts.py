"""The report for programs and for CI: `claims.csv`, `junit.xml`, `summary.md`, in a stable order.

No times and no machine in them, so that two reports differ where results do.
"""

import csv
import io
import json
from collections.abc import Sequence
from itertools import groupby
from xml.etree import ElementTree as Xml

from rotctl.amounts import count
from rotctl.metrics.claims import NOT_TESTED, REPRODUCED
from rotctl.report.site.study import (
    Line,
    Study,
    answer,
    by_quantity,
    lines,
    question,
    tally,
    warnings,
)
from rotctl.report.site.words import claimed, expectation, outcome
from rotctl.report.title import plain

COLUMNS = (
    *("sweep", "experiment", "id", "verdict", "metric", "comparison", "expected", "tolerance"),
    *("value", "low", "high", "runs", "missing", "where", "source", "remarks"),
)
LONGEST = 400  # characters of a message


def claims_csv(found: Sequence[Line]) -> str:
    """A line a claim; numbers to six digits."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for line in found:
        judged, claim = line.judged, line.judged.claim
        numbers = (judged.measured.value, judged.measured.low, judged.measured.high)
        writer.writerow(
            [
                *(*line.key, judged.verdict, claim.metric, claim.comparison),
                *(f"{claim.expected:.6g}", f"{claim.tolerance:.6g}"),
                *("" if number is None else f"{number:.6g}" for number in numbers),
                *(judged.measured.runs, judged.missing, json.dumps(claim.where), claim.source),
                "; ".join(judged.remarks),
            ]
        )
    return text.getvalue()


def junit_xml(found: Sequence[Line]) -> str:
    """A test case a claim: passed if reproduced, skipped if not tested, else failed."""
    root = Xml.Element("testsuites", name="rotctl report")
    for (sweep, experiment), group in groupby(found, lambda line: line.key[:2]):
        some = list(group)
        tallied = tally(some)
        suite = Xml.SubElement(
            root,
            "testsuite",
            name=plain(f"{sweep}: {experiment}"),
            tests=str(len(some)),
            failures=str(len(some) - tallied[REPRODUCED] - tallied[NOT_TESTED]),
            skipped=str(tallied[NOT_TESTED]),
        )
        for line in some:
            _case(suite, line)
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _case(suite: Xml.Element, line: Line) -> None:
    judged = line.judged
    case = Xml.SubElement(
        suite, "testcase", classname=plain(line.experiment), name=plain(judged.claim.id)
    )
    if judged.verdict != REPRODUCED:
        kind = "skipped" if judged.verdict == NOT_TESTED else "failure"
        Xml.SubElement(case, kind, message=plain(_sentence(line), LONGEST), type=judged.verdict)


def _sentence(line: Line) -> str:
    judged, claim = line.judged, line.judged.claim
    said = f"{judged.verdict}: {claimed(claim)} {expectation(claim)} expected"
    return f"{said}, {outcome(judged)} measured over {count(judged.measured.runs, 'run')}"


def summary_md(found: Sequence[Study], notes: Sequence[str]) -> str:
    """The answer, and a table of the claims, for the summary of a CI job."""
    judged = lines(found)
    parts = [f"# {question(found)}", f"**{answer(judged)}**"]
    if judged:
        parts.append("\n".join(f"- {_escaped(text)}" for text in by_quantity(judged)))
    parts += [f"> {_escaped(note)}" for note in notes]
    for study in found:
        parts.append(f"## {_escaped(study.title)}")
        parts += [f"> {_escaped(text)}" for text in (*warnings(study), *study.sweep.notes)]
        own = lines([study])
        if own:
            parts.append("\n".join(_table(own)))
    return "\n\n".join(parts) + "\n"


def _table(found: Sequence[Line]) -> list[str]:
    rows = [
        (line.judged.claim.id, claimed(line.judged.claim), expectation(line.judged.claim))
        + (outcome(line.judged), str(line.judged.measured.runs), line.judged.verdict)
        for line in found
    ]
    measured = "measured \\[95 % of a rate, else quartiles\\]"
    head = [f"| claim | quantity | expected | {measured} | runs | verdict |", "|" + " --- |" * 6]
    return head + ["| " + " | ".join(map(_escaped, row)) + " |" for row in rows]


def _escaped(text: str) -> str:
    """Text that is no Markdown and no HTML."""
    safe = " ".join(text.split()).replace("&", "&amp;").replace("<", "&lt;")
    return "".join(f"\\{c}" if c in "\\`*_[]|#!" else c for c in safe)
