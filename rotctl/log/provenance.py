"""Where a result comes from: versions, source commit and machine. No host or user name."""

import ctypes
import math
import os
import platform
import subprocess
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from struct import pack
from typing import Any

import numpy as np

import rotctl

_PACKAGES = ("mujoco", "numpy", "osqp", "h5py")
_GIT_TIMEOUT = 10.0  # [s]
_CPUINFO = Path("/proc/cpuinfo")
# Those that mathematical libraries choose their code by.
_FEATURES = (
    "avx",
    "avx2",
    "fma",
    "fma4",
    "avx512f",
    "avx512vl",
    "avx512_fp16",
    "amx_tile",
    "asimd",
)
_LIBM_POINTS = 4096  # in each function some of them are rounded another way without FMA


def collect() -> dict[str, Any]:
    """Returns ``versions``, ``git_commit``, ``git_dirty`` and ``machine``, ready for a log."""
    commit, dirty = _own_source()
    return {
        "versions": _versions(),
        "git_commit": commit,
        "git_dirty": dirty,
        "machine": _machine(),
    }


def _versions() -> dict[str, str]:
    own = {"rotctl": rotctl.__version__, "python": platform.python_version()}
    return own | {package: _version(package) for package in _PACKAGES}


@cache
def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


@cache
def _machine() -> dict[str, str | int]:
    return {
        "platform": platform.platform(),
        "cpu": _cpu_model(),
        "features": _cpu_features(),
        "cores": os.cpu_count() or 0,
        "libc": " ".join(platform.libc_ver()).strip() or "unknown",
        "libm": libm(),
        "blas": _blas(),
    }


def _cpu_model(cpuinfo: Path = _CPUINFO) -> str:
    return _cpu_line("model name", cpuinfo) or platform.processor() or "unknown"


def _cpu_features(cpuinfo: Path = _CPUINFO) -> str:
    there = (_cpu_line("flags", cpuinfo) or _cpu_line("Features", cpuinfo)).split()
    return " ".join(name for name in _FEATURES if name in there) or "unknown"


def _cpu_line(key: str, cpuinfo: Path) -> str:
    """What is said of the first processor; empty where nothing is."""
    try:
        lines = cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    named = (line.partition(":") for line in lines)
    return next((value.strip() for name, _, value in named if name.strip() == key), "")


def libm() -> str:
    """Eight digits that tell C libraries apart whose sin, cos and atan2 differ in any bit.

    Nothing else that a run calls still depends on the machine, see docs/reproducibility.md.
    """
    points = [0.61803398875 * i for i in range(1, _LIBM_POINTS + 1)]
    values = [function(x) for function in (math.sin, math.cos) for x in points]
    values += map(math.atan2, points, reversed(points))
    return sha256(pack(f"<{len(values)}d", *values)).hexdigest()[:8]


def _blas() -> str:
    """The BLAS that numpy brings, its version and, of an OpenBLAS, the kernel it took here."""
    build: dict[str, Any] = np.show_config(mode="dicts")  # type: ignore[assignment]
    found = build.get("Build Dependencies", {}).get("blas", {})
    words = [str(found.get("name", "unknown")), str(found.get("version", ""))]
    for path in (Path(np.__file__).parent.parent / "numpy.libs").glob("*openblas*"):
        library = ctypes.CDLL(str(path))  # numpy has loaded it, this only finds it again
        for name in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename"):
            if function := getattr(library, name, None):
                function.restype = ctypes.c_char_p
                words.append(function().decode())
    return " ".join(filter(None, words))


@cache
def _own_source() -> tuple[str, bool]:
    """Asked once: this process runs the code that it has loaded, whatever git says later."""
    return _source(Path(rotctl.__file__).resolve().parent)


def _source(package: Path) -> tuple[str, bool]:
    """Returns the commit that ``package`` is tracked by, and whether its files differ from it.

    A package that merely lies inside somebody's repository, as in a virtual environment there,
    has no commit: git must know the package's own ``__init__.py``.
    """
    try:
        _git(package, "ls-files", "--error-unmatch", "__init__.py")
        commit = _git(package, "rev-parse", "HEAD")
        return commit, bool(_git(package, "status", "--porcelain", "--", "."))
    except (OSError, subprocess.SubprocessError):
        return "unknown", False


def _git(folder: Path, *arguments: str) -> str:
    """Runs git in ``folder``, deaf to a GIT_DIR that the caller's shell or hook has set."""
    environment = {name: value for name, value in os.environ.items() if name[:4] != "GIT_"}
    finished = subprocess.run(
        ["git", "--no-optional-locks", "-C", str(folder), *arguments],
        env=environment,
        capture_output=True,
        check=True,
        text=True,
        timeout=_GIT_TIMEOUT,
    )
    return finished.stdout.strip()
