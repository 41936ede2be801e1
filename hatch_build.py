"""Builds rotctl/control/compiled.c into the wheel, where there is a C compiler.

The library has no Python in it, so one build serves every Python 3 of a platform. Without a
compiler the wheel is pure Python, and rotctl uses its numpy reference, a few times slower.
"""

import importlib.util
import os
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SOURCE = Path("rotctl/control/compiled.c")
LIBRARY = Path("rotctl/control/_compiled.so")
# Sums may be reordered, which lets them be vectorised; numbers that are not finite stay so.
FLAGS = [
    *("-O3", "-std=c11", "-fPIC", "-shared", "-Wall", "-Wextra"),
    *("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math", "-fno-math-errno"),
]


class CompileControlStep(BuildHookInterface):
    """The build hook of pyproject.toml."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, before hatchling collects the files."""
        root = Path(self.root)
        (root / LIBRARY).unlink(missing_ok=True)
        compiler = next(
            filter(shutil.which, (os.environ.get("CC", ""), "cc", "gcc", "clang")), None
        )
        if compiler is None:
            self.app.display_warning(
                "no C compiler found: rotctl will use its numpy controller, about three times "
                "slower (Debian: apt-get install gcc libc6-dev, then install rotctl again)"
            )
            return
        command = [
            compiler,
            *FLAGS,
            f"-I{_mujoco_headers()}",
            str(SOURCE),
            "-o",
            str(LIBRARY),
            "-lm",
        ]
        done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
        if done.returncode:
            self.app.display_warning(
                f"{compiler} could not build {SOURCE}: rotctl will use its numpy controller, "
                f"about three times slower\n{done.stderr}"
            )
            return
        build_data["artifacts"].append(str(LIBRARY))
        build_data["pure_python"] = False
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{platform}"


def _mujoco_headers() -> Path:
    """The headers that the mujoco package ships; found without importing it."""
    spec = importlib.util.find_spec("mujoco")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("the build needs the mujoco package; it is in build-system.requires")
    return Path(spec.submodule_search_locations[0]) / "include"
