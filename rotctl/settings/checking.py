"""Plain data to frozen settings, or one line on the first thing that is wrong with them."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import is_pydantic_dataclass, rebuild_dataclass

from rotctl import files
from rotctl.errors import InputError
from rotctl.settings import documents
from rotctl.settings.complaints import complaint
from rotctl.settings.shapes import keys

T = TypeVar("T")


def checked(shape: type[T], data: Any) -> T:
    """Data as the validated dataclass `shape`.

    Raises:
        InputError: one line that names the bad value and what is valid.
    """
    if not isinstance(data, dict):
        raise InputError(f"must be keys with values: {', '.join(keys(shape))}")
    try:
        found: T = adapter(shape).validate_python(data)
    except ValidationError as error:
        raise InputError(complaint(shape, data, error.errors(include_url=False))) from None
    return found


def read(shape: type[T], path: Path, *, linked: bool) -> T:
    """A YAML file as `shape`; for `linked` see `rotctl.files.opened`.

    Raises:
        InputError: one line that names the file, the bad value and what is valid.
    """
    return from_yaml(shape, str(path), files.text(path, documents.LARGEST, linked=linked))


def from_yaml(shape: type[T], where: str, text: str) -> T:
    """A YAML text as `shape`; `where` it is from is for the messages. Errors as for `read`."""
    data = documents.from_yaml(where, text)
    try:
        return checked(shape, data)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _adapter(shape: Any) -> TypeAdapter[Any]:
    """What checks data for a type.

    A dataclass is completed first, else this and the making of an instance would each build a
    validator, which takes longer than a short run.
    """
    if is_pydantic_dataclass(shape):
        rebuild_dataclass(shape)
    return TypeAdapter(shape)


adapter: Callable[[Any], TypeAdapter[Any]] = cache(_adapter)  # of a type, made once
