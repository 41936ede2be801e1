"""How hard a jump works its joints: peak speed and peak torque of each group, until it lands."""

import math

import numpy as np

from rotctl.metrics.columns import Arrays, Column, floats

GROUPS = ("hip", "knee", "ankle", "shoulder")  # which people who jump have been measured at
COLUMNS = tuple(
    column
    for group in GROUPS
    for column in (
        Column(f"{group}_speed", f"Fastest that a {group} turns until it lands", "rad/s"),
        Column(f"{group}_torque", f"Largest torque of a {group} until then, of its limit", ""),
    )
)


def measure(log: Arrays, end: int) -> dict[str, float]:
    """Peaks by the name of their column; NaN of joints that are not there, and without rows.

    All axes of a joint count, left and right. A peak is of one control step: nothing is smoothed.

    Args:
        end: row in which it lands; those from there on do not count.
    """
    names = [name.decode("utf-8", "replace") for name in np.asarray(log["model/joint"]).tolist()]
    joints = slice(6, 6 + len(names))  # after the root's own
    speed = np.abs(floats(log, "trajectory/qvel")[:end, joints])
    with np.errstate(divide="ignore", invalid="ignore"):  # a joint without a motor
        share = np.abs(floats(log, "trajectory/ctrl")[:end]) / floats(log, "model/torque_limit")
    found = {}
    for group in GROUPS:
        own = [i for i, name in enumerate(names) if name.split("_")[0] == group]
        for what, values in (("speed", speed), ("torque", share)):
            mine = values[:, own]
            found[f"{group}_{what}"] = float(np.nanmax(mine)) if mine.size else math.nan
    return found
