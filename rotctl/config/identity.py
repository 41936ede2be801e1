"""What makes two runs the same: the hash of what acts in them, by which they are named."""

import hashlib
import json
import re
from dataclasses import asdict
from functools import lru_cache
from typing import Any

from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.caching import kept
from rotctl.config.schema import Config
from rotctl.log import SCHEMA_VERSION
from rotctl.mechanics.model import Model
from rotctl.motion import ReferenceSettings, load_clip
from rotctl.settings.writing import to_dict

DESCRIPTIVE = ("description", "source", "colour", "found_for", "said")


def run_id(config: Config, model: Model) -> str:
    """Name of the run that a config makes, 12 hex digits; see `identity`.

    Args:
        model: what control knows of what is simulated, see `Scenario.known`.

    Raises:
        InputError: the clip that is followed does not exist.
    """
    return identity(config, model_hash(model))


def model_hash(model: Model) -> str:
    """Of a model, but for what only colours it."""
    return _hash_without_looks(model.mjcf)


def identity(config: Config, model: str) -> str:
    """Hash of what acts: the config, the log's schema version, the model and the clip followed.

    What only describes or colours does not act, nor do the criteria: they judge what was simulated.

    Args:
        model: see `model_hash`.

    Raises:
        InputError: the clip that is followed does not exist.
    """
    parts = {
        "config": {
            name: _hash_of_part(part)
            for name, part in to_dict(config).items()
            if name != "criteria"
        },
        "schema": SCHEMA_VERSION,
        "model": model,
    }
    reference = getattr(config.behaviour, "reference", None)
    if reference:
        parts["clip"] = _hash_of_clip(reference)  # a name or path says not what is in it
    if isinstance(config.behaviour, ChainSettings):
        said = [getattr(one.behaviour, "reference", None) for one in config.behaviour.parts]
        parts["clips"] = [_hash_of_clip(one) for one in said if one]
    return _hash(parts)[:12]


def _hash(plain: Any) -> str:
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()


@kept(most=1000)
def _hash_of_part(part: Any) -> str:
    return _hash(acting(part))


@lru_cache(maxsize=8)
def _hash_without_looks(mjcf: str) -> str:
    return _hash(re.sub(r' rgba="[^"]*"', "", mjcf))


@kept(most=100)
def _hash_of_clip(reference: ReferenceSettings) -> str:
    return _hash(asdict(load_clip(reference.clip)))


def acting(part: Any) -> Any:
    """Plain data without the keys that act on nothing."""
    if isinstance(part, dict):
        return {key: acting(value) for key, value in part.items() if key not in DESCRIPTIVE}
    return [acting(value) for value in part] if isinstance(part, list | tuple) else part
