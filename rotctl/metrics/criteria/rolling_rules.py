"""Whether a rolling run succeeded: the rules, in the order in which a reason is given."""

import math

from rotctl.metrics.criteria.rolling import RollingCriteria, RollingMetrics
from rotctl.metrics.halts import STILL


def failure_reason(metrics: RollingMetrics, criteria: RollingCriteria, wanted: float) -> str:
    """Why the run is no success; empty if it is one. `wanted` is the duration [s]."""
    m, c = metrics, criteria
    rules = (
        (m.duration >= wanted - 1e-6, f"ended after {m.duration:.2f} of {wanted:g} s"),
        (m.solver_failures == 0, f"every solver failed on {m.solver_failures} control steps"),
        (
            m.height_least > c.height[0],
            f"fell: centre of mass {m.height_least:.2f} m above the ground",
        ),
        (
            m.longest_stall < c.stall_time,
            f"stalled for {m.longest_stall:.2f} s from t = {m.stalled_at:.2f} s",
        ),
        (
            math.isnan(m.went_on),
            f"told to halt at {m.went_on:g} s, and not still for {STILL:g} s",
        ),
        (m.revolutions >= 1.0, f"no whole revolution: turned {m.revolutions:.2f} rev"),
        (
            m.slowest_revolution < c.revolution_time,
            f"too slow: a revolution took {m.slowest_revolution:.2f} s",
        ),
        (m.setback < c.setback, f"rocked back by {m.setback:.2f} rev"),
        (
            m.flight_turn < c.flight_turn,
            f"turned in the air: {m.flight_turn:.2f} of a revolution",
        ),
        (
            m.height_most < c.height[1],
            f"leapt: centre of mass {m.height_most:.2f} m above the ground",
        ),
        (m.penetration < c.penetration, f"sank into the ground by {m.penetration:.3f} m"),
        (
            m.trunk_turn > c.trunk_turn,
            f"the trunk did not turn along: {m.trunk_turn:.2f} rev in a revolution",
        ),
        (m.axis_error < c.axis, f"off its axis by {m.axis_error:.0f} deg over a revolution"),
        (
            m.travel_least > c.travel[0],
            f"turned on the spot: {m.travel_least:.2f} m in a revolution",
        ),
        (m.travel_most < c.travel[1], f"slid: {m.travel_most:.2f} m in a revolution"),
        (
            abs(m.heading_error_end) < c.heading,
            f"heading off by {m.heading_error_end:.0f} deg at the end",
        ),
        (
            # A way without places has nothing beside it.
            m.lateral_drift < c.lateral_drift or math.isnan(m.lateral_drift),
            f"drifted {m.lateral_drift:.2f} m sideways",
        ),
    )
    # What is not a number keeps no rule.
    return next((reason for kept, reason in rules if not kept), "")
