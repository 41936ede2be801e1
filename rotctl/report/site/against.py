"""What changed between two reports: claims that got better, worse, came or went."""

import csv
import io
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rotctl import files
from rotctl.errors import InputError
from rotctl.metrics.claims import NOT_TESTED, VERDICTS
from rotctl.report.site.study import Line
from rotctl.report.title import plain

NAME = "claims.csv"
LARGEST = 10_000_000  # [bytes]
Key = tuple[str, str, str]
_KEY = ("sweep", "experiment", "id")


@dataclass(frozen=True)
class Changes:
    """The claims whose verdicts differ, one line each in Markdown.

    Attributes:
        worse: whether a verdict is worse, or a claim that was tested has gone.
    """

    text: str
    worse: bool


def read(path: Path) -> dict[Key, str]:
    """The verdicts of an earlier report.

    Args:
        path: its folder, or its `claims.csv`.

    Raises:
        InputError: there is none.
    """
    folder = os.path.isdir(path)
    file = path / NAME if folder else path
    if not os.path.lexists(file):
        raise InputError(f"--against {path}: no report, there is no {file}")
    text = files.text(file, LARGEST, linked=not folder)
    try:
        head, *rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    except (csv.Error, ValueError):  # no rows at all
        head, rows = [], []
    if not {*_KEY, "verdict"} <= set(head):
        wanted = ", ".join((*_KEY, "verdict"))
        raise InputError(f"{file}: is no {NAME} of a report, its columns must include {wanted}")
    found: dict[Key, str] = {}
    for number, row in enumerate(rows, 1):
        claim = dict(zip(head, row, strict=False))
        if len(row) != len(head) or claim["verdict"] not in VERDICTS:
            raise InputError(f"{file}: row {number} is no claim with its verdict")
        key = (claim["sweep"], claim["experiment"], claim["id"])
        if key in found:
            raise InputError(f"{file}: row {number} judges {plain('/'.join(key))} again")
        found[key] = claim["verdict"]
    return found


def changes(old: Mapping[Key, str], new: Sequence[Line]) -> Changes:
    """Compare an earlier report with the claims of a new one."""
    now = {line.key: line.judged.verdict for line in new}
    groups: dict[str, list[str]] = {"worse": [], "better": [], "new": []}
    for key in dict.fromkeys([*now, *old]):
        before, after = old.get(key), now.get(key)
        if before != after:
            rise = _rank(after) - _rank(before)
            word = "new" if before is None else "better" if rise > 0 else "worse"
            if rise == 0 and after is None:
                continue  # nobody had tested it
            name = plain("/".join(key))
            groups[word].append(f"- {word}: {name}: {before or 'absent'} -> {after or 'absent'}")
    lines = [line for group in groups.values() for line in group]
    return Changes("\n".join(lines or ["no claim changed its verdict"]), bool(groups["worse"]))


def _rank(verdict: str | None) -> int:
    return VERDICTS.index(verdict or NOT_TESTED)
