"""What the command line says of a foreign humanoid that is taken for a character."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rotctl.adopting import Adopted


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
                f"  {joint['name']:16} {found.joints[joint['name']]}; {low:z.2f} to {high:z.2f}, "
                f"{joint['torque']:g}"
            )
    if made["absent"]:
        lines.append(
            f"  it has no        {', '.join(made['absent'])}: poses that name them are taken"
        )
    return "\n".join([*lines, *(f"  note: {note}" for note in found.notes)])
