"""What a user waits for at the shell: whole processes, start-up and log included."""

import json
import subprocess
import sys
import tempfile
import time
from statistics import median

from rotctl.amounts import count

SECONDS = 20.0


def processes(repeats: int) -> str:
    """Wall times of real `rotctl` processes, medians over `repeats`."""
    lines = ["seconds, whole processes", ""]
    lines.append(f"{'rotctl --help':34}{median(_wall(['--help']) for _ in range(repeats)):8.2f}")
    for substeps in (1, 4):
        walls, loops = zip(*(_run(substeps) for _ in range(repeats)), strict=True)
        wall, loop = median(walls), median(loops)
        name = f"rotctl run, {SECONDS:g} s, {count(substeps, 'substep')}"
        lines.append(
            f"{name:34}{wall:8.2f}  start-up and writing the log {wall - loop:.2f}; "
            f"real-time factor {SECONDS / loop:.0f} without them, {SECONDS / wall:.1f} with them"
        )
    return "\n".join(lines)


def _run(substeps: int) -> tuple[float, float]:
    """Seconds of the whole process, and of the simulation loop in it."""
    with tempfile.TemporaryDirectory() as folder:
        choices = [f"duration={SECONDS:g}", f"physics.substeps={substeps}"]
        begin = time.perf_counter()
        row = _output(["run", "--json", "--out", folder, *choices])
        wall = time.perf_counter() - begin
    return wall, SECONDS / float(json.loads(row)["real_time_factor"])


def _wall(arguments: list[str]) -> float:
    begin = time.perf_counter()
    _output(arguments)
    return time.perf_counter() - begin


def _output(arguments: list[str]) -> str:
    command = [sys.executable, "-m", "rotctl", *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
