"""Builds the C sources of rotctl into the wheel, where there is a C compiler.

The libraries have no Python in them, so one build serves every Python 3 of a platform. Without a
compiler the wheel is pure Python, and rotctl uses its numpy references, a few times slower.
"""

import importlib.util
import os
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCES = (
    Path("rotctl/control/compiled.c"),
    Path("rotctl/simulation/ground_forces.c"),
    Path("rotctl/simulation/pgs.c"),
)
SLOWER = "rotctl will use its numpy reference instead, which is a few times slower"
# Sums keep their order and products are rounded before they are added: with that, every compiler
# and every level of optimisation gives the same bits.
FLAGS = [
    *("-O3", "-std=c11", "-fPIC", "-shared", "-Wall", "-Wextra"),
    *("-ffp-contract=off", "-fno-trapping-math", "-fno-math-errno"),
]


class CompileSources(BuildHookInterface):
    """The build hook of pyproject.toml."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, before hatchling collects the files."""
        compiler = next(
            filter(shutil.which, (os.environ.get("CC", ""), "cc", "gcc", "clang")), None
        )
        if compiler is None:
            self.app.display_warning(
                f"no C compiler found: {SLOWER} (Debian: apt-get install gcc libc6-dev, then "
                "install rotctl again)"
            )
        built = [library for source in SOURCES if (library := self._compiled(compiler, source))]
        if not built:
            return
        build_data["artifacts"].extend(built)
        build_data["pure_python"] = False
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{platform}"

    def _compiled(self, compiler: str | None, source: Path) -> str:
        """The library `_name.so` beside `name.c`; empty if it cannot be built."""
        library = source.with_name(f"_{source.stem}.so")
        (Path(self.root) / library).unlink(missing_ok=True)
        if compiler is None:
            return ""
        headers = f"-I{_mujoco_headers()}"
        command = [compiler, *FLAGS, headers, str(source), "-o", str(library), "-lm"]
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True, check=False)
        if done.returncode:
            self.app.display_warning(
                f"{compiler} could not build {source}: {SLOWER}\n{done.stderr}"
            )
            return ""
        return str(library)


def _mujoco_headers() -> Path:
    """The headers that the mujoco package ships; found without importing it."""
    spec = importlib.util.find_spec("mujoco")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("the build needs the mujoco package; it is in build-system.requires")
    return Path(spec.submodule_search_locations[0]) / "include"
