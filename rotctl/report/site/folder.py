"""A report reaches its folder: every file whole, the index last, and nothing of an earlier one.

The folder may hold other things, so that it says itself what of it a report has put there.
"""

import os
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
HEAD = "# what rotctl report has put here"  # its first line: a user's own list has another
LARGEST = 4_000_000  # [bytes] of the list


def write(content: Mapping[str, bytes], out: Path) -> None:
    """Write a report.

    Args:
        content: address -> bytes; the last one, which links to the others, is written last.

    Raises:
        InputError: a file cannot be written, or something else than a report has its name.
    """
    earlier = _earlier(out)
    # Versions without a list wrote over what had their names; what else is there they do not say.
    ours = content.keys() if earlier is None else earlier
    taken = [out / address for address in content.keys() - ours if os.path.lexists(out / address)]
    folders = {(out / address).parent for address in content} - {out}
    taken += [path for path in folders if os.path.lexists(path) and not _is_folder(path)]
    if taken:
        raise _theirs(min(taken))
    listed = {*content, *(earlier or ())}
    _list(listed, out)  # first: after a kill it is known what is ours
    for address, data in content.items():
        path = out / address
        with files.folder(path.parent, linked=path.parent == out):
            files.replace(path, data)
    for address in earlier or ():
        path = out / address
        if address not in content and _is_ours(address) and not path.parent.is_symlink():
            with suppress(OSError):
                path.unlink()
    # Another report may have been written at the same time.
    others = (_earlier(out) or set()) - listed
    _list({*content, *(address for address in others if os.path.lexists(out / address))}, out)


def _earlier(out: Path) -> set[str] | None:
    """What earlier reports have put into a folder; None where one is that does not say it.

    Raises:
        InputError: a list is there that is none of a report.
    """
    if not os.path.lexists(out / LIST):
        return None if (out / SCRIPT).exists() else set()
    head, *listed = files.text(out / LIST, LARGEST, linked=False).splitlines() or [""]
    if head != HEAD:
        raise _theirs(out / LIST)
    return set(listed)


def _theirs(path: Path) -> InputError:
    return InputError(f"{path}: is there, and of no earlier report; choose another --out")


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _is_ours(address: str) -> bool:
    known = any(fnmatchcase(address, pattern) for pattern in OURS)
    return known and address.count("/") == 1


def _list(addresses: Iterable[str], out: Path) -> None:
    text = "".join(f"{line}\n" for line in (HEAD, *sorted(addresses)))
    with files.folder(out, linked=True):
        files.replace(out / LIST, files.encoded(text))
