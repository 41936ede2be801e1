"""`@mine.yaml` among overrides: a YAML file of them, each as on a command line.

A file is a list of overrides or a mapping, nested as it pleases: `pace: {keep: rate}` below
`behaviour` is `behaviour.pace.keep=rate`. A text is what stands behind the `=`, so that
`seed: range(0,50)` is several. The words know their lines, for complaints.
"""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from rotctl.errors import InputError
from rotctl.settings import documents

MARK = "@"
MODEL = "character"  # which may be a file, beside this one
MOST = 2000  # overrides of a file
_WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_KEYWORDS = ("true", "false", "null", "nan", "inf")


class Line(str):
    """An override out of a file; `place` is `mine.yaml:3`."""

    place: str

    def __new__(cls, text: str, place: str) -> "Line":
        """An override, and where it stands."""
        made = super().__new__(cls, text)
        made.place = place
        return made


def expanded(words: Iterable[str]) -> list[str]:
    """Overrides with those of files in their files' places.

    Raises:
        InputError: a file is none of overrides; one line that names it and the line in it.
    """
    found: list[str] = []
    for word in words:
        found += of_file(Path(word[len(MARK) :])) if word.startswith(MARK) else [word]
    return found


def of_file(path: Path) -> list[Line]:
    """The overrides of a file.

    Raises:
        InputError: as for `expanded`.
    """
    if path.suffix not in (".yaml", ".yml"):
        raise InputError(f"{MARK}{path}: must be the name of a .yaml file of overrides")
    data, lines = documents.read_with_lines(path)
    if isinstance(data, dict) and "name" in data:  # no key of a config
        use = "GROUP=NAME, where it is conf/GROUP/NAME.yaml"
        if "roll_about" in data and "joints" in data:
            use = f"behaviour.reference.clip={path} of a behaviour that follows one"
        raise InputError(f"{path}: is a choice by itself, not a file of overrides; give {use}")
    found = [Line(text, f"{path}:{lines[way]}") for way, text in _overrides(path, data, lines)]
    if len(found) > MOST:
        raise InputError(f"{path}: has {len(found)} overrides; at most {MOST} are read")
    return found


def blamed(overrides: Iterable[str], complaint: str) -> str:
    """A complaint, with the line of a file before it where one of its overrides is what it names.

    That is the one whose key stands at its beginning, before what would be valid; of several with
    that key the last, be it of a file or not. What ends like it is asked only where none has it.
    """
    head = complaint.partition(";")[0]
    words = {one.lstrip("+~").partition("=")[0]: one for one in overrides}  # the later one counts
    whole = [key for key in words if re.search(rf"(?<![\w.]){re.escape(key)}(?![\w.])", head)]
    named = whole or [key for key in words if f"'{key.rpartition('.')[2]}'" in head]
    word = words[max(named, key=len)] if named else ""
    return f"{word.place}: {complaint}" if isinstance(word, Line) else complaint


def _overrides(
    path: Path, data: Any, lines: dict[documents.Way, int]
) -> Iterator[tuple[documents.Way, str]]:
    if isinstance(data, list):
        for k, text in enumerate(data):
            if not isinstance(text, str):
                raise InputError(f"{path}:{lines[(k,)]}: must be a text, such as seed=3")
            if text.startswith(MARK):
                raise InputError(f"{path}:{lines[(k,)]}: a file names no other one")
            yield (k,), _beside(text, path.parent)
    elif isinstance(data, dict):
        yield from _below((), data, path.parent)
    elif data is not None:
        raise InputError(f"{path}: must be a mapping of keys, or a list of overrides")


def _below(
    way: documents.Way, data: dict[str, Any], folder: Path
) -> Iterator[tuple[documents.Way, str]]:
    """The values below a key; a model of somebody's is one value, as lists are."""
    for name, value in data.items():
        here = (*way, name)
        key = ".".join(map(str, here))
        if key == MODEL and isinstance(value, dict) and ("file" in value or "kind" in value):
            named = isinstance(value.get("file"), str)  # else whoever composes it tells so
            yield here, _model(value, folder) if named else f"{MODEL}={_text(value)}"
        elif isinstance(value, dict) and value:
            yield from _below(here, value, folder)
        elif value is None and key.startswith("~"):
            yield here, key
        else:
            text = f"{key}={value if isinstance(value, str) else _text(value)}"
            yield here, _beside(text, folder)


def _beside(text: str, folder: Path) -> str:
    """An override as it is on a command line; a model that it names lies in a folder."""
    if not text.startswith(f"{MODEL}={{"):
        return text
    from rotctl.choices.overrides import single  # takes Hydra, which most files do without

    try:
        value = single(text).value()
    except InputError:  # whoever composes it tells so
        return text
    if isinstance(value, dict) and isinstance(value.get("file"), str):
        return _model(value, folder)
    return text


def _model(value: dict[str, Any], folder: Path) -> str:
    return f"{MODEL}={_text({**value, 'file': str(folder / value['file'])})}"


def _text(value: Any) -> str:
    """A value in Hydra's grammar."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_text(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_text, value)) + "]"
    if isinstance(value, str):
        if _WORD.fullmatch(value) and value.lower() not in _KEYWORDS:
            return value
        ending = "\\" * (len(value) - len(value.rstrip("\\")))  # before a quote they come twice
        return "'" + re.sub(r"(\\*)'", r"\1\1\\'", value) + ending + "'"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return repr(value)
