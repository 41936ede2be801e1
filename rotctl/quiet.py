"""MuJoCo without a word: its warnings go to whoever asks, not to stdout and a MUJOCO_LOG.TXT."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def quiet() -> Iterator[list[str]]:
    """Collects MuJoCo's warnings."""
    import mujoco  # not by all who import this: it takes a while

    before = mujoco.get_mju_user_warning()
    heard: list[str] = []
    mujoco.set_mju_user_warning(heard.append)
    try:
        yield heard
    finally:
        mujoco.set_mju_user_warning(before)
