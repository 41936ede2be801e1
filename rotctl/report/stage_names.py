"""How a run's config calls the stages of its behaviour."""

from typing import Any

from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.report.title import plain
from rotctl.settings.documents import from_yaml
from rotctl.settings.plain import NOTHING, find

LONGEST = 20  # characters of a stage's name


def stage_names(log: RunLog) -> list[str]:
    """Names of a behaviour's stages by their number in the log; empty if it does not say."""
    return [name for names in _by_part(log) for name in names]


def stages_of_parts(log: RunLog) -> list[int]:
    """How many stages each part of a chain has; one part, if it is none."""
    return [len(names) for names in _by_part(log)]


def _by_part(log: RunLog) -> list[list[str]]:
    try:
        config = from_yaml("config", log.config_yaml)
    except InputError:
        return []
    behaviour = find(config, ("behaviour",))
    parts = find(behaviour, ("parts",))
    if isinstance(parts, list):
        return [_stages(find(part, ("behaviour",))) or ["roll"] for part in parts]
    return [_stages(behaviour)]


def _stages(behaviour: Any) -> list[str]:
    finish = find(behaviour, ("finish", "stages"))
    staged = find(behaviour, ("stages",)) if finish is NOTHING else finish
    names = [find(one, ("name",)) for one in staged] if isinstance(staged, list) else []
    shown = [plain(name, LONGEST) if isinstance(name, str) else "" for name in names]
    return shown if finish is NOTHING else ["roll", *shown]
