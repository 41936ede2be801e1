"""Some rows of a log, as a log."""

from dataclasses import dataclass

import numpy as np

from rotctl.metrics.columns import Arrays


@dataclass(frozen=True)
class Excerpt:
    """Those rows of every array that has a row a control step."""

    log: Arrays
    rows: slice

    def __getitem__(self, name: str) -> np.ndarray:
        """Those rows of one array."""
        whole = np.asarray(self.log[name])
        return whole if name.startswith(("model/", "events/")) else whole[self.rows]

    def __contains__(self, name: object) -> bool:
        """Whether there is one of that name."""
        return name in self.log
