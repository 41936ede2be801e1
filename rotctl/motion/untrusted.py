"""Motion files from strangers: bounded text, and YAML that is plain data of a declared shape."""

import os
import re
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import TypeAdapter, ValidationError

from rotctl.errors import InputError

MAX_BYTES = 32_000_000  # minutes of capture
MAX_YAML_BYTES = 2_000_000
MAX_DEPTH = 8
LARGEST = 1e6  # no angle and no length in any unit is as large
# C's parser is five times faster; it may be missing, and both read the same.
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

T = TypeVar("T")


def text_of(path: Path, limit: int = MAX_BYTES) -> str:
    """The text of a file of at most `limit` bytes.

    Raises:
        InputError: `<path>: <reason>`.
    """
    if os.path.isdir(path):
        raise InputError(f"{path}: is a folder")
    if not os.path.isfile(path):  # a pipe or a device may never end
        raise InputError(f"{path}: no such file")
    try:
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if len(content) > limit:
        raise InputError(f"{path}: larger than {limit / 1e6:g} MB")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}:{line}: is no text (UTF-8)") from None


def read_yaml(path: Path, shape: type[T]) -> T:
    """A YAML file as the validated dataclass `shape`.

    Raises:
        InputError: one line that names the file, the bad value and what is valid.
    """
    return parsed(path, text_of(path, MAX_YAML_BYTES), shape)


def parsed(path: Path, text: str, shape: type[T]) -> T:
    """The same of the text of such a file; `path` is for the messages."""
    try:
        _refuse_nesting(path, text)
        data = yaml.load(text, _LOADER)  # safe: plain data only
    except yaml.MarkedYAMLError as error:
        line = f":{error.problem_mark.line + 1}" if error.problem_mark else ""
        raise InputError(f"{path}{line}: is no YAML: {error.problem or error.context}") from None
    except (yaml.YAMLError, ValueError) as error:
        raise InputError(f"{path}: is no YAML: {' '.join(str(error).split()):.200}") from None
    fields = list(shape.__dataclass_fields__)  # type: ignore[attr-defined]
    if not isinstance(data, dict):
        raise InputError(f"{path}: must be keys with values: {', '.join(fields)}")
    try:
        return TypeAdapter(shape).validate_python(data)
    except ValidationError as error:
        raise InputError(f"{path}: {_complaint(error.errors()[0], fields)}") from None


def _refuse_nesting(path: Path, text: str) -> None:
    """Deep nesting overflows the loader's stack, and aliases multiply what they name."""
    depth = 0
    for event in yaml.parse(text, _LOADER):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        line = event.start_mark.line + 1 if event.start_mark else 0
        if depth > MAX_DEPTH:
            raise InputError(f"{path}:{line}: nested more than {MAX_DEPTH} deep")
        if isinstance(event, yaml.AliasEvent):
            raise InputError(f"{path}:{line}: has an alias (*{event.anchor:.40}); write it out")


def _complaint(first: Any, fields: list[str]) -> str:
    """One line on what pydantic found wrong."""
    loc = [str(part) for part in first["loc"]]
    where = ".".join(loc)
    if first["type"] == "unexpected_keyword_argument":
        valid = f"; valid keys: {', '.join(fields)}" if len(loc) == 1 else ""
        return f"unknown key {where!r}{valid}"
    if first["type"] == "missing":
        return f"{where}: missing, it cannot be left out"
    message = first["msg"].removeprefix("Value error, ").partition(" after validation")[0]
    message = re.sub(r"^(Input|List|Dictionary) should", "must", message)
    value = first["input"]
    if isinstance(value, str | int | float):
        where += f"={value!r:.60}"
    return f"{where}: {message}" if where else message


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
