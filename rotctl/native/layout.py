"""What Python and C hand each other, read from layout.h: it stands there and nowhere else.

A library is taken only if it was built from these very sources, so both sides have one layout.
"""

import ctypes
import re
from functools import cache
from pathlib import Path
from typing import Any

HEADER = Path(__file__).with_name("layout.h")
_TYPES: dict[str, Any] = {
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "int": ctypes.c_int,
    "char": ctypes.c_char,
    "long long": ctypes.c_longlong,
    "unsigned char": ctypes.c_ubyte,
}
_DECLARATION = re.compile(r"(?:const )?(long long|unsigned char|\w+) (.+)")
_DECLARATOR = re.compile(r"(\*?)(\w+)((?:\[\w+\])*)")


@cache
def constant(name: str) -> int:
    """A number of the header's enums."""
    return int(re.findall(rf"\b{name} = (-?\d+)", _text())[0])


@cache
def structure(name: str) -> type[ctypes.Structure]:
    """A structure of numbers, arrays, structures and pointers; a pointer is an address."""
    (body,) = re.findall(rf"typedef struct {{([^{{}}]*)}} {name};", _text())
    fields: list[tuple[str, Any]] = []
    for declaration in filter(None, map(str.strip, body.split(";"))):
        kind, declared = _DECLARATION.fullmatch(declaration).groups()  # type: ignore[union-attr]
        for declarator in declared.split(","):
            pointer, field, sizes = _DECLARATOR.fullmatch(declarator.strip()).groups()  # type: ignore[union-attr]
            of = ctypes.c_void_p if pointer else _TYPES.get(kind) or structure(kind)
            for size in reversed(re.findall(r"\w+", sizes)):
                of = of * (int(size) if size.isdecimal() else constant(size))
            fields.append((field, of))
    # No slots: a misspelt member is an error, and not one more attribute.
    return type(name, (ctypes.Structure,), {"_fields_": fields, "__slots__": ()})


@cache
def _text() -> str:
    """The header without comments, every `*` beside its name, on single spaces."""
    text = re.sub(r"//.*", "", HEADER.read_text())
    return " ".join(text.split()).replace("* ", " *")
