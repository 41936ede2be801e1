#!/usr/bin/env bash
# A shoe of friction 0.5 on a floor of 1.0: MuJoCo slides at 1.0, Drake at 0.67 and PyBullet at 0.5.
#
# Expected: with both coefficients given, simulators with Coulomb friction grip alike; the smaller or a mean of the two holds.
# Happens: each has its own rule for the pair, and none says so when a model is loaded. MuJoCo takes the larger (unless
#   priorities or a <pair> say otherwise), Drake 2 a b / (a + b), Bullet the product. A sledge at 3 m/s stops after 0.46,
#   0.69 and 0.92 m. Where both are 1, all agree; where both are 0.5, Bullet has 0.25.
# Seen with: mujoco 4.0.0 (elliptic cone), drake 1.51.1 (point contact), pybullet 3.2.7.
# Means: "the same model with lower friction" is no such thing: lowering the floor alone changes nothing in MuJoCo as long as the
#   feet stay at 1. For the same grip give both sides the value wanted in MuJoCo and Drake, and in Bullet one side that
#   value and the other 1.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary pybullet \
    mujoco==4.0.0 drake==1.51.1 pybullet==3.2.7 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import logging
from importlib.metadata import version

import mujoco
import pybullet
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

logging.getLogger("drake").setLevel(logging.ERROR)
SPEED, STEP, GRAVITY, RADIUS, SPREAD = 3.0, 0.001, 9.81, 0.02, 0.5
FEET = [(x, y) for x in (-SPREAD, SPREAD) for y in (-SPREAD, SPREAD)]
RULES = {"mujoco": max, "drake": lambda a, b: 2 * a * b / (a + b), "pybullet": lambda a, b: a * b}


def model(foot, floor):
    """Four balls in one body on a plane."""
    feet = "".join(f'<geom size="{RADIUS}" pos="{x} {y} 0" mass="2.5" friction="{foot} 0 0"/>' for x, y in FEET)
    return f"""<mujoco model="sledge"><option timestep="{STEP}" cone="elliptic" gravity="0 0 -{GRAVITY}"/><worldbody>
    <geom type="plane" size="20 20 1" friction="{floor} 0 0"/>
    <body name="sledge" pos="0 0 {RADIUS}"><freejoint/>{feet}</body></worldbody></mujoco>"""


def by_mujoco(foot, floor):
    loaded = mujoco.MjModel.from_xml_string(model(foot, floor))
    data = mujoco.MjData(loaded)
    mujoco.mj_step(loaded, data, 1000)  # comes to rest
    start, data.qvel[0] = data.qpos[0], SPEED
    mujoco.mj_step(loaded, data, 3000)
    return data.qpos[0] - start


def by_drake(foot, floor):
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, STEP)
    Parser(plant).AddModelsFromString(model(foot, floor), "xml")
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    simulator.AdvanceTo(1.0)
    start = plant.GetPositions(context)[4]
    plant.SetVelocities(context, [0, 0, 0, SPEED, 0, 0])
    simulator.AdvanceTo(4.0)
    return plant.GetPositions(context)[4] - start


def by_pybullet(foot, floor):
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -GRAVITY)
    pybullet.setTimeStep(STEP)
    plane = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[SPREAD, SPREAD, RADIUS])
    sledge = pybullet.createMultiBody(10, box, basePosition=[0, 0, RADIUS])
    pybullet.changeDynamics(plane, -1, lateralFriction=floor)
    pybullet.changeDynamics(sledge, -1, lateralFriction=foot, linearDamping=0, angularDamping=0)
    for step in range(4000):
        if step == 1000:
            start = pybullet.getBasePositionAndOrientation(sledge)[0][0]
            pybullet.resetBaseVelocity(sledge, [SPEED, 0, 0])
        pybullet.stepSimulation()
    return pybullet.getBasePositionAndOrientation(sledge)[0][0] - start


pybullet.connect(pybullet.DIRECT)
print(*(f"{name} {version(name)}" for name in RULES), "- friction felt, from the way to a stop at 3 m/s")
for foot, floor in ((1.0, 1.0), (0.5, 1.0), (1.0, 0.5), (0.5, 0.5)):
    for name, by in (("mujoco", by_mujoco), ("drake", by_drake), ("pybullet", by_pybullet)):
        way = by(foot, floor)
        felt = SPEED**2 / 2 / GRAVITY / way
        print(f"foot {foot}, floor {floor}, {name:8s}: stops after {way:.3f} m, friction {felt:.3f}")
        if abs(felt - RULES[name](foot, floor)) > 0.02:
            raise SystemExit(f"CHANGED: {name} has another rule for the friction of a pair")
PY
