"""What a commanded pace is told: the motion's own swing, where it waits, and how it is kept."""

from math import inf
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.settings.fields import GROWING, STRICT, Finite, NonNegative, Positive, SomeNames

Phase = Annotated[Finite, Field(ge=-1, le=1)]  # [rev] who means degrees is told
Share = Annotated[NonNegative, Field(le=1)]
Halts = tuple[tuple[float, float], ...]
SLIP = 0.5  # [rev] the clock is never further ahead or behind: it does not run away from a stall


@validated(frozen=True, config=STRICT)
class PaceSettings:
    """How a commanded pace is kept.

    Attributes:
        keep: which of the two commanded velocities is met; the other follows from `travel`.
        travel: what the body covers in a revolution [m].
        own: the motion's own pace; what is commanded slower waits [rev/s].
        calm: share of it that is held back all the way when it has to wait long [-].
        swing, swing_from: share of the angular velocity that it gains and loses over a
            revolution, and the phase where it is slowest [-, rev].
        surge, surge_from: the same of the speed [-, rev].
        wait, width: phase in which it waits, and how far to either side it does not flow [rev].
        approach: from so far before that phase on it waits, instead [rev]: who is braked on the
            way up from the seat falls back onto it. None: `width`.
        leave: so far beyond it it waits no longer [rev]: who hangs over the hands goes on. None:
            `width`.
        back: how far its poses go back while it waits [rev]. What leads a body that turns is, for
            one that stands still, a pose in which its feet have left the ground.
        over: bodies over which it waits; a name without a side is both.
        ahead: of their middle, where the centre of mass then is [m].
        settling: rates at which it comes to that phase and that place [1/s].
        brake: how much stiffer the dampers along the way are while it waits [-].
        gain: of what is waited or made good, for a revolution that it is off the clock [1/rev].
        most: how much quicker it may go there [-].
        patience: how far ahead of its clock it may be [rev]; the clock forgets what is beyond.
        easing: speed below which a halt brakes less and less [m/s]: stiff dampers stop who comes
            in, and let who stands there sink onto the seat. None: it brakes as in any wait.
        pose: angles of joints that it takes while it waits, by their names; one without a side is
            both [rad]. On the way up from the seat they come to it from `width` before on, so that
            the hands are there in time, and within `approach` whoever turns too slowly has it, late
            or not. None: its poses are those of its phase.
        schedule: times and what is commanded from then on in place of the kept velocity
            [s, rev/s or m/s]; at 0 it halts in the next squat.
    """

    keep: Literal["rate", "speed"]
    travel: Positive
    own: Positive
    calm: Annotated[NonNegative, Field(lt=1)]
    swing: Share
    swing_from: Phase
    surge: Share
    surge_from: Phase
    wait: Phase
    width: Annotated[Positive, Field(le=0.5)]
    over: SomeNames
    ahead: Finite
    settling: tuple[NonNegative, NonNegative]
    brake: Annotated[Positive, Field(ge=1)]
    gain: NonNegative
    most: Annotated[Positive, Field(ge=1)]
    easing: Positive | None = None
    approach: Annotated[Positive, Field(le=0.5)] | None = None
    leave: Annotated[Positive, Field(le=0.5)] | None = None
    back: Annotated[NonNegative, Field(le=0.5)] = 0.0
    patience: Annotated[Positive, Field(le=SLIP)] = SLIP
    pose: Annotated[dict[str, Finite], Field(min_length=1)] | None = None
    schedule: Annotated[
        tuple[tuple[NonNegative, NonNegative], ...], Field(max_length=1000), GROWING
    ] = ()

    def halts(self, first: float) -> Halts:
        """When it is told 0, and until when [s]; `first` is the command at the start."""
        begins = ((0.0, first), *self.schedule)
        ends = (*(time for time, _ in self.schedule), inf)
        spans = zip(begins, ends, strict=True)
        return tuple((begin, end) for (begin, value), end in spans if not value)
