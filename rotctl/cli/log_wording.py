"""What the command line says of a log: what is in it, and whether it repeats."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rotctl.log import RunLog
    from rotctl.runs.repetition import Repetition


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
