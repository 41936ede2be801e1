"""What makes who has come to rest step all the same: feet too far apart, or turned too far."""

from math import cos, radians
from typing import TYPE_CHECKING

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.support import FACING
from rotctl.mechanics.bodies import ROOT_BODY

if TYPE_CHECKING:  # whose numbers these are
    from rotctl.behaviours.standing.stepping import Stepping

CALM = 0.2  # [m/s] of the centre of mass: it rests
TURNS = 0.5  # [rad/s] of the whole body about the upright, from which on it does not
SHORT = cos(radians(12.0))  # of the turn that it was to make: nearer is there


def sprawls(said: "Stepping", scene: Scene) -> bool:
    """Whether it has come to rest with its feet further apart than people stand."""
    if not said.gather:
        return False
    model, state = scene.model, scene.state
    (lx, ly), (rx, ry) = (
        support.middle(support.ends(model, state.data, (foot,))) for foot in said.feet(model)
    )
    return (lx - rx) ** 2 + (ly - ry) ** 2 > said.gather**2 and _rests(scene)


def twisted(said: "Stepping", scene: Scene, touching: list[int]) -> int:
    """The foot that keeps it from facing where it should, if one does; else 0."""
    if not said.twist or not _rests(scene):
        return 0
    feet, state = said.feet(scene.model), scene.state
    turns = abs(float(state.momentum.angular_velocity[2])) > TURNS
    there = cos(scene.target - scene.turned) > SHORT
    if turns or there or not {*feet} <= {*touching}:
        return 0
    fx, fy = FACING[said.facing](state, ROOT_BODY)
    fronts = {foot: support.forward(state, foot) for foot in feet}
    along = {foot: fx * x + fy * y for foot, (x, y) in fronts.items()}
    furthest = min(feet, key=along.__getitem__)
    return furthest if along[furthest] < cos(radians(said.twist)) else 0


def _rests(scene: Scene) -> bool:
    """Whether its centre of mass does."""
    vx, vy, _ = scene.state.momentum.com_velocity.tolist()
    return vx * vx + vy * vy < CALM**2
