"""What the command line says of a clip that it has made of a capture."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rotctl.motion.flight import Flight
    from rotctl.motion.importing import Imported

_KINDS = {
    "left": "forward roll",
    "right": "backward roll",
    "head": "log roll",
    "face": "cartwheel",
}
_POOR = 10.0  # [deg] median error of a segment that is told
_DOUBTFUL = 0.8  # of the second axis's share of the first's
_FALLS = 0.5  # [m/s2] what falls slower does not fall


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
        return (
            f"{said}, not 9.81: is it a flight, is up up, do the hips move, is the rate right? "
            "See --up and --rate"
        )
    return (
        f"{said}, not 9.81: the file's clock runs {flight.haste:.2f} times as fast as the motion "
        "did; see --rate"
    )
