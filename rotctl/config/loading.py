"""Configs: composed by Hydra from `conf/` and overrides, or read from a log, and then checked.

Hydra gives the groups and the override syntax; nothing is instantiated from a config and
no `_target_` or resolver is honoured, in overrides and in files, so that a stranger's config
cannot execute code or look anything up.
"""

import copy
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rotctl.choices import composing, labels
from rotctl.choices.composing import Assignment, simple
from rotctl.choices.config_folders import conf_dir, folders, is_own, own_dir
from rotctl.choices.contents import require_plain
from rotctl.choices.listing import choices, named_file
from rotctl.config import chains, own_body
from rotctl.config.schema import Config, check
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.settings import documents
from rotctl.settings.plain import NOTHING, exchanged, way
from rotctl.settings.writing import to_dict

if TYPE_CHECKING:
    from hydra.core.override_parser.types import Override


def load(overrides: list[str]) -> Config:
    """Compose and check a config.

    Args:
        overrides: in Hydra's syntax, such as `seed=3` or `terrain=flat`.

    Raises:
        InputError: one line that names the bad value and the valid choices or range.
    """
    data = composed(overrides)
    labels.require_own_in_files(composing.chosen(overrides), data)
    try:
        return check(data)
    except InputError as error:
        complaint = chains.told(str(error), data)
        raise InputError(f"{own_file(overrides, str(error))}{complaint}") from None


def own_file(
    overrides: list[str], complaint: str, made: Callable[[Config], object] = lambda config: None
) -> str:
    """The file of the user's that is at fault, for a message to begin with; else nothing.

    It is at fault if the choices among the overrides are wrong already, by themselves.
    Nothing, too, where several are chosen and the complaint names none of them.

    Args:
        made: what a config is made to, where that complains.
    """
    chosen = composing.chosen(overrides)
    mine = {one.key: named_file(one.key, one.value) for one in chosen}
    mine = {group: path for group, path in mine.items() if is_own(path)}
    if not mine:
        return ""
    try:
        made(check(composed([f"{one.key}={one.value}" for one in chosen])))
    except InputError as error:
        if str(error) == complaint:
            named = [path for group, path in mine.items() if f"{group}." in complaint]
            found = named or list(mine.values())
            # Of several that it does not name none need be wrong: it may be how they meet.
            return f"{found[0]}: " if named or len(found) == 1 else ""
    return ""


def recorded(log: RunLog) -> Config:
    """The config that a log holds, checked as any other.

    Raises:
        LogError: this rotctl cannot run it; one line that says why.
    """
    return rebuilt(log.path, lambda: documents.from_yaml("config", log.config_yaml))


def rebuilt(where: Path, data: Callable[[], Any]) -> Config:
    """A config out of a run that was made earlier, checked as any other.

    Raises:
        LogError: as for `recorded`.
    """
    try:
        return check(data())
    except InputError as error:
        raise LogError(f"{where}: its config makes no run here: {error}") from None


def composed(overrides: list[str]) -> dict[str, Any]:
    """The plain data of a config that is not checked yet; takes tenths of a second.

    Raises:
        InputError: as for `load`.
    """
    body = own_body.named(overrides)
    if body is None:
        return chains.composed(_composed(overrides), _composed, overrides)
    labels.require_own(((f"{own_body.GROUP}.{key}", value) for key, value in body.changes), dict)
    data = {**_composed(body.others), own_body.GROUP: own_body.converted(body)}
    return chains.composed(data, _composed, body.others)


def _composed(overrides: list[str]) -> dict[str, Any]:
    quick = [one for one in map(simple, overrides) if one]
    if len(quick) == len(overrides):
        labels.require_own(quick, lambda: _of_choices(overrides))
        data = _set_on_choices(quick)
        if data is not None:
            return data
    from rotctl.choices.overrides import assigned, is_choice, single, without_overruled

    overrides = without_overruled(overrides)
    found = [single(override) for override in overrides]
    every = [(str(o.key_or_group), o.value()) for o in found if not o.is_delete()]
    labels.require_own(every, lambda: _of_choices(overrides))
    require_plain([(str(o.key_or_group), str(o.value())) for o in found if is_choice(o)])
    quick = [one for one in map(assigned, found) if one]
    if len(quick) == len(overrides):
        data = _set_on_choices(quick)
        if data is not None:
            return data
    return _by_hydra(overrides, found)


def _of_choices(overrides: list[str]) -> dict[str, Any]:
    """What the choices among them make by themselves; nothing if they make no config."""
    try:
        return _chosen(tuple(composing.chosen(overrides)), folders(), _stamp(folders()))
    except InputError:
        return {}


def _set_on_choices(found: list[Assignment]) -> dict[str, Any] | None:
    """What the choices among them make, with the other values set on it.

    None where more than that is asked, or something is wrong, for Hydra to tell.
    """
    chosen = [one for one in found if choices(one.key)]
    if any(one.value not in choices(one.key) for one in chosen):
        return None
    try:
        data: Any = copy.deepcopy(_chosen(tuple(chosen), folders(), _stamp(folders())))
    except InputError:
        return None
    for key, value in found:
        if choices(key):
            continue
        data = exchanged(data, way(key), value)
        if data is NOTHING:
            return None
    return data


@lru_cache(maxsize=64)
def _chosen(
    chosen: tuple[Assignment, ...], among: tuple[Path, ...], stamp: tuple[int, ...]
) -> dict[str, Any]:
    """Composed of choices alone, from files as they were at some time."""
    data = composing.composed(chosen)
    if data is not None:
        return data
    from rotctl.choices.overrides import single

    texts = [f"{group}={name}" for group, name in chosen]
    return _by_hydra(texts, [single(text) for text in texts])


def _stamp(among: tuple[Path, ...]) -> tuple[int, ...]:
    """When each file of some folders was changed."""
    forms = ("*.yaml", "*/*.yaml")
    paths = [path for folder in among for form in forms for path in sorted(folder.glob(form))]
    return tuple(path.stat().st_mtime_ns if path.exists() else 0 for path in paths)


def _by_hydra(overrides: list[str], found: "list[Override]") -> dict[str, Any]:
    from hydra import compose, initialize_config_dir
    from hydra.core.global_hydra import GlobalHydra
    from hydra.errors import HydraException
    from omegaconf import OmegaConf
    from omegaconf.errors import MissingMandatoryValue, OmegaConfBaseException

    from rotctl.config.explanations import explain, require_placed

    require_placed(found)
    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(conf_dir()), version_base="1.3"):
            config = compose("config", [*overrides, *_searched()])
            data: Any = OmegaConf.to_container(config, resolve=True, throw_on_missing=True)
    except MissingMandatoryValue as error:
        raise InputError(f"{error.full_key}: missing, give it as {error.full_key}=VALUE") from None
    except RecursionError:
        raise InputError(composing.IN_A_CIRCLE) from None
    except (HydraException, OmegaConfBaseException, ValueError, TypeError) as error:
        raise InputError(explain(error, found, _changed_by(found))) from None
    return data


def _searched() -> list[str]:
    """Tells Hydra of the user's folder."""
    mine = own_dir()
    quoted = str(mine).replace("\\", "\\\\").replace("'", "\\'")
    return [f"hydra.searchpath=['file://{quoted}']"] if mine else []


def _changed_by(overrides: "list[Override]") -> dict[str, Any]:
    """The config that some overrides are to change: what the choices among them make."""
    from rotctl.choices.overrides import is_choice

    chosen = tuple(str(o.input_line) for o in overrides if is_choice(o))
    return _plain(chosen if len(chosen) < len(overrides) else ())  # () is the default


@cache
def _plain(overrides: tuple[str, ...]) -> dict[str, Any]:
    return to_dict(load(list(overrides)))
