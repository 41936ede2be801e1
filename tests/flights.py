"""Bodies spawned in the air with a given angular momentum, that fly until they land."""

from dataclasses import dataclass
from functools import cache
from math import atan2, degrees, pi, tau

import mujoco
import numpy as np

from rotctl.config.loading import composed
from rotctl.config.schema import check
from rotctl.maths.rotations import quaternion_from_rotation_vector
from rotctl.mechanics.bodies import is_character, lowest_and_highest
from rotctl.mechanics.shape import Shapes
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

LEFT = np.array([0.0, 1.0, 0.0])
LIMBS = {
    "hip": "thigh",
    "knee": "shin",
    "ankle": "foot",
    "neck": "head",
    "shoulder": "upper_arm",
    "elbow": "forearm",
}
TRUNK = {"spine": "waist", "ribs": "chest"}
TUCK = {
    "hip_y": 2.1,
    "hip_x": 0.3,
    "knee": 2.6,
    "waist_y": 0.2,
    "chest_y": 0.65,
    "neck_y": 0.6,
    "shoulder_y": 0.7,
    "shoulder_x": 0.3,
    "elbow": 0.6,
    "ankle_y": -0.8,
}
LONG = {"shoulder_y": 3.05, "ankle_y": -0.85, "elbow": 0.02, "knee": 0.02}
ARCHED = LONG | {"hip_y": -0.3, "waist_y": -0.2, "chest_y": -0.2}
HEAD_FIRST = {
    "entry": {"pose": LONG, "attitude": 0.0, "bodies": ["forearm"]},
    "tuck": TUCK,
    "stretch": ARCHED,
    "opening": 0.35,
    "change": 0.15,
}


@cache
def _standing():
    return composed(["behaviour=stand", "controller=acrobatic", "excursion=trunk"])


def flier(turns, flight=HEAD_FIRST):
    """A scenario whose one real stage is a flight of so many whole turns about left."""
    data = {**_standing()}
    turn = {"target_excursion": 360.0 * turns, "targets": None}  # stand is a motion of 0 deg
    data["behaviour"] = behaviour = {**data["behaviour"], **turn}
    tasks = {
        name: {"kind": "joints", "body": body, "gains": gains, "aim": {"law": "pose"}}
        for group, gains in ((LIMBS, "air"), (TRUNK, "air_torso"))
        for name, body in group.items()
    }
    behaviour["tasks"] = {}
    behaviour["stages"] = [
        {
            "name": "stand",
            "poses": behaviour["stages"][0]["poses"],
            "until": {"kind": "after", "seconds": 0.0},
        },
        {"name": "flight", "flight": flight, "tasks": tasks, "pose": "flight"},
    ]
    return build(check(data))


@dataclass(frozen=True)
class Landed:
    """How a flight ended.

    Attributes:
        error: of the pelvis's attitude [deg], in the sense of the flight.
        time: it took [s].
        drift: of the angular momentum, greatest part of it [-].
    """

    error: float
    time: float
    drift: float


def fly(scenario, momentum, height, up, pitch, across=(0.0, 0.0)):
    """Fly from a height of the centre of mass [m], moving up [m/s], pitched in the sense [rad].

    Args:
        momentum: about left, in the sense of the flight; across: forward and up [kg m2/s].
    """
    model, episode = scenario.model, Episode(scenario)
    data, law = episode.data, scenario.behaviour._laws["flight"]
    sense, entry = law._sense, law.landing.usual
    wanted = np.array([across[0], sense * momentum, across[1]])
    spawn(model, data, law.tucking.pose(-0.6, entry), sense * pitch, height, up, wanted)
    first = None
    solid = is_character(model.mj)[model.mj.geom_bodyid] & (model.mj.geom_contype > 0)
    for moment in episode:
        now = moment.state.momentum.angular
        first = now if first is None else first
        if lowest_and_highest(model.mj, data, solid)[0] <= 0.0:
            break
    front = moment.state.momentum.root_rotation[:, 0]
    missed = atan2(-front[2], front[0]) - law._target - entry.attitude
    error = degrees((sense * missed + pi) % tau - pi)
    return Landed(error, moment.state.time, abs(now - first).max() / abs(first).max())


def spawn(model, data, pose, pitch, height, up, angular):
    """Put the body into the air with an angular momentum (3,) about its centre of mass."""
    mujoco.mj_resetData(model.mj, data)
    data.qpos[:3] = 0.0
    data.qpos[3:7] = quaternion_from_rotation_vector(pitch * LEFT)
    data.qpos[model.angles] = pose
    mujoco.mj_forward(model.mj, data)
    offset = data.subtree_com[1] - data.xpos[1]
    turn = data.xmat[1].reshape(3, 3)
    inertia = turn @ np.array(Shapes(model).spin(pose).inertia) @ turn.T
    spin = np.linalg.solve(inertia, angular)
    data.qpos[2] += height - data.subtree_com[1, 2]
    data.qvel[:3] = np.array([0.0, 0.0, up]) - np.cross(spin, offset)
    data.qvel[3:6] = turn.T @ spin
