"""What changed between two reports: claims that got better, worse, came or went."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rotctl.errors import InputError
from rotctl.metrics.claims import NOT_TESTED, VERDICTS
from rotctl.report.site.study import Line
from rotctl.report.title import plain

NAME = "claims.csv"
LARGEST = 10_000_000  # [bytes]
Key = tuple[str, str, str]


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
    file = path / NAME if path.is_dir() else path
    try:
        if file.stat().st_size > LARGEST:
            raise InputError(f"{file}: larger than {LARGEST} bytes")
        with file.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
    except FileNotFoundError:
        raise InputError(f"--against {path}: no report, there is no {file}") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{file}: cannot be read: {error}") from None
    found = {}
    for number, row in enumerate(rows, 2):
        key = (row.get("sweep"), row.get("experiment"), row.get("id"))
        verdict = row.get("verdict")
        if verdict not in VERDICTS or None in key:
            raise InputError(f"{file}: line {number} is no claim with its verdict")
        found[tuple(str(part) for part in key)] = verdict
    return found  # type: ignore[return-value]


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
