"""Where a foot comes down: where the body can come to rest over it.

With the whole body's angular momentum H the body comes to rest over

    c + v / omega + spin (H_y, -H_x) / (m z omega),

the capture point as if H, too, were gone there. While a foot is on its way, pressure stays under
the other one, from which that point runs away as e^(omega t).
"""

from math import exp, sqrt
from typing import TYPE_CHECKING

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene, Step
from rotctl.behaviours.support import FACING, Point
from rotctl.mechanics.bodies import ROOT_BODY

if TYPE_CHECKING:  # whose numbers these are
    from rotctl.behaviours.standing.stepping import Stepping


def capture_point(said: "Stepping", scene: Scene) -> Point:
    """Where the body comes to rest, its angular momentum gone, seen from above [m]."""
    model, momentum = scene.model, scene.state.momentum
    rate = support.pendulum_rate(model, scene.state)
    x, y = support.capture_point(scene.state, rate)
    # m z omega = m g / omega
    share = said.spin * rate / (model.mass * -float(model.gravity[2]))
    return x + share * float(momentum.angular[1]), y - share * float(momentum.angular[0])


def grown(scene: Scene, time: float) -> float:
    """How many times further from the pressure a capture point is after a time [s]."""
    return exp(support.pendulum_rate(scene.model, scene.state) * time)


def escaped(said: "Stepping", scene: Scene, ends: list[Point], time: float) -> Point:
    """Where the capture point is after a time [s], pressed by a foot as near as it reaches.

    Args:
        ends: of that foot, seen from above [m].
    """
    x, y = capture_point(said, scene)
    px, py = support.within(support.hull(ends), support.middle(ends), (x, y), 0.0)
    times = grown(scene, time)
    return px + times * (x - px), py + times * (y - py)


def landing(said: "Stepping", scene: Scene, step: Step, left: float) -> Point:
    """Where the middle of the swing foot should be [m], `left` [s] before it is down."""
    ends = support.ends(scene.model, scene.state.data, (step.stance,))
    fx, fy = support.middle(ends)
    x, y = escaped(said, scene, ends, left)
    dx, dy = x - fx, y - fy
    far = sqrt(dx * dx + dy * dy)
    beyond = 1.0 + said.over / far if far > 0.0 else 1.0
    forward = FACING[said.facing](scene.state, ROOT_BODY)
    ahead, aside = support.turned(beyond * dx, beyond * dy, forward, -1.0)
    share = min(1.0, said.reach / (sqrt(ahead * ahead + aside * aside) or 1.0))
    side = 1.0 if step.swing == said.feet(scene.model)[0] else -1.0
    aside = side * max(side * share * aside, said.width)
    dx, dy = support.turned(share * ahead, aside, forward, 1.0)
    return fx + dx, fy + dy
