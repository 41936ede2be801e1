"""Bounds on motion files from strangers, and the numbers in their lines."""

from pathlib import Path

from rotctl import files
from rotctl.errors import InputError

MAX_BYTES = 32_000_000  # minutes of capture
LARGEST = 1e6  # no angle and no length in any unit is as large


def text_of(path: Path) -> str:
    """The text of a file of at most `MAX_BYTES`.

    Raises:
        InputError: `<path>: <reason>`.
    """
    return files.text(path, MAX_BYTES, linked=True)


def numbers(where: str, words: list[str], count: int) -> list[float]:
    """Exactly `count` numbers.

    Raises:
        InputError: something else; `where` is the file and the line.
    """
    if len(words) != count:
        raise InputError(f"{where}: {len(words)} values, {count} expected")
    for word in words:
        try:
            good = abs(float(word)) < LARGEST  # not so for nan
        except ValueError:
            good = False
        if not good:
            raise InputError(f"{where}: {word!r:.40} is no number")
    return [float(word) for word in words]
