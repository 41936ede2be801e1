#!/usr/bin/env bash
# Attach a model in radians to one in degrees with dm_control's mjcf: the limits of the first become radians, too.
#
# Expected: an attached part brings its own angles along, converted if need be, and leaves the model that it is put on
#   as it was. Where the two cannot agree, an error: for two files that both say `angle`, each otherwise, one comes.
# Happens: a file that does not say `angle` is in degrees, by the format's default. Attach a file with angle="radian" to
#   it and the joined model takes that over for all: a joint of +-90 degrees now has limits of +-90 rad, in effect none.
#   Nothing is said, and the joined model compiles. The other way round is the same: a root in radians makes radians of
#   the numbers of a part that says nothing.
# Seen with: dm_control 1.0.50 with mujoco 4.0.0, mjcf.from_xml_string, Element.attach.
# Means: a character with a gripper, a ball or a terrain put on it may lose its joint limits (and turn its bodies by
#   `euler`) without a word. Write `angle` into each file: then a contradiction is an error. Compare jnt_range before and
#   after.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dm_control==1.0.50 mujoco==4.0.0
cd "$work"
MUJOCO_GL=disable "$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mujoco
from dm_control import mjcf


def model(name, angle, limits):
    compiler = f'<compiler angle="{angle}"/>' if angle else ""
    return mjcf.from_xml_string(
        f'<mujoco model="{name}">{compiler}<worldbody><body name="limb">'
        f'<joint name="joint" limited="true" range="{limits}"/><geom size="0.1"/>'
        '<site name="end"/></body></worldbody></mujoco>'
    )


def limits(root):
    return mujoco.MjModel.from_xml_string(root.to_xml_string()).jnt_range[:, 1].round(4).tolist()


def joined(angle, limit, angle_of_part, limit_of_part):
    root, part = model("arm", angle, limit), model("hand", angle_of_part, limit_of_part)
    alone = limits(root) + limits(part)
    root.find("site", "end").attach(part)
    return alone, limits(root)


print("dm_control", version("dm_control"), "mujoco", mujoco.__version__)
print("upper limits [rad] alone, and joined")
onto_degrees = joined(None, "-90 90", "radian", "-1 1")
onto_radians = joined("radian", "-1 1", None, "-90 90")
print("a part in radians onto a root that says nothing:", *onto_degrees)
print("a part that says nothing onto a root in radians:", *onto_radians)
try:
    joined("degree", "-90 90", "radian", "-1 1")
    both = "taken"
except ValueError as error:
    both = "refused"
print("both say which:", both)
seen = onto_degrees, onto_radians, both
if seen != (([1.5708, 1.0], [90.0, 1.0]), ([1.0, 1.5708], [1.0, 90.0]), "refused"):
    raise SystemExit(f"CHANGED: {seen}")
PY
