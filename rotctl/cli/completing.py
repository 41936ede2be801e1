"""What can follow on a command line: commands, options, choices, keys of the config.

Reads what is needed and no more, as somebody waits: names of files, and for keys the files that the
choices so far are composed of. Where nothing is known the shell completes files.

Shells put a word into the line as it is, and a folder of configs may be a stranger's: a word with
anything in it that a shell would act on is left out.
"""

import argparse
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rotctl.choices import composing, config_folders, listing
from rotctl.errors import RotctlError
from rotctl.settings import plain

Commands = Mapping[str, argparse.ArgumentParser]
EXPERIMENT = "+experiment"
CONFIG_DIR = "--config-dir"
CLIP = "behaviour.reference.clip"
_HARMLESS = re.compile(r"[\w.+@/~,-][\w.+=@/~,-]*", re.ASCII)  # to bash, zsh and fish, unquoted


def candidates(words: list[str], commands: Commands) -> list[str]:
    """Words that can stand in the place of the last one.

    Args:
        words: of the line up to where the cursor is, after the program's name; the last one is
            begun, or empty.
        commands: by name.
    """
    *given, begun = words or [""]
    if given[-1:] == [CONFIG_DIR]:
        return []
    folder, before = _own(given)
    name = next((word for word in before if word in commands), "")
    try:
        with config_folders.own(folder):
            found = _in_command(name, commands[name], before, begun) if name else [*commands]
    except RotctlError:  # of a file or a folder; whoever runs the line is told
        return []
    if not name and begun.startswith("-"):
        found = ["--help", "--version", CONFIG_DIR]
    return sorted({w for w in found if w.startswith(begun) and _HARMLESS.fullmatch(w)})


def _own(given: list[str]) -> tuple[Path | None, list[str]]:
    """The folder of configs that a line names, and its words without it."""
    folder, others = None, []
    words = iter(given)
    for word in words:
        option, equals, value = word.partition("=")
        if option == CONFIG_DIR:
            # Of a word of its own the shell makes a path before rotctl sees it.
            folder = Path(value if equals else os.path.expanduser(next(words)))
        else:
            others.append(word)
    return folder, others


def _in_command(
    name: str, command: argparse.ArgumentParser, before: list[str], begun: str
) -> Iterable[str]:
    last = next((a for a in command._actions if before[-1] in a.option_strings), None)
    if last is not None and last.nargs != 0:  # the value of an option
        if name == "new" and last.dest == "source":
            return listing.named_files(before[before.index(name) + 1])
        if last.dest == "part":
            return [key.removesuffix("=") for key in _keys(begun, before)]
        return map(str, last.choices or ())
    if begun.startswith("-"):
        return [text for a in command._actions for text in a.option_strings]
    given = [w for w in before[before.index(name) + 1 :] if "=" not in w and not w.startswith("-")]
    if name in ("new", "list") and not given:
        return [*listing.group_names(), "motion", "tune", listing.EXPERIMENTS]
    if name == "tune" and not given:
        return listing.named_files("tune")
    positional = [a for a in command._actions if not a.option_strings]
    if any(a.dest == "overrides" for a in positional):
        return _override(begun, before, name)
    return [str(word) for a in positional for word in a.choices or ()]


def _override(begun: str, before: list[str], name: str) -> Iterable[str]:
    """Overrides that begin so."""
    key, equals, _ = begun.partition("=")
    if equals:
        return [f"{key}={choice}" for choice in _choices(key)]
    if begun.startswith("+"):
        groups = {path.parent.name for path in config_folders.conf_dir().glob("*/*.yaml")}
        added = [group for group in groups - _config(before).keys() if listing.choices(group)]
        return [f"+{group}=" for group in added] + [f"{EXPERIMENT}="] * (name == "sweep")
    return _keys(key, before)


def _choices(key: str) -> Iterable[str]:
    if key == EXPERIMENT:
        return listing.named_files(listing.EXPERIMENTS)
    return listing.named_files("motion") if key == CLIP else listing.choices(key.lstrip("+"))


def _keys(begun: str, before: list[str]) -> Iterable[str]:
    """Keys of the config, one step further: `controller.` and then `controller.pose.`."""
    config = _config(before)
    owner, dot, _ = begun.rpartition(".")
    place = plain.find(config, plain.way(owner))
    if not isinstance(place, dict):
        return []
    found = [
        f"{owner}{dot}{part}{'.' if isinstance(v, dict) else '='}" for part, v in place.items()
    ]
    return found if dot else [*found, *(f"{group}=" for group in config if listing.choices(group))]


def _config(before: list[str]) -> dict[str, Any]:
    """The config that the choices so far make; empty where Hydra would have to be asked."""
    chosen = [one for one in map(composing.simple, before) if one and listing.choices(one.key)]
    return composing.composed(chosen) or {}
