"""What the command line says of a run and of a log, in lines that any terminal can show."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rotctl.log import RunLog


def one_line(text: str) -> str:
    """The text on one line that a terminal can show."""
    return printable(" ".join(text.split()))


def printable(text: str) -> str:
    """Text from files and shells, without what could steer a terminal."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)


def readable(summary: dict[str, Any]) -> str:
    """A summary row for people."""

    def number(key: str, form: str = ".2f") -> str:
        value = summary[key]
        return "-" if value is None else format(value, form)

    verdict = "success" if summary["success"] else f"FAILED: {summary['failure_reason']}"
    return "\n".join(
        [
            f"{summary['behaviour']}  seed {summary['seed']}  run {summary['run_id']}  {verdict}",
            f"  rolled       {number('revolutions', '.1f')} rev in {number('duration', '.1f')} s, "
            f"{number('angular_velocity_mean')} rev/s "
            f"(commanded {number('angular_velocity_commanded')})",
            f"  speed        {number('speed_mean')} m/s (commanded {number('speed_commanded')})",
            f"  heading      {number('heading_error_end', '.0f')} deg off at the end, "
            f"drift {number('lateral_drift')} m",
            f"  stall        {number('longest_stall')} s at most",
            f"  torque       {number('torque_p99_fraction')} of the limit (99th percentile), "
            f"{summary['solver_failures']} solver failures",
            f"  real time    x {number('real_time_factor', '.1f')}",
        ]
    )


def described(log: "RunLog") -> str:
    """What is in a log: datasets, outcome, provenance, events."""
    from rotctl.log import SCHEMA

    attributes = log.attributes
    lines = [f"{log.path}  run {attributes['run_id']}  schema {attributes['schema_version']}", ""]
    for name in SCHEMA:
        shape = " x ".join(map(str, log[name].shape)) or "scalar"
        lines.append(f"{name:44} {shape:>16}  [{log.units(name)}]  {log.description(name)}")
    lines += ["", "outcome"]
    lines += [f"  {key:28} {value}" for key, value in log.outcome.items()]
    lines += ["", "provenance"]
    lines += [
        f"  {key:28} {attributes[key]}"
        for key in ("seed", "git_commit", "git_dirty", "versions", "machine", "wall_time")
    ]
    events = log.events
    lines += ["", f"events     {len(events) or 'none'}"]
    lines += [f"  {time:8.3f} s  {text}" for time, text in events[:20]]
    if len(events) > 20:
        lines.append(f"  ... and {len(events) - 20} more")
    return "\n".join(lines)
