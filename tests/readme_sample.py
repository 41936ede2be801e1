"""What the README shows of `make run`; as a script (`make readme`), puts in what it prints now."""

import re
import sys
import tempfile
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

from rotctl.cli.main import main

README = Path(__file__).parent.parent / "README.md"
BLOCK = re.compile(r"(`make run` prints:\n\n```\n)(.*?)(```\n)", flags=re.DOTALL)
RUN_ID = re.compile(r"\b[0-9a-f]{12}\b")


def shown():
    """The lines of the README."""
    return BLOCK.search(README.read_text(encoding="utf-8")).group(2).splitlines()


def printed():
    """The lines of a run, as from the folder above `runs`; without the filmstrip's."""
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(StringIO()) as out:
        assert main(["run", "behaviour=forward_roll_1", "--out", f"{folder}/runs"]) == 0
        return out.getvalue().replace(f"{folder}/", "").splitlines()


def regenerate():
    """Write the README anew, its run id everywhere; True if that changed anything."""
    before = README.read_text(encoding="utf-8")
    lines = printed()
    (old,), (new,) = (set(RUN_ID.findall("\n".join(found))) for found in (shown(), lines))
    lines.append(f"filmstrip  runs/{new}/filmstrip.png")
    text = BLOCK.sub(lambda found: f"{found[1]}{chr(10).join(lines)}\n{found[3]}", before)
    README.write_text(text.replace(old, new), encoding="utf-8")
    return text != before


if __name__ == "__main__":
    sys.exit(0 if regenerate() else "README.md shows what is printed already")
