"""What the command line says of a run."""

from typing import Any

from rotctl.cli.wording import one_line

STILL = 0.05  # [rev, rev/s] less is no rolling
SHORT = 5  # times what is left out: of a shorter run that is more than a fifth
SOON = 0.05  # [s] less is at once
WHOLE = 999.5  # from here on in whole numbers: three digits would be of a power of ten
AWAY = 0.6  # [-] of a command: who is so far off it does not follow it; Table 1's rows are within


def readable(summary: dict[str, Any], settle: float = 0.0) -> str:
    """A summary row for people.

    Args:
        settle: at the start that mean speeds of a roll leave out [s]; of a short run it is said.
    """

    def number(key: str, form: str = ".2f") -> str:
        value = summary.get(key)
        return format(value, form) if isinstance(value, int | float) else "-"

    def metres(key: str) -> str:
        value = number(key)
        return value if value == "-" else f"{value} m"

    def shown(key: str) -> str:
        value = summary[key]
        if isinstance(value, str):
            return one_line(value)
        large = isinstance(value, int | float) and abs(value) >= WHOLE
        return number(key, ".0f" if large else ".3g")

    name, seed, run, reason = (
        one_line(str(summary.get(key, "-")))
        for key in ("behaviour", "seed", "run_id", "failure_reason")
    )
    verdict = "success" if summary["success"] else f"FAILED: {reason}"
    if summary.get("criteria", "rolling") in ("rolling", "finish"):
        measured = [
            f"  rolled       {number('revolutions', '.1f')} rev in {number('duration', '.1f')} s, "
            f"{_pace(summary)}{_after(summary, settle)} ({_asked(summary, 'angular_velocity')})",
            f"  speed        {number('speed_mean')} m/s ({_asked(summary, 'speed')})",
            f"  heading      {number('heading_error_end', '.0f')} deg off at the end, "
            f"drift {metres('lateral_drift')}",
            f"  stall        {number('longest_stall')} s at most",
        ]
        if "halted" in summary:
            measured.append(
                f"  halts        told to from {number('halt_commanded', '.1f')} s on, still for "
                f"{number('halted', '.1f')} s"
            )
        if "finish_commanded" in summary:
            measured.append(
                f"  stands up    from {number('stands_from', '.1f')} s "
                f"({_told(summary)}), "
                f"{number('stands_at')} m high in the end"
            )
        if "disturbed_by" in summary:
            measured.append(f"  disturbed    {_disturbed(summary)}")
    else:
        from rotctl.metrics import peaks  # numpy: what only asks for help needs none
        from rotctl.metrics.criteria.kinds import COLUMNS

        known = [
            column
            for key, column in COLUMNS.items()
            if key in summary and column not in peaks.COLUMNS
        ]
        wide = max((len(column.title) for column in known), default=0)
        measured = [f"  {c.title:{wide}}  {shown(c.name)} {c.unit}".rstrip() for c in known]
        if all(f"{joint}_speed" in summary for joint in peaks.GROUPS):
            speeds = (f"{joint} {number(f'{joint}_speed', '.0f')}" for joint in peaks.GROUPS)
            measured.append(f"  joints       {', '.join(speeds)} rad/s at most until it lands")
    return "\n".join(
        [
            f"{name}  seed {seed}  run {run}  {verdict}",
            *measured,
            f"  torque       {number('torque_p99_fraction')} of the limit (99th percentile), "
            f"{summary['solver_failures']} solver failures",
            f"  real time    x {number('real_time_factor', '.1f')}",
        ]
    )


def _told(summary: dict[str, Any]) -> str:
    """When a roll was told to end on its feet."""
    turns, time = summary.get("revolutions_told"), summary.get("told_at")
    if not isinstance(turns, int | float):
        return f"commanded from {summary['finish_commanded']:.1f}"
    at = f"at {time:.1f} s" if isinstance(time, int | float) else "which it never did"
    return f"told to after {turns:.3g} rev, {at}"


def _disturbed(summary: dict[str, Any]) -> str:
    """What came from outside and when; in words where nothing did."""
    if not summary["disturbed_by"]:
        return "by nothing: what was to come did not come in the run"
    came = f"by {summary['disturbed_by']:.3g} N s, from {summary['disturbed_at']:.2f} s on"
    recovered, taken = summary.get("recovered"), summary.get("recovery")
    if not isinstance(recovered, int | float):
        return came
    if not isinstance(taken, int | float):
        return f"{came}; did not roll on"
    then = f"{taken:.1f} s after it" if taken >= SOON else "at once"
    return f"{came}; rolled on {then}{'' if recovered else ', too late'}"


def _pace(summary: dict[str, Any]) -> str:
    """The mean rate after the start; in words where a roll has come to an end before."""
    rate, turned = summary.get("angular_velocity_mean"), summary.get("revolutions")
    if not isinstance(rate, int | float):
        return "- rev/s"
    ended = isinstance(turned, int | float) and abs(turned) >= STILL and abs(rate) < STILL
    return "and then no more" if ended else f"{rate:.2f} rev/s"


def _after(summary: dict[str, Any], settle: float) -> str:
    """What of a short run mean speeds are of."""
    lasted = summary.get("duration")
    if not isinstance(lasted, int | float) or not 0.0 < lasted < SHORT * settle:
        return ""
    means = isinstance(summary.get("angular_velocity_mean"), int | float)
    return f" after the first {settle:g} s" if means else f": means begin after {settle:g} s"


def _asked(summary: dict[str, Any], velocity: str) -> str:
    """What of a velocity is commanded; see `RollingSettings.commanded`."""
    key = f"{velocity}_commanded"
    if key not in summary:
        return "follows from the pace"
    value, mean = summary[key], summary.get(f"{velocity}_mean")
    if not isinstance(value, int | float):
        return "commanded by a schedule"
    said = f"commanded {value:.2f}"
    if not (summary["success"] and isinstance(mean, int | float)):
        return said
    return (
        f"{said}, which it does not follow" if abs(mean - value) > AWAY * abs(value) > 0.0 else said
    )
