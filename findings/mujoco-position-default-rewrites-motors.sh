#!/usr/bin/env bash
# In a MuJoCo default class the settings for <position> become those of every <motor>, and the other way round.
#
# Expected: <default><motor .../><position .../></default> sets the two kinds of actuator apart, as geom and joint do.
# Happens: both write into one record, so the last one wins for all. A motor with gear 100 and a range of +-1 in its
#   default comes out with gear 1 and +-3, those of the position servo listed after it. No warning.
# Seen with: mujoco 4.0.0. All actuator elements are shorthands of <general>, and a class holds one <general>.
# Means: adding a default for finger servos can take the torque away from the leg motors of a character. Give each
#   kind of actuator a class of its own, or read back actuator_gear and actuator_ctrlrange after compiling.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco

MODEL = """<mujoco><default>{}</default><worldbody><body><joint name="hinge" axis="0 1 0"/><geom size=".1"/></body></worldbody>
<actuator><motor name="leg" joint="hinge"/><position name="finger" joint="hinge"/></actuator></mujoco>"""
MOTOR = '<motor gear="100" ctrlrange="-1 1"/>'
SERVO = '<position gear="1" ctrlrange="-3 3"/>'

print("mujoco", mujoco.__version__)
seen = {}
for order, text in (("motor alone", MOTOR), ("motor, then position", MOTOR + SERVO), ("position, then motor", SERVO + MOTOR)):
    model = mujoco.MjModel.from_xml_string(MODEL.format(text))
    seen[order] = {
        name: (float(model.actuator(name).gear[0]), model.actuator(name).ctrlrange.tolist()) for name in ("leg", "finger")
    }
    print(f"default has {order:20s}: motor (gear, range) {seen[order]['leg']}, position {seen[order]['finger']}")
motor, servo = (100.0, [-1.0, 1.0]), (1.0, [-3.0, 3.0])
if seen["motor, then position"] != {"leg": servo, "finger": servo} or seen["position, then motor"] != {"leg": motor, "finger": motor}:
    raise SystemExit("CHANGED: the defaults of motor and position are kept apart")
PY
