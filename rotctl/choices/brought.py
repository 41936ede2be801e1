"""What a choice that comes with rotctl brings along: nobody has told it, though a config has it."""

from functools import cache
from typing import Any

from rotctl.choices import composing
from rotctl.choices.listing import shipped_files


@cache  # a folder is read for it, and every run of a sweep asks
def brought(group: str, name: str) -> dict[str, Any]:
    """What is in such a choice; nothing of another one, whose file may be anywhere, or edited."""
    if name not in shipped_files(group):
        return {}
    made = composing.composed([composing.Assignment(group, name)])
    return dict(made[group]) if made else {}
