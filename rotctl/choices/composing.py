"""What choices of config groups make together: what Hydra would make of them, without it.

To import Hydra and to compose with it takes longer than to simulate ten seconds. Most configs are
plain: files whose defaults name others of their group or of one that is about a part of theirs, or
choices for other groups, and that may say in a first line `# @package` which key they are about.
These are composed here; for whatever else is in a file Hydra is asked. A test holds all that is
shipped to what Hydra makes.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from rotctl import files
from rotctl.choices.config_folders import conf_dir
from rotctl.choices.contents import content, require_plain
from rotctl.choices.listing import choices, named_file, shipped_files
from rotctl.errors import InputError
from rotctl.settings import documents, plain

_KEY = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*", re.ASCII)
_INTEGER = re.compile(r"[+-]?(?:0|[1-9][0-9]{0,17})")
_FLOAT = re.compile(r"[+-]?(?:0|[1-9][0-9]*)\.[0-9]+(?:e[+-]?[0-9]+)?")
_WORD = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_NO_WORDS = ("true", "false", "null", "inf", "nan")  # what YAML or Hydra takes for more
_PACKAGE = re.compile(r"# @package ([A-Za-z]\w*(?:\.[A-Za-z]\w*)*)\n", re.ASCII)
_ELSEWHERE = re.compile(r"override /(\w+)@_global_\.\1")
_WITHIN = re.compile(r"/(\w+)")
SELF, MISSING = "_self_", "???"
IN_A_CIRCLE = "defaults: a file builds on itself, or on what builds on it"


class Assignment(NamedTuple):
    """A value for a key, or the choice of a group, with a `+` where it is added to a config."""

    key: str
    value: Any


def simple(override: str) -> Assignment | None:
    """An override that is a number or a word; None for whatever needs Hydra's grammar.

    Of what is added, only choices are taken.
    """
    key, _, text = override.partition("=")
    bare = key.removeprefix("+")
    if len(override) > documents.DEEPEST**2 or not _KEY.fullmatch(bare) or bare.startswith("hydra"):
        return None
    if bare != key and text not in choices(bare):
        return None
    if _INTEGER.fullmatch(text):
        return Assignment(key, int(text))
    if _FLOAT.fullmatch(text):
        return Assignment(key, float(text))
    if _WORD.fullmatch(text) and text.lower() not in _NO_WORDS:
        return Assignment(key, text)
    return None


def chosen(overrides: Iterable[str]) -> list[Assignment]:
    """The choices among overrides."""
    return [one for one in map(simple, overrides) if one and choices(one.key)]


def composed(chosen: Iterable[Assignment]) -> dict[str, Any] | None:
    """The config of the choices alone; None where Hydra has to be asked, who may read their files.

    Raises:
        InputError: a file is wrong; one line that names it.
    """
    every = list(chosen)
    try:
        return _composed(every)
    except _NotPlainError:
        require_plain([(key.removeprefix("+"), name) for key, name in every])
        return None
    except RecursionError:
        raise InputError(IN_A_CIRCLE) from None


class _NotPlainError(Exception):
    """More than is made here."""


class _File(NamedTuple):
    """A file of a group.

    Attributes:
        others: what it builds on, of its own group ("") or of another that is about a part of it,
            and `SELF`, in the order in which they are merged.
        asks: group -> choice, for other groups.
        package: the key that it is about, if not its group.
    """

    own: dict[str, Any]
    others: tuple[tuple[str, str], ...]
    asks: Mapping[str, str]
    package: str


def _composed(chosen: Sequence[Assignment]) -> dict[str, Any]:
    root = content(conf_dir() / "config.yaml")
    listed = [entry for entry in root.get("defaults", []) if entry != SELF]
    if root.get("defaults", [])[-1:] != [SELF] or not all(isinstance(e, dict) for e in listed):
        raise _NotPlainError
    usual = {group: name for entry in listed for group, name in entry.items()}
    asked = {key: name for key, name in chosen if not key.startswith("+")}
    more = [(key.removeprefix("+"), name) for key, name in chosen if key.startswith("+")]
    added = dict(more)
    known = asked.keys() <= usual.keys() and not added.keys() & usual.keys()
    if not known or len(usual) != len(listed) or len(added) != len(more):
        raise _NotPlainError
    asked |= added
    settled: set[str] = set()
    for group in reversed([*usual, *added]):  # who comes later may ask for what comes before
        settled.add(group)
        for other, name in _asks(group, asked.setdefault(group, usual.get(group, ""))):
            if other not in usual or other in settled:
                raise _NotPlainError
            asked.setdefault(other, name)
    data: dict[str, Any] = {}
    for group in usual:
        data = _merged(data, _placed(group, asked[group]))
    data = _merged(data, {key: value for key, value in root.items() if key != "defaults"})
    for group in added:
        data = _merged(data, _placed(group, asked[group]))
    return data


def package(group: str) -> str:
    """The key that the choices of a group are about: its own name, if they say no other."""
    first = min(shipped_files(group).values())  # one of the user's may be wrong, and is another's
    return _read(first, first.stat().st_mtime_ns).package or group


def _asks(group: str, name: str) -> list[tuple[str, str]]:
    """What a file asks of other groups, before what those ask that it builds on."""
    file = _file(group, name)
    found = list(file.asks.items())
    for other, choice in reversed(file.others):
        found += _asks(other or group, choice) if choice != SELF else []
    return found


def _placed(group: str, name: str) -> Any:
    """What is in a file, below the keys that lead to it."""
    return plain.put({}, plain.way(_file(group, name).package or group), _content(group, name))


def _content(group: str, name: str) -> dict[str, Any]:
    file = _file(group, name)
    data: dict[str, Any] = {}
    for other, choice in file.others:
        if choice == SELF:
            data = _merged(data, file.own)
            continue
        about = plain.way(file.package or group)
        place = plain.way(_file(other or group, choice).package or other or group)
        if place[: len(about)] != about or bool(other) != (place != about):
            raise _NotPlainError
        below = place[len(about) :]
        inner = _content(other or group, choice)
        data = _merged(data, plain.put({}, below, inner) if below else inner)
    return data


def _file(group: str, name: str) -> _File:
    if not name.isidentifier():
        raise _NotPlainError
    path = named_file(group, name)
    if not path.exists():
        raise _NotPlainError
    return _read(path, path.stat().st_mtime_ns)


@lru_cache(maxsize=256)
def _read(path: Path, changed: int) -> _File:
    """A file as it was at some time."""
    data = content(path)
    others: list[tuple[str, str]] = []
    asks: dict[str, str] = {}
    defaults = data.get("defaults", [SELF])
    for entry in defaults if isinstance(defaults, list) else [None]:
        if isinstance(entry, str) and entry.isidentifier():
            others.append(("", entry))
            continue
        if not isinstance(entry, dict) or len(entry) != 1:
            raise _NotPlainError
        ((key, name),) = entry.items()
        if not isinstance(name, str):
            raise _NotPlainError
        if match := _ELSEWHERE.fullmatch(key):
            asks[match[1]] = name
        elif match := _WITHIN.fullmatch(key):
            others.append((match[1], name))
        else:
            raise _NotPlainError
    own = {key: value for key, value in data.items() if key != "defaults"}
    text = files.text(path, documents.LARGEST, linked=True)
    package = _PACKAGE.match(text)
    odd = text.count("@package") > (1 if package else 0)
    others = others or [("", SELF)]
    if odd or ("", SELF) not in others or any(map(_read_otherwise, plain.leaves(own))):
        raise _NotPlainError
    return _File(own, tuple(others), asks, package[1] if package else "")


def _read_otherwise(leaf: tuple[plain.Way, Any]) -> bool:
    """Whether Hydra's YAML takes a value for something else, such as 1e-5 for a number."""
    value = leaf[1]
    if not isinstance(value, str):
        return False
    try:
        float(value.replace("_", ""))
    except ValueError:
        return value == MISSING
    return True


def _merged(base: Any, over: Any) -> Any:
    """Keys of both, within each other; of what is no dict, the latter."""
    if not isinstance(base, dict) or not isinstance(over, dict):
        return over
    inner = {
        key: _merged(base[key], value) if key in base else value for key, value in over.items()
    }
    return {**base, **inner}
