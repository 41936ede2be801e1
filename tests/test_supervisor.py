"""Which contacts the controller may use: truth tables."""

import numpy as np
import pytest

from rotctl.control.supervisor import RULES, Evidence, Thresholds

LIMITS = Thresholds(force=20.0, torque=10.0, separation=0.3)
LOW, AT, HIGH = 0, 1, 2
FORCE, TORQUE, SPEED = (0.0, 20.0, 20.1), (0.0, 10.0, 10.1), (-0.5, 0.3, 0.4)


def kept(rule, force, torque, speed):
    evidence = Evidence(*(np.array([value]) for value in (force, torque, speed)))
    mask = RULES[rule](evidence, LIMITS)
    assert mask.dtype == bool
    return bool(mask[0])


@pytest.mark.parametrize("speed", [LOW, AT, HIGH])
@pytest.mark.parametrize("torque", [LOW, AT, HIGH])
@pytest.mark.parametrize("force", [LOW, AT, HIGH])
def test_truth_table(force, torque, speed):
    """Above a threshold, not at it; `modified` adds what does not separate fast."""
    found = FORCE[force], TORQUE[torque], SPEED[speed]
    pushes = force == HIGH or torque == HIGH
    assert kept("as_written", *found) is pushes
    assert kept("modified", *found) is (pushes or speed == LOW)


def test_each_contact_is_judged_by_itself():
    evidence = Evidence(
        force=np.array([30.0, 0.0, 0.0, 0.0]),
        torque=np.array([0.0, 30.0, 0.0, 0.0]),
        separation=np.array([1.0, 1.0, 0.0, 1.0]),
    )
    assert RULES["as_written"](evidence, LIMITS).tolist() == [True, True, False, False]
    assert RULES["modified"](evidence, LIMITS).tolist() == [True, True, True, False]


@pytest.mark.parametrize("rule", RULES)
def test_no_contacts(rule):
    nothing = np.empty(0)
    assert RULES[rule](Evidence(nothing, nothing, nothing), LIMITS).shape == (0,)


def test_zero_thresholds_keep_whatever_pushes():
    zero = Thresholds(force=0.0, torque=0.0, separation=0.0)
    evidence = Evidence(np.array([0.0, 1e-9]), np.zeros(2), np.ones(2))
    assert RULES["as_written"](evidence, zero).tolist() == [False, True]


def test_none_is_no_rule():
    assert "none" not in RULES
