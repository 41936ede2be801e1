"""Which C sources a library was built from; the build hook reads this file by its path."""

import hashlib
from pathlib import Path


def source_hash(folder: Path) -> str:
    """16 hex digits of the C sources in a folder."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.[ch]")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
