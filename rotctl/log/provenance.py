"""Where a result comes from: versions, source commit and machine. No host or user name."""

import os
import platform
import subprocess
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import rotctl

_PACKAGES = ("mujoco", "numpy", "osqp", "h5py")
_GIT_TIMEOUT = 10.0  # [s]


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
        "cores": os.cpu_count() or 0,
    }


def _cpu_model(cpuinfo: Path = Path("/proc/cpuinfo")) -> str:
    try:
        lines = cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or "unknown"


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
