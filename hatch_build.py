"""Builds the C sources of rotctl into the wheel, where there is a C compiler.

The libraries have no Python in them, so one build serves every Python 3 of a platform. Without a
compiler the wheel is pure Python, and rotctl uses its numpy references, a few times slower.
"""

import importlib.util
import os
import platform
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCE = Path("rotctl/native/step.c")  # which includes the others
LIBRARY = SOURCE.with_name("_native.so")
SLOWER = "rotctl will use its numpy reference instead, which is a few times slower"
# Sums keep their order and products are rounded before they are added: with that, every compiler
# and every level of optimisation gives the same bits. gcc's vectoriser fuses products into sums
# that alternate with differences, whatever -ffp-contract says: no fused instructions on x86-64.
FUSES_NOTHING = ["-mno-fma", "-mno-avx512f"] if platform.machine() in ("x86_64", "AMD64") else []
FLAGS = [
    *("-O3", "-std=c11", "-fPIC", "-shared", "-Wall", "-Wextra"),
    *("-ffp-contract=off", *FUSES_NOTHING, "-fno-trapping-math", "-fno-math-errno"),
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
        if not self._compiled(compiler):
            return
        build_data["artifacts"].append(str(LIBRARY))
        build_data["pure_python"] = False
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{platform}"

    def _compiled(self, compiler: str | None) -> bool:
        """Build the library, if that can be done."""
        root = Path(self.root)
        (root / LIBRARY).unlink(missing_ok=True)
        if compiler is None:
            return False
        built_from = f'-DROTCTL_SOURCE="{_source_hash(root / SOURCE.parent)}"'
        headers = f"-I{_mujoco_headers()}"
        command = [compiler, *FLAGS, built_from, headers, str(SOURCE), "-o", str(LIBRARY), "-lm"]
        done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
        if done.returncode:
            self.app.display_warning(
                f"{compiler} could not build {SOURCE}: {SLOWER}\n{done.stderr}"
            )
        return not done.returncode


def _source_hash(folder: Path) -> str:
    """As the loader takes it, which refuses a library of other sources."""
    spec = importlib.util.spec_from_file_location("source", folder / "source.py")
    if spec is None or spec.loader is None:
        raise RuntimeError(f"the build needs {folder / 'source.py'}")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found: str = module.source_hash(folder)
    return found


def _mujoco_headers() -> Path:
    """The headers that the mujoco package ships; found without importing it."""
    spec = importlib.util.find_spec("mujoco")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("the build needs the mujoco package; it is in build-system.requires")
    return Path(spec.submodule_search_locations[0]) / "include"
