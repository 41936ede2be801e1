"""A character that is a model of somebody's: `character: {kind: mjcf, file: robot.xml}`.

It is converted before the config is checked, so that a run and its log hold the whole of it and
need the file no more.
"""

import os
from dataclasses import field
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.choices.composing import simple
from rotctl.choices.config_folders import is_own
from rotctl.choices.contents import content
from rotctl.choices.listing import choices, named_file, shipped_files
from rotctl.errors import InputError
from rotctl.mechanics.character import Character
from rotctl.settings import plain
from rotctl.settings.checking import checked
from rotctl.settings.complaints import unknown_key
from rotctl.settings.fields import STRICT

GROUP = "character"


@validated(frozen=True, config=STRICT)
class OwnBody:
    """Which model, and what its names do not say.

    Attributes:
        file: MJCF, beside the file that names it, or from the working folder on a command line.
        roles: which body is what, as `left_hip: leg_1`; see `rotctl.motion.naming.ROLES`.
        meshes: `fitted` takes capsules in their place, `none` leaves them out.
        collision: whether they touch by those capsules or by their convex `hulls`.
        proxies: which of its shapes touch, by their names, `class:NAME` or `group:N`; `*` stands
            for anything. A body of which none is named keeps what it has.
    """

    kind: Literal["mjcf"]
    file: str
    roles: dict[str, str] = field(default_factory=dict)
    meshes: Literal["fitted", "none"] = "fitted"
    collision: Literal["capsules", "hulls"] = "capsules"
    proxies: Annotated[tuple[str, ...], Field(max_length=1000)] = ()


class Named(NamedTuple):
    """A model that overrides ask for.

    Attributes:
        data: that names it, as written, and called as the choice is; folder: of its file.
        changes: keys below `character` with what they are to be.
        others: overrides that are about something else.
    """

    data: dict[str, Any]
    folder: Path
    changes: list[tuple[str, Any]]
    others: list[str]


def named(overrides: list[str]) -> Named | None:
    """The model that overrides ask for; None if they ask for none.

    Raises:
        InputError: an override cannot be read.
    """
    about = [o for o in overrides if _key(o) == GROUP or _key(o).startswith(f"{GROUP}.")]
    chosen = [o for o in about if o.startswith(f"{GROUP}=")]
    found = _data(chosen[-1].partition("=")[2]) if chosen else None
    if found is None:
        return None
    from rotctl.choices.overrides import single

    read = [single(o) for o in about if not o.startswith(f"{GROUP}=")]
    changes = []
    for one in read:
        if one.is_delete():
            raise InputError(f"~{one.key_or_group}: a model's keys are given, not removed")
        changes.append((str(one.key_or_group).removeprefix(f"{GROUP}."), one.value()))
    return Named(*found, changes, [o for o in overrides if o not in about])


def _key(override: str) -> str:
    return override.lstrip("+~").partition("=")[0]


def converted(model: Named) -> dict[str, Any]:
    """The character, as plain data.

    Raises:
        InputError: it makes none; one line that says why.
    """
    ours = {k: v for k, v in model.data.items() if k in OwnBody.__dataclass_fields__}
    over: list[tuple[plain.Way, Any]] = [
        ((key,), value) for key, value in model.data.items() if key not in ours
    ]
    for key, value in model.changes:  # a command line has the last word
        parts = plain.way(key)
        if parts[0] in OwnBody.__dataclass_fields__:
            ours = plain.put(ours, parts, value)
        else:
            over.append((parts, value))
    if "kind" not in ours:
        raise InputError(f"{GROUP}: a file goes with its kind; write kind: mjcf")
    try:
        body = checked(OwnBody, ours)
    except InputError as error:
        raise InputError(f"{GROUP}: {error}") from None
    if not body.file:
        raise InputError(f"{GROUP}: file='': is empty; name the model")
    path = model.folder / body.file
    roles, fitted = tuple(body.roles.items()), body.meshes == "fitted"
    hulls = body.collision == "hulls"
    data = _adopted(path, _stamp(path), roles, fitted, hulls, body.proxies)
    ours_alone = [key for key in Character.__dataclass_fields__ if key not in data]
    for parts, value in over:
        added = len(parts) == 1 and parts[0] in ours_alone
        if plain.find(data, parts) is plain.NOTHING and not added:
            valid = [*OwnBody.__dataclass_fields__, *data, *ours_alone]
            raise InputError(unknown_key(plain.dotted((GROUP, *parts)), GROUP, valid))
        data = plain.put(data, parts, value)
    if data["name"] in list(shipped_files(GROUP)):
        raise InputError(
            f"{GROUP}.name={data['name']}: is a character that comes with rotctl; give "
            f"{path.name} a name of its own, as in {{kind: mjcf, file: {body.file}, name: mine}}"
        )
    return data


@lru_cache(maxsize=8)
def _adopted(
    path: Path,
    stamp: tuple[int, int],
    roles: tuple[tuple[str, str], ...],
    meshes: bool,
    hulls: bool,
    proxies: tuple[str, ...],
) -> dict[str, Any]:
    """As a file was at some time."""
    from rotctl.adopting import adopt

    try:
        found = adopt(path, path.stem, dict(roles), meshes=meshes, hulls=hulls, proxies=proxies)
    except InputError as error:
        said = str(error).replace("--map ", f"+{GROUP}.roles.")
        said = said.replace("--proxies ", f"{GROUP}.proxies=")
        raise InputError(said.replace("--hulls", f"{GROUP}.collision=hulls")) from None
    return {**found.character, "description": "\n".join([path.name, *found.notes])}


def _stamp(path: Path) -> tuple[int, int]:
    """When a file was changed, and how large it is."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return 0, 0
    return found.st_mtime_ns, found.st_size


def _data(text: str) -> tuple[dict[str, Any], Path] | None:
    """What a choice says of a model, and the folder that is from; None if it is another one."""
    if text.startswith("{"):
        from rotctl.choices.overrides import single

        value = single(f"{GROUP}={text}").value()
        return (value, Path()) if isinstance(value, dict) and _is_meant(value) else None
    one = simple(f"{GROUP}={text}")
    if one is None or one.value not in choices(GROUP):
        return None
    path = named_file(GROUP, str(one.value))
    data = content(path) if is_own(path) else {}
    return ({"name": str(one.value), **data}, path.parent) if _is_meant(data) else None


def _is_meant(data: dict[str, Any]) -> bool:
    """Whether a model is: who gives a file and no kind is to be told of the kind."""
    return "kind" in data or "file" in data
