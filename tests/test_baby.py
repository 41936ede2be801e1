"""A baby turns over, [Brown2013] section 6 and Figure 3."""

import math

import numpy as np

from rotctl.config import load
from rotctl.scenario import build
from rotctl.simulation.episode import Episode


def test_a_baby_turns_onto_its_front_and_stays():
    """What counts is the front's direction at the end."""
    scenario = build(load(["behaviour=baby_roll_over", "seed=2002"]))
    for moment in Episode(scenario):
        if moment.state.time >= 4.0:
            break
    front, axis = moment.state.trunk_axes[:, 0], moment.state.trunk_axes[:, 2]
    assert front[2] < -math.cos(math.radians(30.0))
    assert abs(axis[2]) < math.sin(math.radians(30.0))


def test_the_baby_has_the_mass_and_shares_that_its_source_has():
    """Trunk 48 %, head 16 %, both legs 25 %, both arms 10 % of 9 kg, from MIMo's body masses."""
    mj = build(load(["behaviour=baby_roll_over"])).model.mj
    masses = {mj.body(i).name: float(mj.body_mass[i]) for i in range(mj.nbody)}
    source = {"pelvis": 1.1584, "waist": 1.3245, "chest": 2.7598, "head": 1.7874}
    limbs = {"upper_arm": 0.2684, "forearm": 0.2926, "thigh": 0.7998, "shin": 0.4501}
    whole = sum(source.values()) + 2 * (sum(limbs.values()) + 0.12647)
    for name, mass in {**source, **{f"{k}_l": v for k, v in limbs.items()}}.items():
        np.testing.assert_allclose(masses[name] / 9.0, mass / whole, atol=2e-4)
