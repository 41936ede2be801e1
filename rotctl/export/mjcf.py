"""The model of a log as text that other simulators take, limits included.

The same model bit by bit, but for one flag: MuJoCo's reset of a state that broke down is on again,
as it is nothing that others know. What MuJoCo leaves out, because it is the default, is written
out, and what it writes in a way of its own is written in the common one:

- `motor` for `general`: Drake knows no other;
- each joint's largest torque at the joint too (`actuatorfrcrange`): Pinocchio and Newton ask it;
- both numbers of `solreflimit`: Newton takes a missing one for 0;
- type and axis of joints and geoms: PyBullet has no defaults.
"""

from xml.etree import ElementTree

from rotctl.report.stored_model import checked

_OF_A_MOTOR = {"name", "class", "joint", "ctrllimited", "ctrlrange", "gear", "group"}


def mjcf(text: str) -> str:
    """The text for others of a log's own.

    Raises:
        LogError: it is no model that a log may have.
    """
    root = ElementTree.fromstring(checked(text))
    limits = {}
    for element in root.iter("actuator"):
        for actuator in element:
            if actuator.tag == "general" and set(actuator.attrib) <= _OF_A_MOTOR:
                actuator.tag = "motor"
            if actuator.tag == "motor" and actuator.get("ctrlrange"):
                limits[actuator.get("joint")] = _torque(actuator)
    for joint in root.iter("joint"):
        joint.attrib.setdefault("type", "hinge")
        if joint.get("type") == "hinge":
            joint.attrib.setdefault("axis", "0 0 1")
        if joint.get("name") in limits:
            joint.attrib.setdefault("actuatorfrcrange", limits[joint.get("name")])
        soft = joint.get("solreflimit", "")
        if len(soft.split()) == 1:
            joint.set("solreflimit", f"{soft} 1")
    for geom in root.iter("geom"):
        geom.attrib.setdefault("type", "sphere")
    for option in root.iter("option"):
        for flag in option.findall("flag"):
            flag.attrib.pop("autoreset", None)
            if not flag.attrib:
                option.remove(flag)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _torque(motor: ElementTree.Element) -> str:
    """What a motor gives at most, in both directions [N m]."""
    gear = abs(float((motor.get("gear") or "1").split()[0]))
    return " ".join(f"{gear * float(x):.10g}" for x in motor.get("ctrlrange", "").split())
