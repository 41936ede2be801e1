"""A baby turns over, or tries to, [Brown2013] section 6 and Figure 3."""

from types import SimpleNamespace

import numpy as np
import pytest

from rotctl.behaviours.staged.posing import Beyond, OverPhase
from rotctl.config.loading import load
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise

SEEDS = range(2000, 2006)
MOST = 4  # of six; nineteen of twenty do


def turns(*overrides):
    """How far the trunk has turned, furthest and at the end, and whether it is a success."""
    found = []
    for seed in SEEDS:
        scenario = build(load([*overrides, f"seed={seed}", "duration=8"]))
        found.append(summarise(scenario, *in_memory(scenario), 1.0))
    names = ("turned_most", "turned", "success")
    return (np.array([summary[name] for summary in found]) for name in names)


@pytest.mark.parametrize("target", [180, -180, 90, -120, 105, 150])
def test_a_baby_turns_as_far_as_it_is_told_and_stays(target):
    _, turned, success = turns("behaviour=baby_roll_over", f"behaviour.target_excursion={target}")
    assert success.sum() >= MOST
    assert (np.abs(turned - target) < 10.0).sum() >= MOST


class Phases:
    """A pair of poses that tells at which phase it is asked."""

    def at(self, phase):
        return np.full((2, 1), phase)


def missing_of(missing):
    return SimpleNamespace(target=1.0, turned=1.0 - missing, excursion=SimpleNamespace(phase=2.0))


@pytest.mark.parametrize(
    ("missing", "ahead"), [(0.0, 0.0), (0.1, 0.25), (-0.1, -0.25), (0.5, 0.6), (-0.5, -0.6)]
)
def test_a_pose_goes_on_beyond_a_target_by_what_is_missing(missing, ahead):
    law = OverPhase(Phases(), lead=0.6, beyond=Beyond(gain=1.5, time=2.0))
    poses, speeds = law.poses(missing_of(missing), None)
    assert poses == pytest.approx(2.0 + ahead)
    assert not speeds.any()


def test_and_goes_on_for_as_long_as_it_is_missing():
    """By as much again in that time, and no further than it may be ahead, from where it returns."""
    law = OverPhase(Phases(), lead=0.6, beyond=Beyond(gain=1.5, time=2.0))
    further = [None]
    for missing in [0.1] * 400 + [0.4] * 400 + [-0.4] * 60:
        further.append(law.advance(further[-1], missing_of(missing), 0.005))
    assert further[400] == pytest.approx(1.5 * 0.1)
    assert law.poses(missing_of(0.1), further[400])[0] == pytest.approx(2.0 + 0.25 + 0.15)
    assert further[800] == pytest.approx(0.6)
    assert further[860] == pytest.approx(0.6 - 0.4 * 1.5 * 0.15)
    assert law.poses(missing_of(0.0), further[860])[0] == pytest.approx(2.0 + further[860])


def test_without_it_a_pose_stops_at_the_target():
    law = OverPhase(Phases(), lead=0.6)
    assert law.advance(None, missing_of(0.1), 0.005) is None
    assert law.poses(missing_of(0.1), None)[0] == pytest.approx(2.1)


def test_a_weak_one_tries_and_does_not_make_it():
    """What it lacks is K_s^H alone."""
    most, turned, success = turns("behaviour=baby_weak")
    assert success.sum() <= 1
    assert (most > 10.0).sum() >= MOST
    assert (turned < 90.0).sum() >= MOST
    strong, weak = (load([f"behaviour={b}"]) for b in ("baby_roll_over", "baby_weak"))
    assert strong.behaviour.stages == weak.behaviour.stages
    assert strong.controller.tasks["spin"] != weak.controller.tasks["spin"]


def test_poses_alone_leave_it_on_its_back():
    _, turned, _ = turns("behaviour=baby_roll_over", "controller.tasks.spin.stiffness.1=0")
    assert (np.abs(turned) < 60.0).sum() >= MOST


def test_the_baby_has_the_mass_and_shares_that_its_source_has():
    """Trunk 48 %, head 16 %, both legs 25 %, both arms 10 % of 9 kg, from MIMo's body masses."""
    mj = build(load(["behaviour=baby_roll_over"])).model.mj
    masses = {mj.body(i).name: float(mj.body_mass[i]) for i in range(mj.nbody)}
    source = {"pelvis": 1.1584, "waist": 1.3245, "chest": 2.7598, "head": 1.7874}
    limbs = {"upper_arm": 0.2684, "forearm": 0.2926, "thigh": 0.7998, "shin": 0.4501}
    whole = sum(source.values()) + 2 * (sum(limbs.values()) + 0.12647)
    for name, mass in {**source, **{f"{k}_l": v for k, v in limbs.items()}}.items():
        np.testing.assert_allclose(masses[name] / 9.0, mass / whole, atol=2e-4)
