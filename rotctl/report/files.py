"""Pictures reach the disk whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from rotctl.errors import InputError


def replace(out: Path, content: bytes) -> None:
    """Put `content` at `out` in one step.

    Raises:
        InputError: it cannot be written; what was there stays.
    """
    with replacing(out) as part:
        part.write_bytes(content)


@contextmanager
def replacing(out: Path) -> Iterator[Path]:
    """A path to write to, which becomes `out` when all went well and is removed otherwise.

    Raises:
        InputError: it cannot be written.
    """
    part = out.with_name(f"{out.name}.part")
    try:
        yield part
        os.replace(part, out)
    except OSError as error:
        raise InputError(f"cannot write {out}: {error.strerror or error}") from None
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
