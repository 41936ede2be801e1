"""What the command line says of a run and of a log, in lines that any terminal can show."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rotctl.adopting import Adopted
    from rotctl.log import RunLog
    from rotctl.motion.flight import Flight
    from rotctl.motion.importing import Imported
    from rotctl.verify import Repetition


STILL = 0.05  # [rev, rev/s] less is no rolling
AWAY = 0.6  # [-] of a command: who is so far off it does not follow it; Table 1's rows are within


def one_line(text: str) -> str:
    """The text on one line that a terminal can show."""
    return printable(" ".join(text.split()))


def printable(text: str) -> str:
    """Text from files and shells, without what could steer a terminal."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)


def readable(summary: dict[str, Any]) -> str:
    """A summary row for people."""

    def number(key: str, form: str = ".2f") -> str:
        value = summary.get(key)
        return format(value, form) if isinstance(value, int | float) else "-"

    def shown(key: str) -> str:
        value = summary[key]
        return one_line(value) if isinstance(value, str) else number(key, ".3g")

    name, seed, run, reason = (
        one_line(str(summary.get(key, "-")))
        for key in ("behaviour", "seed", "run_id", "failure_reason")
    )
    verdict = "success" if summary["success"] else f"FAILED: {reason}"
    if summary.get("criteria", "rolling") in ("rolling", "finish"):
        measured = [
            f"  rolled       {number('revolutions', '.1f')} rev in {number('duration', '.1f')} s, "
            f"{_pace(summary)} ({_asked(summary, 'angular_velocity')})",
            f"  speed        {number('speed_mean')} m/s ({_asked(summary, 'speed')})",
            f"  heading      {number('heading_error_end', '.0f')} deg off at the end, "
            f"drift {number('lateral_drift')} m",
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
        from rotctl.metrics.judge import COLUMNS

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
    return f"by {summary['disturbed_by']:.3g} N s, from {summary['disturbed_at']:.2f} s on"


def _pace(summary: dict[str, Any]) -> str:
    """The mean rate after the start; in words where a roll has come to an end before."""
    rate, turned = summary.get("angular_velocity_mean"), summary.get("revolutions")
    if not isinstance(rate, int | float):
        return "- rev/s"
    ended = isinstance(turned, int | float) and abs(turned) >= STILL and abs(rate) < STILL
    return "and then no more" if ended else f"{rate:.2f} rev/s"


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


def described(log: "RunLog") -> str:
    """What is in a log: datasets, outcome, provenance, events."""
    attributes = log.attributes
    lines = [f"{log.path}  run {attributes['run_id']}  schema {attributes['schema_version']}", ""]
    for name in log.names:
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


def repeated(log: "RunLog", found: "Repetition") -> str:
    """Whether a log repeats, and if not, where the two part and what differs."""
    differs = {name: (a, b) for name, (a, b) in found.differs.items() if a != b or not found.same}
    if found.same:
        lines = [f"{log.path}: same bits: {found.steps} steps, the model, events and outcome"]
    else:
        lines = [f"{log.path}: {_reason(found)}same up to {_parting(found)}"]
    if found.physics is not None:
        whole = found.physics == found.steps
        until = "all of its states" if whole else f"its states up to step {found.physics}"
        lines.append(f"  the log's torques, on its model, lead to {until}")
    if differs:
        lines.append(f"  {'':14} {'there':28} here")
        lines += [f"  {name:14} {a:28.60} {b:.60}" for name, (a, b) in differs.items()]
    elif not found.same:
        lines.append("  code, versions and C library are the same")
    return "\n".join(lines)


def _reason(found: "Repetition") -> str:
    if found.other_code:
        return "other code or versions, "
    return "a C library that rounds otherwise, " if "libm" in found.differs else ""


def _parting(found: "Repetition") -> str:
    if found.parted is None:
        return f"the end, then other: {_some(found.whole)}"
    where = f"t = {found.time:.3f} s, step {found.parted} of {found.steps}, then "
    if found.first:
        return f"{where}other: {_some(found.first)}"
    return where + ("it goes on here" if found.parted == found.steps else "it ends here")


def _some(names: tuple[str, ...], most: int = 3) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


_KINDS = {
    "left": "forward roll",
    "right": "backward roll",
    "head": "log roll",
    "face": "cartwheel",
}
_POOR = 10.0  # [deg] median error of a segment that is told
_DOUBTFUL = 0.8  # of the second axis's share of the first's
_FALLS = 0.5  # [m/s2] what falls slower does not fall


def adopted(found: "Adopted") -> str:
    """What a foreign humanoid is as a character."""
    made = found.character
    lines = [f"{made['name']}  {made['height']:.2f} m, {made['mass']:.1f} kg"]
    lines += [f"  {role:16} {body}" for role, body in found.roles.items()]
    lines.append("  joint            the file's; range [rad], torque limit [N m]")
    for body in made["bodies"]:
        for joint in body.get("joints", ()):
            low, high = joint["range"]
            lines.append(
                f"  {joint['name']:16} {found.joints[joint['name']]}; {low:.2f} to {high:.2f}, "
                f"{joint['torque']:g}"
            )
    if made["absent"]:
        lines.append(
            f"  it has no        {', '.join(made['absent'])}: poses that name them are taken"
        )
    return "\n".join([*lines, *(f"  note: {note}" for note in found.notes)])


def imported(made: "Imported") -> str:
    """How well a captured roll became a clip."""
    import numpy as np

    clip, degrees = made.clip, np.degrees(made.error)
    gap = np.abs(made.closed.gap)
    lines = [f"{_KINDS[clip.roll_about]}, {made.start:.3f} to {made.end:.3f} s of the file"]
    if made.mirrored:
        side = "head" if clip.roll_about == "head" else "face"
        lines.append(
            f"  left and right are exchanged, so that the {side} is to the left of the way"
        )
    if made.up:
        lines.append(f"  up           the file's {made.up}; if not, see --up")
    if made.false_start:
        lines.append("  left out     the first frame, which is no neighbour of the second")
    parts = ("hip", "knee", "ankle", "ball", "shoulder", "elbow", "wrist")
    lines += [
        f"  {name:12} {', '.join(made.roles.get(role, '-') for role in roles)}"
        for name, roles in (
            ("trunk", ("hips", "neck", "head")),
            ("left", [f"left_{part}" for part in parts]),
            ("right", [f"right_{part}" for part in parts]),
        )
    ]
    lines.append("  segment         error [deg] median   95 %")
    for name, middle, high in zip(
        made.segments, np.median(degrees, axis=0), np.percentile(degrees, 95, axis=0), strict=True
    ):
        lines.append(f"  {name:22} {middle:11.1f} {high:6.1f}")
    lines += [
        f"  turns        {made.span:.2f} rev in {made.end - made.start:.2f} s, "
        f"{made.span / (made.end - made.start):.2f} rev/s, {made.speed:.2f} m/s",
        f"  turns back   {100 * made.closed.backwards:.0f} % of the time",
        f"  loop gap     {np.sqrt(np.mean(gap**2)):.2f} rad rms, {gap.max():.2f} rad at most "
        f"({made.joint_names[int(gap.argmax())]}), pelvis "
        f"{np.degrees(made.closed.pelvis_gap):.0f} deg; spread over the cycle",
    ]
    lines += [
        f"  flight       {flight.start:.2f} to {flight.end:.2f} s falls at {flight.fall:.1f} m/s2"
        for flight in made.flights
    ]
    return "\n".join(lines)


def import_warnings(made: "Imported") -> list[str]:
    """What speaks against a clip: segments that do not follow, a kind in doubt, a clock."""
    import numpy as np

    degrees = np.degrees(np.median(made.error, axis=0))
    poor = [
        f"{name} {angle:.0f}"
        for name, angle in zip(made.segments, degrees, strict=True)
        if angle > _POOR
    ]
    found = []
    if poor:
        found.append(
            f"these do not follow the actor (median error [deg]): {', '.join(poor)}; look at the "
            "joints found and at --filmstrip"
        )
    if made.doubt > _DOUBTFUL:
        found.append(
            f"nearly as much about another axis of the trunk ({made.doubt:.2f} to 1): "
            f"{_KINDS[made.clip.roll_about]} is hardly the word"
        )
    return found + [_clock(flight) for flight in made.flights if not flight.plausible]


def _clock(flight: "Flight") -> str:
    """What a flight says against the clock of a capture."""
    said = (
        f"the flight from {flight.start:.2f} to {flight.end:.2f} s falls at {flight.fall:.1f} m/s2"
    )
    if flight.fall < _FALLS:
        return f"{said}, not 9.81: is it a flight, is up up, do the hips move? See --up"
    return (
        f"{said}, not 9.81: the file's clock runs {flight.haste:.2f} times as fast as the motion "
        "did; see --rate"
    )
