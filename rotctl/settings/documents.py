"""YAML from strangers to plain data: numbers, texts, lists and dicts of them.

Nothing is executed, looked up or multiplied without bound: no tags, no keys twice, bounded depth,
digits and aliases, no character that neither YAML nor a terminal would show. A date stays a text.
No message repeats a syntax error's line: the file may not be what its name says, and messages end
up in reports.
"""

import re
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from rotctl import files
from rotctl.errors import InputError

LARGEST = 2_000_000  # bytes of a YAML file; people write them
MOST_VALUES = 200_000  # of a YAML file: a clip of 3600 samples has a hundred thousand
DEEPEST = 12  # lists and dicts within each other
MOST_DIGITS = 40  # of a whole number

# All but what YAML calls printable. JSON's escapes can spell half a surrogate pair too.
UNPRINTABLE = re.compile("[^\t\n\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
# C's parser is five times faster; it may be missing, and both read the same.
_C = hasattr(yaml, "CSafeLoader")
_Safe: Any = yaml.CSafeLoader if _C else yaml.SafeLoader
_TYPE = "tag:yaml.org,2002:"
_PLAIN = ("null", "bool", "int", "float")  # what a value without quotes may be beside a text


class _Refused(yaml.MarkedYAMLError):
    """Good YAML, but more than plain data."""


class _Loader(_Safe):  # type: ignore[misc]
    """YAML's own types without dates, merged keys and tags."""

    def construct_scalar(self, node: Any) -> str:
        """A text, or what a number is made of."""
        value: str = super().construct_scalar(node)
        if UNPRINTABLE.search(value):
            raise _at(node, "a text has a control character")
        return value

    def construct_yaml_int(self, node: Any) -> int:
        """A whole number."""
        if len(node.value) > MOST_DIGITS:
            raise _at(node, f"a number has more than {MOST_DIGITS} digits")
        number: int = super().construct_yaml_int(node)
        return number

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        """A dict; a key that comes twice would hide a value."""
        keys = set()
        for key, _ in node.value:
            if key.tag != f"{_TYPE}str":
                raise _at(key, "a key is no text; put it in quotes")
            if key.value in keys:
                raise _at(key, "a key comes twice")
            keys.add(key.value)
        found: dict[Any, Any] = super().construct_mapping(node, deep)
        return found


_Loader.yaml_implicit_resolvers = {
    first: [(tag, form) for tag, form in pairs if tag.removeprefix(_TYPE) in _PLAIN]
    for first, pairs in _Safe.yaml_implicit_resolvers.items()
}
_Loader.add_constructor(f"{_TYPE}int", _Loader.construct_yaml_int)


def read_yaml(path: Path, most: int = MOST_VALUES, *, linked: bool) -> Any:
    """The data of a YAML file; None if there are none.

    Args:
        most: values that it may have, those of aliases counted each time.
        linked: whether the path may be a symbolic link, see `files.opened`.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    return from_yaml(str(path), files.text(path, LARGEST, linked=linked), most)


Way: TypeAlias = tuple[str | int, ...]  # keys and places that lead to a value


def read_with_lines(path: Path) -> tuple[Any, dict[Way, int]]:
    """The data of a YAML file, and the line of each key and of each element of a list.

    Raises:
        InputError: as for `read_yaml`.
    """
    text = files.text(path, LARGEST, linked=True)
    data = from_yaml(str(path), text)
    lines: dict[Way, int] = {}
    waiting: list[tuple[Way, Any]] = [((), yaml.compose(text, _Loader))]
    while waiting:  # of an alias the lines are its anchor's
        way, node = waiting.pop()
        if isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                lines[(*way, key.value)] = key.start_mark.line + 1
                waiting.append(((*way, key.value), value))
        elif isinstance(node, yaml.SequenceNode):
            for k, value in enumerate(node.value):
                lines[(*way, k)] = value.start_mark.line + 1
                waiting.append(((*way, k), value))
    return data, lines


def from_yaml(where: str, text: str, most: int = MOST_VALUES) -> Any:
    """The data of a YAML text; `where` it is from is for the messages."""
    if len(text) > LARGEST:
        raise InputError(f"{where}: larger than {LARGEST / 1e6:g} MB")
    try:
        _check(text, most)
        return yaml.load(text, _Loader)  # safe: plain data only
    except yaml.MarkedYAMLError as error:
        line = f":{error.problem_mark.line + 1}" if error.problem_mark else ""
        raise InputError(f"{where}{line}: {_reason(error, text)}") from None
    except (yaml.YAMLError, ValueError):
        raise InputError(f"{where}: is no YAML: it has a control character") from None


def _check(text: str, most: int) -> None:
    """Refuse what would cost more than it looks like, before anything is built.

    An alias stands for all that its anchor holds, and aliases of aliases multiply.
    """
    known: dict[str, tuple[int, int]] = {}  # anchor -> values, and how deep they are nested
    within: list[tuple[str | None, int, int]] = []  # what is open: anchor, values before, depth
    count = 0
    for event in yaml.parse(text, _Loader):
        anchor: str | None = getattr(event, "anchor", None)
        if getattr(event, "tag", None) is not None:
            raise _at(event, "has a tag; write plain values")
        if isinstance(event, yaml.CollectionEndEvent):
            anchor, before, depth = within.pop()
            size, depth = count - before, depth + 1
        elif isinstance(event, yaml.AliasEvent):
            if anchor not in known:
                raise _at(event, "has an alias of what it is in, or of nothing")
            size, depth = known[anchor]
            count += size
        elif isinstance(event, yaml.NodeEvent):
            size, depth = 1, 0
            count += 1
        else:
            continue  # of the stream
        if isinstance(event, yaml.CollectionStartEvent):
            within.append((anchor, count - 1, 0))
        else:
            known |= {anchor: (size, depth)} if anchor else {}
            if within:
                name, before, deepest = within[-1]
                within[-1] = name, before, max(deepest, depth)
        if len(within) + depth > DEEPEST:  # would overflow the loader's stack
            raise _at(event, f"nested more than {DEEPEST} deep")
        if count > most:
            raise _at(event, f"has more than {most} values")


def _reason(error: yaml.MarkedYAMLError, text: str) -> str:
    if isinstance(error, _Refused):
        return str(error.problem)
    lines, mark = text.split("\n"), error.problem_mark
    line = lines[mark.line] if mark and mark.line < len(lines) else ""
    if "\t" in line[: len(line) - len(line.lstrip())]:
        return "is no YAML: the line begins with a tab, and YAML indents with spaces"
    # C's texts are fixed, while Python's parser quotes.
    texts = filter(None, (error.context, error.problem)) if _C else ()
    return ": ".join(filter(None, ("is no YAML", ", ".join(texts))))


def _at(place: Any, problem: str) -> _Refused:
    return _Refused(problem=problem, problem_mark=place.start_mark)
