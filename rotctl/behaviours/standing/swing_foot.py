"""Which foot swings: whose step leaves the body nearest to where it can come to rest."""

from math import sqrt
from typing import TYPE_CHECKING

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene, Step
from rotctl.behaviours.standing import footholds
from rotctl.behaviours.support import FACING
from rotctl.mechanics.bodies import ROOT_BODY

if TYPE_CHECKING:  # whose numbers these are
    from rotctl.behaviours.standing.stepping import Stepping

NEAR = 0.01  # [m] over the ground: a foot that has just lost it
STAGGERED = 0.15  # [m] feet so far one before the other: the one behind swings


def chosen(said: "Stepping", scene: Scene, touching: list[int]) -> int:
    """The foot to swing, of those that touch the ground: never the only one that stands."""
    left, right = feet = said.feet(scene.model)
    bearing = {*touching, *_near(said, scene)} if said.away else {*touching}
    if left not in bearing or right not in bearing:
        return right if left in bearing else left
    if not said.away:
        return _by_sides(said, scene)
    return min(feet, key=lambda foot: _cost(said, scene, foot))


def _by_sides(said: "Stepping", scene: Scene) -> int:
    """The foot of the side to which the capture point lies, else the one that is behind."""
    model, state = scene.model, scene.state
    left, right = feet = said.feet(model)
    (lx, ly), (rx, ry) = (support.middle(support.ends(model, state.data, (f,))) for f in feet)
    x, y = footholds.capture_point(said, scene)
    forward = FACING[said.facing](state, ROOT_BODY)
    _, aside = support.turned(x - 0.5 * (lx + rx), y - 0.5 * (ly + ry), forward, -1.0)
    ahead, wide = support.turned(lx - rx, ly - ry, forward, -1.0)
    near, far = (left, right) if aside > 0.0 else (right, left)
    if abs(aside) > said.aside:
        way = (abs(aside) + 0.5 * abs(wide)) * footholds.grown(scene, said.time)
        far_out = said.narrow > 0.0 and abs(wide) > said.narrow and way > said.reach
        return far if far_out else near
    if abs(ahead) > STAGGERED:
        to_left = (lx - x) ** 2 + (ly - y) ** 2
        to_right = (rx - x) ** 2 + (ry - y) ** 2
        return left if to_left > to_right else right
    return far


def _cost(said: "Stepping", scene: Scene, swing: int) -> float:
    """Of a step with this foot [m]: how far the capture point is outside both feet then.

    And how far it has run, away from the foot that stands. Pushed to a side it is better to
    swing the loaded foot where the other one, on its own side, would not get beyond the point,
    and worse where the loaded one has just come down out there and all but reached it.
    """
    data, (left, right) = scene.state.data, said.feet(scene.model)
    stance = right if swing == left else left
    stands = support.ends(scene.model, data, (stance,))
    swings = support.ends(scene.model, data, (swing,))
    fx, fy = support.middle(swings)
    x, y = footholds.landing(said, scene, Step(swing, stance), said.time)
    landed = [(ex + x - fx, ey + y - fy) for ex, ey in swings]
    px, py = footholds.escaped(said, scene, stands, said.time)
    nx, ny = footholds.capture_point(said, scene)
    missed = max(support.outside(support.hull(stands + landed), (px, py)), 0.0)
    return missed + said.away * sqrt((px - nx) ** 2 + (py - ny) ** 2)


def _near(said: "Stepping", scene: Scene) -> list[int]:
    """The feet that could bear in a moment."""
    model, data = scene.model, scene.state.data
    lowest = {foot: support.lowest_end(model, data, foot) for foot in said.feet(model)}
    return [f for f, (x, y, z) in lowest.items() if z - model.ground.height(x, y) < NEAR]
