"""Groups of runs as a table: in Markdown for people, and in files for programs."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pandas as pd

from rotctl import files
from rotctl.metrics import appearance, pace, peaks
from rotctl.metrics.revolutions import OF_REVOLUTIONS
from rotctl.results.groups import QUARTILES, Groups, shown

# Too many for a table that people read: files have them, and a failure names its own.
OF_ROLLS_IN_FILES_ONLY = (
    *OF_REVOLUTIONS,
    "setback",
    "height_least",
    "height_most",
    "lateral_rms",
    "penetration",
    "ground_force_p99",
    "ground_force_peak",
    "jerk",
    "chatter",
    "sticking",
)
IN_FILES_ONLY = {
    *OF_ROLLS_IN_FILES_ONLY,
    *(column.name for kind in (appearance, pace, peaks) for column in kind.COLUMNS),
}
LONGEST = 80  # letters of a value in a table of the command line; files have all of it


def markdown(groups: Groups) -> str:
    """The groups as a Markdown table: rates in percent, other metrics as median [quartiles].

    Keys but the first, and metrics, with one value throughout are told below it, to keep it narrow;
    of metrics that no run has nothing is.
    """
    missing = bool(groups.rows["no_result"].any())
    repeated = bool((groups.rows["distinct"] < groups.rows["n"]).any())
    rows: list[dict[Any, Any]] = groups.rows.to_dict("records")
    told = {m: [_spread(row, m) for row in rows] for m in groups.metrics if m not in IN_FILES_ONLY}
    spreads = {metric: texts for metric, texts in told.items() if set(texts) != {"-"}}
    varying = [metric for metric in spreads if metric not in groups.alike]
    named = {key: [_text(row[key], "g") for row in rows] for key in groups.keys}
    alike = {  # of a long value the text is its beginning
        key: named[key][0]
        for key in groups.keys[1:]
        if all(_text(row[key], "g", None) == _text(rows[0][key], "g", None) for row in rows)
    }
    keys = [key for key in groups.keys if key not in alike]
    counts = {"n": "n"} | ({"distinct": "distinct"} if repeated else {})
    counts |= {"no_result": "no result"} if missing else {}
    lines = [[*keys, *counts.values(), "success [95 %]", *varying]]
    for i, row in enumerate(rows):
        lines.append(
            [
                *(named[key][i] for key in keys),
                *(str(row[count]) for count in counts),
                _rate(row),
                *(spreads[metric][i] for metric in varying),
            ]
        )
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    table = [
        "| " + " | ".join(f"{c:{w}}" for c, w in zip(line, widths, strict=True)) + " |"
        for line in lines
    ]
    shared = {m: next(text for text in spreads[m] if text != "-") for m in spreads}
    alike |= {metric: text for metric, text in shared.items() if metric in groups.alike}
    same = [
        f"{name} {text}"
        for name, text in alike.items()
        if not name.startswith("config.") or alike.get(name.removeprefix("config.")) != text
    ]
    return "\n".join(table + ([f"\nThe same in all runs: {', '.join(same)}."] if same else []))


def _rate(row: Mapping[str, Any]) -> str:
    rate = f"{100 * row['success_rate']:.0f} %" if row["n"] else "-"
    return f"{rate} [{100 * row['success_low']:.0f}, {100 * row['success_high']:.0f}]"


def _spread(row: Mapping[str, Any], metric: str) -> str:
    """Median and quartiles, or the share of yes; of how many runs, where others lack it."""
    if f"{metric}_rate" in row:
        rate = row[f"{metric}_rate"]
        told = "-" if rate is None or rate != rate else f"{100 * rate:.0f} %"
    else:
        low, middle, high = (shown(row[f"{metric}_{name}"]) for name in QUARTILES)
        told = middle if low == middle == high else f"{middle} [{low}, {high}]"
    of = row.get(f"{metric}_n", row["n"])
    return told if of in (0, row["n"]) else f"{told} of {of}"


def _text(value: Any, form: str, longest: int | None = LONGEST) -> str:
    if value is None or value != value:
        return "-"
    text = format(value, form) if isinstance(value, float) else str(value)
    if longest is not None and len(text) > longest:
        text = f"{text[: longest - 3]}..."
    return text.replace("|", "\\|").replace("\n", " ")


def written(folder: Path, runs: pd.DataFrame, groups: pd.DataFrame) -> list[Path]:
    """Write `summary.csv`, `groups.csv`, and `summary.parquet` where pyarrow is installed.

    Raises:
        InputError: one of them cannot be written.
    """
    paths = [folder / "summary.csv", folder / "groups.csv"]
    files.replace(paths[0], files.encoded(runs.to_csv(index=False)))
    files.replace(paths[1], files.encoded(groups.to_csv(index=False)))
    if find_spec("pyarrow"):
        paths.append(folder / "summary.parquet")
        files.replace(paths[2], runs.to_parquet(index=False))
    return paths
