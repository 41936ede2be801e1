"""A report reaches its folder: every file whole, the index last, and nothing of an earlier one.

The folder may hold other things, so that it says itself what of it a report has put there.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path

from rotctl import files
from rotctl.errors import InputError
from rotctl.report.site.pictures import SCRIPT

# What a report puts into folders; in a list that may be a stranger's nothing else is believed.
OURS = ("pictures/*.png", "replays/*.html", "sweeps/*.html", "sweeps/*.csv", "charts/*.svg")
LIST = "files.txt"  # what a report has put there, one a line
LARGEST = 4_000_000  # [bytes] of the list


def write(content: Mapping[str, bytes], out: Path) -> None:
    """Write a report.

    Args:
        content: address -> bytes; the last one, which links to the others, is written last.

    Raises:
        InputError: a file cannot be written, or something else than a report has its name.
    """
    earlier = _earlier(out)
    ours = content.keys() if earlier is None else earlier
    taken = [out / address for address in content.keys() - ours if (out / address).exists()]
    if taken:
        raise InputError(f"{min(taken)}: is there, and of no earlier report; choose another --out")
    _list({*content, *(earlier or ())}, out)  # first: after a kill it is known what is ours
    for address, data in content.items():
        path = out / address
        with files.folder(path.parent, linked=path.parent == out):
            files.replace(path, data)
    for address in _left(out) if earlier is None else earlier:
        path = out / address
        if address not in content and _is_ours(address) and not path.parent.is_symlink():
            with suppress(OSError):
                path.unlink()
    _list(content, out)


def _earlier(out: Path) -> set[str] | None:
    """What earlier reports have put into a folder; None where one is that does not say it."""
    if (out / LIST).exists():
        return set(files.text(out / LIST, LARGEST, linked=False).splitlines())
    return None if (out / SCRIPT).exists() else set()


def _left(out: Path) -> set[str]:
    """What may be left of a report without a list, as older versions of rotctl made them."""
    return {path.relative_to(out).as_posix() for ours in OURS for path in out.glob(ours)}


def _is_ours(address: str) -> bool:
    known = any(fnmatchcase(address, pattern) for pattern in OURS)
    return known and address.count("/") == 1


def _list(addresses: Iterable[str], out: Path) -> None:
    with files.folder(out, linked=True):
        files.replace(out / LIST, files.encoded("".join(f"{a}\n" for a in sorted(addresses))))
