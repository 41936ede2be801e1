"""A roll that is told to go up and down: who pushes himself up over his hands, as it turns.

The height of a roll has no target, only a damper on how fast it changes, and so on every push. A
way upwards over the phase, times how fast it turns, lets it push there and no more: who hardly
turns is not held up, and who falls back is let down again.
"""

from typing import Annotated

from pydantic import Field

from rotctl.motion import FourierSeries
from rotctl.settings.fields import Finite

MOST = 20.0  # [m/rev] of the tallest body, 10 m, which rises six times as far as an adult

Lift = FourierSeries[Annotated[Finite, Field(ge=-MOST, le=MOST)]]
"""What the centre of mass is told to rise by as it turns [m/rev], over the phase."""
