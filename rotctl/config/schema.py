"""The schema of a config: all that determines a run, checked once into frozen dataclasses."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from typing import Annotated, Any, get_type_hints

from pydantic import Field, Strict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import BehaviourSettings
from rotctl.caching import kept
from rotctl.control import ControllerSettings
from rotctl.errors import InputError
from rotctl.mechanics.character import Character
from rotctl.mechanics.disturbance import DisturbanceSettings
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.physics import Physics
from rotctl.mechanics.plant import PlantSettings
from rotctl.mechanics.terrain import Terrain
from rotctl.metrics.criteria.kinds import Criteria
from rotctl.settings.checking import checked
from rotctl.settings.complaints import brief, clip
from rotctl.settings.documents import UNPRINTABLE
from rotctl.settings.fields import STRICT, Positive
from rotctl.settings.plain import Way, dotted, leaves
from rotctl.settings.writing import to_dict
from rotctl.simulation.start import StartSettings

PROSE = ("description", "source", "said")  # may be long
LONGEST_TEXT = 200
LARGEST = 1e13  # in any unit: squares and cubes of it are numbers still
SMALLEST = 1e-30  # but for 0: so are those of what is divided by it


@validated(frozen=True, config=STRICT)
class Config:
    """Everything that determines a run.

    Attributes:
        seed: of the run's random generator.
        duration: simulated time [s].
    """

    behaviour: BehaviourSettings
    character: Character
    controller: ControllerSettings
    criteria: Criteria
    disturbance: DisturbanceSettings
    excursion: ExcursionSettings
    physics: Physics
    plant: PlantSettings
    start: StartSettings
    terrain: Terrain
    seed: Annotated[int, Strict(), Field(ge=0, lt=2**63)]
    duration: Annotated[Positive, Field(le=3600)]


def check(data: Any) -> Config:
    """Plain data to a typed config.

    Raises:
        InputError: one line for the first thing that is wrong.
    """
    _refuse(data, _absurd_text)  # before messages of other checks repeat it
    found = checked(Config, data)
    _refuse(data, _absurd_number)
    return found


def changed(config: Config, parts: Mapping[str, Any]) -> Config:
    """The same with other plain data for some of its parts; what stays is not checked again.

    Args:
        parts: by their names, such as `controller` or `seed`.

    Raises:
        InputError: one line for the first thing that is wrong with them.
    """
    made: dict[str, Any] = {name: _part(config, name, data) for name, data in parts.items()}
    return replace(config, **made)


@kept(most=1000)
def _part(config: Config, name: str, data: Any) -> Any:
    try:
        found = _adapter(name).validate_python(data)
    except ValidationError:
        return getattr(check({**to_dict(config), name: data}), name)  # which tells what is wrong
    for absurd in (_absurd_text, _absurd_number):
        _refuse({name: data}, absurd)
    return found


@cache
def _adapter(name: str) -> TypeAdapter[Any]:
    """Of the type of a config's part."""
    return TypeAdapter(get_type_hints(Config, include_extras=True)[name])


def _refuse(data: Any, absurd: Callable[[Way, Any], str]) -> None:
    """Raises InputError for the first value that no run, picture or terminal could use."""
    for parts, value in leaves(data):
        if complaint := absurd(parts, value):
            shown = [clip(part) if isinstance(part, str) else part for part in parts]
            raise InputError(f"{dotted(shown)}={brief(value)}: {complaint}")


def _absurd_text(parts: Way, value: Any) -> str:
    """What is wrong with a text or the keys that lead to a value; mostly nothing."""
    if any(not _short(part) for part in parts):
        return f"a key must be printable and have at most {LONGEST_TEXT} characters"
    if not isinstance(value, str):
        return ""
    if parts and parts[-1] in PROSE:
        return "must have no control characters" if UNPRINTABLE.search(value) else ""
    if not _short(value):
        return f"must be printable, on one line of at most {LONGEST_TEXT} characters"
    return "must not be empty" if parts and parts[-1] == "name" and not value.strip() else ""


def _short(text: object) -> bool:
    return len(str(text)) <= LONGEST_TEXT and _printable(str(text))


@lru_cache(maxsize=10_000)  # of the same keys, again and again
def _printable(text: str) -> bool:
    return text.isprintable()


def _absurd_number(parts: Way, value: Any) -> str:
    if not isinstance(value, int | float) or parts == ("seed",):
        return ""
    if abs(value) > LARGEST:
        return f"must be at most {LARGEST:g} in size"
    tiny = 0.0 < abs(value) < SMALLEST and parts[:2] != ("start", "state")  # as a run left it
    return f"must be 0 or at least {SMALLEST:g} in size" if tiny else ""
