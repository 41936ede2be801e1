"""Whose trajectories a sweep keeps, as a log each; of all runs it keeps the row."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from rotctl.errors import InputError

ALWAYS, IF_FAILED, NEVER = "always", "if failed", "never"  # for one run
_MODES = {"all": ALWAYS, "failures": IF_FAILED, "rows": NEVER}


@dataclass(frozen=True)
class Keep:
    """A choice.

    Attributes:
        mode: `all`, `failures`, `rows` or `sample`.
        count: runs of a sample.
    """

    mode: str = "all"
    count: int = 0

    def of(self, run_ids: Iterable[str]) -> Callable[[str], str]:
        """What is to be kept of each of a sweep's runs.

        A sample are those with the least ids, which are hashes: the same ones each time.
        """
        if self.mode != "sample":
            mode = _MODES[self.mode]
            return lambda run_id: mode
        sample = set(sorted(run_ids)[: self.count])
        return lambda run_id: ALWAYS if run_id in sample else NEVER


def read(text: str) -> Keep:
    """A choice as people write it.

    Raises:
        InputError: there is none such.
    """
    mode, _, count = text.partition(":")
    if text in _MODES:
        return Keep(mode)
    if mode == "sample" and count.isascii() and count.isdigit() and len(count) < 10:
        return Keep(mode, int(count))
    raise InputError(f"--keep={text}: valid: {', '.join(_MODES)}, sample:N")


def kept(wish: str, success: bool) -> bool:
    """Whether the log of a run is kept that ended so."""
    return wish == ALWAYS or (wish == IF_FAILED and not success)
