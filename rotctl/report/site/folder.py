"""A report reaches its folder: every file whole, the index last, and nothing of an earlier one."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from rotctl import files

# What a report puts into folders; other files there are not ours to remove.
OURS = ("pictures/*.png", "replays/*.html", "sweeps/*.html", "sweeps/*.csv", "charts/*.svg")


def write(content: Mapping[str, bytes], out: Path) -> None:
    """Write a report.

    Args:
        content: address -> bytes; the last one, which links to the others, is written last.

    Raises:
        InputError: a file cannot be written.
    """
    for address, data in content.items():
        path = out / address
        with files.folder(path.parent, linked=path.parent == out):
            files.replace(path, data)
    kept = {out / address for address in content}
    for pattern in OURS:
        for path in set(out.glob(pattern)) - kept:
            if not path.parent.is_symlink():
                with suppress(OSError):
                    path.unlink()
