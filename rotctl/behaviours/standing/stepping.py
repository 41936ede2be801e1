"""Capture steps: a foot goes where the body can come to rest over it.

Where the capture point leaves the feet, one of them (`standing.swing_foot`) becomes the
swing foot and goes to where that point will be when the foot is down
(`standing.footholds`); pressure stays under the other foot meanwhile.
"""

from dataclasses import field
from functools import lru_cache
from typing import Annotated, Literal

import mujoco
from pydantic import AfterValidator
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene, Step
from rotctl.behaviours.standing import footholds, stance, swing_foot
from rotctl.behaviours.standing.swinging import SOONEST, arrival, rise, velocity_of
from rotctl.behaviours.support import Facing
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.mechanics.bodies import body_id
from rotctl.mechanics.model import Model
from rotctl.settings.fields import SPARSE, STRICT, NonNegative, Positive, each_once

DOWN = 0.5  # of a swing, from which on a touch ends it
LATE = 1.5  # swings, after which one ends that met no ground


@validated(frozen=True, config=STRICT)
class Stepping:
    """Swing a foot to the capture point; one that does not swing has no weight here: point.

    Attributes:
        bodies: the left foot and the right one.
        margin: that the capture point may be outside the feet [m].
        spin: share of the angular momentum that the step is to catch [-].
        time: that a swing takes [s].
        lift: of the foot in its middle [m].
        height: of the task's point above the ground when the foot stands [m].
        over: that the foot goes beyond the capture point [m].
        reach: furthest from the other foot, but for the width [m].
        width: of the stance at least, from foot to foot; legs do not cross [m].
        fall: no step begins while the body falls faster: two legs have to brake it [m/s].
        aside: capture points further to a side than this are followed by that side's foot [m].
        facing: axis of the pelvis by which it knows its sides: its front, or its left, which stays
            level however far it bows. Past level its front points behind it.
        narrow: in a stance wider than this the foot beyond which the capture point lies does not
            swing out of reach: the other one comes in first [m]; 0 lets it.
        away: of the two feet the one swings whose step leaves the capture point less far outside
            them, a metre that the point runs away meanwhile counted as so many of those [-]; 0 goes
            by `aside` and `narrow` in place of that.
        gather: who has come to rest with feet further apart brings them together [m], more than
            `width`; 0 lets them.
        twist: who has come to rest off its target, with a foot turned further than this from where
            the pelvis faces, steps with that foot [deg]: a hip is at its stop there, and the trunk
            turns no further. For turns about up; 0 lets it.
    """

    law: Literal["step"]
    bodies: Annotated[tuple[str, str], AfterValidator(each_once)]
    margin: NonNegative
    spin: NonNegative
    time: Positive
    lift: NonNegative
    height: NonNegative
    over: NonNegative
    reach: Positive
    width: NonNegative
    fall: Positive
    aside: NonNegative = 0.0
    facing: Facing = "front"
    narrow: NonNegative = 0.0
    away: NonNegative = 0.0
    gather: NonNegative = 0.0
    twist: NonNegative = field(default=0.0, metadata=SPARSE)

    def __post_init__(self) -> None:
        for name in ("aside", "narrow"):
            if self.away and getattr(self, name):
                raise ValueError(
                    f"{name}={getattr(self, name):g}: acts on nothing, the foot is chosen by away; "
                    f"give {name}=0 or away=0"
                )
        if 0.0 < self.gather <= self.width:
            raise ValueError(
                f"gather={self.gather:g}: must be 0 or more than width={self.width:g}, which it "
                "comes to"
            )

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        for body in self.bodies:
            body_id(model.mj, body, f"{key}.bodies")

    def next(self, scene: Scene) -> Step:
        """The step of this instant, from that of the control step before."""
        step, model, state = scene.step, scene.model, scene.state
        touching = state.contacts.body.tolist()
        if step.swing:
            gone = state.time - step.begin
            down = gone > DOWN * self.time and step.swing in touching
            ends = down or gone > LATE * self.time
            return Step() if ends else step
        left, right = self.feet(model)
        falls = float(state.momentum.com_velocity[2]) < -self.fall
        if falls or not {left, right} & set(touching):
            return step
        corners = support.hull(support.ends(model, state.data, (left, right)))
        hangs = any(support.lifted(model, state, foot) for foot in (left, right))
        stays = support.outside(corners, footholds.capture_point(self, scene)) < self.margin
        settled = stays and not hangs
        twisted = stance.twisted(self, scene, touching) if settled else 0
        if settled and not twisted and not stance.sprawls(self, scene):
            return step
        swing = twisted or swing_foot.chosen(self, scene, touching)
        return Step(swing, right if swing == left else left, state.time)

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set what the swing foot should do."""
        step, body, data = scene.step, int(task["body"]), scene.state.data
        if step.swing != body:
            task["weight"] = 0.0
            return
        place = data.xpos[body] + product(data.xmat[body].reshape(3, 3), task["point"])
        velocity = velocity_of(scene, body, place)
        gone = min((scene.state.time - step.begin) / self.time, 1.0)
        left = self.time * (1.0 - gone)
        x, y = footholds.landing(self, scene, step, left)
        px, py, _ = place.tolist()
        vx, vy, _ = velocity.tolist()
        soon = max(left, SOONEST)
        task["acceleration"] = [arrival(x - px, vx, soon), arrival(y - py, vy, soon), 0.0]
        rise(task, scene, self, gone, place, velocity)

    def feet(self, model: Model) -> tuple[int, int]:
        """MuJoCo ids of the left foot and the right one."""
        return _ids(model.mj, self.bodies)


@lru_cache(maxsize=64)
def _ids(mj: mujoco.MjModel, bodies: tuple[str, str]) -> tuple[int, int]:
    left, right = bodies
    return body_id(mj, left), body_id(mj, right)
