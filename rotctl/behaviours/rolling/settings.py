"""What a roll is asked for: its rates, its poses, what keeps it at a pace and how it ends."""

import math
from typing import Annotated, Literal

from pydantic import Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.rolling.alighting import AlightingSettings
from rotctl.behaviours.rolling.catching import CatchSettings
from rotctl.behaviours.rolling.course import CourseSettings
from rotctl.behaviours.rolling.finishing import AHEAD, Finishing, FinishSettings
from rotctl.behaviours.rolling.lifting import Lift
from rotctl.behaviours.rolling.obliqueness import Oblique
from rotctl.behaviours.rolling.pace_settings import Halts, PaceSettings
from rotctl.behaviours.rolling.rolling import Rolling
from rotctl.behaviours.staged.stages import kinds_of
from rotctl.control import ControllerSettings
from rotctl.errors import InputError
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.motion import (
    PosePair,
    Poses,
    ReferencePair,
    ReferenceSettings,
    RollAbout,
    load_clip,
    make_pose_pair,
    make_reference_pair,
)
from rotctl.settings.fields import STRICT, Finite


@validated(frozen=True, config=STRICT)
class RollingSettings:
    """What Table 1 varies, and the poses: two key poses, or a reference motion.

    Attributes:
        angular_velocity: commanded in-plane angular velocity [rev/s]; negative is backward.
        speed: commanded in-plane speed of the centre of mass [m/s].
        roll_about: the trunk's axis that is kept on the rolling axis, see `FACING`.
        heading: of the way it rolls, from +x towards +y [deg].
        angular_momentum: commanded in-plane in place of the angular velocity [kg m2/s]; AV by
            default, section 7.
        align_with_slope: whether that speed is along the slope (section 6) or level.
        pace: how one of the two is kept, whatever the body makes of the pair; none is by default.
        finish: how a roll with a pace ends.
        course: where it goes from its heading; straight on by default.
        catch: what catches it where it tips over its side; nothing by default.
        oblique: how far the axis that is kept lies from there towards the head, over the phase, see
            `Oblique` [deg]; not at all by default.
        alighting: which limbs come down further to the side that it goes to; none by default.
        lift: how far it is told to rise as it turns, see `Lift` [m/rev]; not at all by default.
    """

    name: str
    kind: Literal["rolling"]
    roll_about: RollAbout
    angular_velocity: Finite
    speed: Finite
    heading: Finite
    align_with_slope: Annotated[bool, Strict()]
    poses: Poses | None = None
    reference: ReferenceSettings | None = None
    angular_momentum: Finite | None = None
    pace: PaceSettings | None = None
    finish: FinishSettings | None = None
    course: CourseSettings | None = None
    catch: CatchSettings | None = None
    oblique: Oblique | None = None
    alighting: AlightingSettings | None = None
    lift: Lift | None = None
    source: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        if (self.poses is None) == (self.reference is None):
            raise ValueError("give either poses or a reference, not both and not neither")
        if self.pace:
            if min(self.angular_velocity, self.speed) < 0.0:
                raise ValueError(
                    "a pace is kept forward: give angular_velocity and speed from 0 on"
                )
            if self.angular_momentum is not None:
                raise ValueError("a pace commands velocities: give no angular_momentum")
        if self.finish:
            if self.pace is None:
                raise ValueError("a roll without a pace does not wait, so that it has no finish")
            self.finish.staged(self.roll_about, self.heading)
        if self.course and self.angular_momentum is not None:
            raise ValueError("a course commands velocities: give no angular_momentum")
        if self.catch and self.roll_about == "head":
            raise ValueError("a roll about its head lies on its side, and has nothing to catch")
        if self.alighting and self.roll_about == "head":
            raise ValueError(
                "a roll about its head lies on its side, and no limb comes down beside it: give "
                "behaviour.alighting=null"
            )
        if self.oblique and self.roll_about == "head":
            raise ValueError(
                "an oblique axis lies between left or right and the head: roll_about=head has none"
            )

    @property
    def commanded(self) -> dict[str, float]:
        """What is asked for, as columns of the summary [rev/s, m/s, s].

        A pace keeps one of the two velocities, so that the other has no column. That of one that
        a schedule changes is NaN: no number is commanded throughout.
        """
        asked = {
            "angular_velocity_commanded": self.angular_velocity,
            "speed_commanded": self.speed,
        }
        if self.pace:
            rate, speed = asked
            kept = rate if self.pace.keep == "rate" else speed
            asked = {kept: math.nan if self.pace.schedule else asked[kept]}
        if self.finish is None:
            return asked
        rolls = self.finish.revolutions
        counted = {"revolutions_commanded": rolls, "revolutions_told": rolls - AHEAD}
        asked = asked | {"finish_commanded": self.finish.after}
        return asked | counted if rolls else asked

    @property
    def halts(self) -> Halts:
        """When a pace is told to halt, and until when [s]."""
        if self.pace is None:
            return ()
        first = self.angular_velocity if self.pace.keep == "rate" else self.speed
        return self.pace.halts(first)

    @property
    def last_told(self) -> dict[str, float]:
        """When a schedule changes a command for the last time [s], by its key here."""
        parts = {"pace": self.pace, "course": self.course}
        found = {key: getattr(part, "schedule", ()) for key, part in parts.items()}
        return {f"{key}.schedule": told[-1][0] for key, told in found.items() if told}

    @property
    def kinds(self) -> dict[str, str]:
        """Kinds of the tasks of its finish by the names of their gains; its own are its names."""
        return {} if self.finish is None else kinds_of(self.finish.tasks, self.finish.stages)

    @property
    def by_excursion(self) -> bool:
        """A roll goes by the whole of AE."""
        return True

    def make(
        self, model: Model, control: ControllerSettings, measured: ExcursionSettings
    ) -> Rolling | Finishing:
        """The behaviour of one run."""
        roll = Rolling(self, model, control, measured)
        if self.finish is None:
            return roll
        staged = self.finish.staged(self.roll_about, self.heading)
        return Finishing(self.finish, roll, staged, model, control, measured)

    def make_poses(self, model: Model) -> PosePair | ReferencePair:
        """The poses over the phase.

        Raises:
            InputError: they do not fit the model, or the clip does not fit the roll.
        """
        if self.poses:
            return make_pose_pair(model, self.poses)
        assert self.reference  # __post_init__
        reference = self.reference
        clip = load_clip(reference.clip)
        if clip.roll_about != self.roll_about:
            raise InputError(
                f"behaviour.reference.clip={reference.clip}: rolls about {clip.roll_about}, "
                f"but behaviour.roll_about={self.roll_about}"
            )
        if reference.found_for not in ("", clip.name):
            raise InputError(
                f"behaviour.reference.clip={reference.clip}: is {clip.name}, and window, lead and "
                f"offsets were found for {reference.found_for}; give the path of that clip, or "
                "behaviour.reference.found_for='' to bend another by them"
            )
        return make_reference_pair(model, clip, reference)
