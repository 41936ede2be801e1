"""The compiled library: found, checked against its sources and MuJoCo, loaded once."""

import ctypes
from functools import lru_cache
from pathlib import Path

import mujoco

from rotctl.native.source import source_hash

FOLDER = Path(__file__).parent
LIBRARY = FOLDER / "_native.so"
NOT_BUILT = (
    "is not built, using its numpy reference, which is {slower} slower; "
    "install a C compiler (Debian: apt-get install gcc libc6-dev), then rotctl again"
)
FUNCTIONS = (
    *("mj_mulM", "mj_solveM", "mj_factorM"),
    *("mj_jac", "mj_jacDot", "mj_applyFT"),
    *("mj_step1", "mj_step2", "mj_step", "mju_user_error"),
)


@lru_cache(maxsize=1)
def library() -> ctypes.CDLL | None:
    """The built library; None where there is none, or it was built from other source or MuJoCo.

    It carries no Python of its own, and finds MuJoCo's functions by `functions`.
    """
    try:
        found = ctypes.CDLL(str(LIBRARY))
        found.rotctl_source.restype = ctypes.c_char_p
        same = found.rotctl_source().decode() == source_hash(FOLDER)
        return found if same and found.rotctl_mujoco_version() == mujoco.mj_version() else None
    except (OSError, AttributeError):
        return None


@lru_cache(maxsize=1)
def functions() -> ctypes.Array[ctypes.c_void_p]:
    """Addresses of MuJoCo's functions, in the order of `Functions` in layout.h."""
    folder = Path(mujoco.__file__).parent
    loaded = ctypes.CDLL(str(next(folder.glob("libmujoco.*"))))
    addresses = [ctypes.cast(getattr(loaded, name), ctypes.c_void_p) for name in FUNCTIONS]
    return (ctypes.c_void_p * len(addresses))(*(address.value for address in addresses))
