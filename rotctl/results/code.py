"""Which code made a run, as one text: what differs in it may differ in the numbers."""

from collections.abc import Mapping
from typing import Any

from rotctl.caching import kept
from rotctl.errors import LogError
from rotctl.settings.json_documents import from_json


def code_version(attributes: Mapping[str, Any]) -> str:
    """The code behind a log.

    Args:
        attributes: of a log, or what `rotctl.log.collect` returns.

    Raises:
        LogError: the versions in it are not what rotctl writes.
    """
    versions = attributes["versions"]
    try:
        versions = from_json(versions) if isinstance(versions, str) else versions
        own, physics = (f"{versions[name]:.20}" for name in ("rotctl", "mujoco"))
    except (ValueError, TypeError, KeyError):
        raise LogError("versions are not those of a rotctl log") from None
    commit = str(attributes["git_commit"])[:7]
    changed = " with changes" if attributes["git_dirty"] else ""
    return f"rotctl {own} ({commit}{changed}), mujoco {physics}"


code_of = kept(most=1000)(code_version)  # of rows, which share what they have in common
