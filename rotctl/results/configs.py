"""The configs of stored runs as plain data; what is equal in many is one object in all of them."""

import json
import re
from collections.abc import Mapping
from functools import lru_cache
from hashlib import sha256
from typing import Any

from rotctl.caching import kept
from rotctl.errors import InputError
from rotctl.settings.documents import from_yaml

_SEED = re.compile(r"^seed: (\d{1,19})\n", re.MULTILINE)


def config_of(text: str) -> dict[str, Any]:
    """The config of a log; runs differ mostly in their seed, so the rest is parsed once."""
    seed = _SEED.search(text)
    if not seed:
        return _parsed(text)
    return {**_parsed(_SEED.sub("", text)), "seed": int(seed[1])}


@lru_cache(maxsize=10_000)
def _parsed(text: str) -> dict[str, Any]:
    try:
        data = from_yaml("", text)
    except InputError:
        return {}
    return data if isinstance(data, dict) else {}


def config_hash(config: Mapping[str, Any]) -> str:
    """First digits of the SHA-256 of a config, its seed left out."""
    parts = {name: _hash(part) for name, part in config.items() if name != "seed"}
    return _hash(parts)[:12]


@kept(most=1000)
def _hash(data: Any) -> str:
    return sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()
