#!/usr/bin/env bash
# gymnasium's NormalizeReward counts the penalty of a fall to the episode after it, and an episode that a time limit ends goes on in the next one.
#
# Expected: rewards are divided by the standard deviation of discounted returns. A return begins anew with each episode, whether a fall or the time limit ended the
#   last one, and its last reward, the penalty of the fall, is its own.
# Happens: the sum is set to 0 by the step that ends an episode and not after it: that step's reward is the first of the next episode's return. A penalty of -100 makes
#   the next four returns -89, -79, -70 and -62 in place of 1, 1.9, 2.7 and 3.4. After a time limit, or reset(), nothing is set to 0: a steady reward of 1 has no
#   more spread after the first seconds, and is multiplied by 0.20 after 20 thousand steps, by 0.29 after 40 thousand, and by more for ever, where episodes
#   of 100 steps would have 0.055. Episodes that end by a fall without a penalty have about the right factor.
# Seen with: gymnasium 1.4.0, gamma 0.99 and 0.9. Its issues 760 and 1507 tell of missing resets, both closed; the first was taken for intended.
# Means: as a controller gets better, and falls turn into time limits, its rewards grow by themselves, and step sizes and entropy that were tuned with them no longer
#   fit. How hard a fall is punished depends on the length of what comes after. Compare the returns of falling and of upright episodes in a log, or reset
#   discounted_reward oneself where an episode ends.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check gymnasium==1.4.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import gymnasium
import numpy as np
from gymnasium.wrappers import NormalizeReward, TimeLimit

NOTHING = np.zeros(1, dtype=np.float32)


class Roll(gymnasium.Env):
    """A reward of 1 a step; falls after so many, and gets another reward for it."""

    observation_space = action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,))

    def __init__(self, falls_after=None, reward_of_fall=1.0):
        self.falls_after, self.reward_of_fall = falls_after, reward_of_fall

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.steps = 0
        return NOTHING, {}

    def step(self, action):
        self.steps += 1
        falls = self.steps == self.falls_after
        return NOTHING, self.reward_of_fall if falls else 1.0, falls, False, {}


def run(env, steps):
    """The returns that the wrapper counts, and what it multiplies a reward by in the end."""
    env.reset()
    counted = []
    for _ in range(steps):
        _, _, fallen, over, _ = env.step(NOTHING)
        counted.append(float(env.discounted_reward[0]))
        if fallen or over:
            env.reset()
    return np.array(counted), float(1.0 / np.sqrt(env.return_rms.var + env.epsilon))


print("gymnasium", version("gymnasium"))
counted, _ = run(NormalizeReward(Roll(5, -100.0), gamma=0.9), 10)
print("returns of two episodes of five steps, the fifth a fall with -100:", counted.round(1))
if not np.allclose(counted, [1, 1.9, 2.71, 3.439, -100, -89, -79.1, -70.19, -62.171, -100]):
    raise SystemExit("CHANGED: the fall is charged to another episode")
right = 1.0 / np.std((1 - 0.99 ** np.arange(1, 101)) / 0.01)  # of returns that begin anew every 100 steps
factors = {}
for name, make in (("fall", lambda: Roll(100)), ("time limit", lambda: TimeLimit(Roll(), 100))):
    factors[name] = [run(NormalizeReward(make(), gamma=0.99), steps)[1] for steps in (10_000, 20_000, 40_000)]
    print(f"episodes of 100 steps, ended by a {name}: a reward of 1 is multiplied by {np.round(factors[name], 3)} after 10, 20 and 40 thousand steps; right: {right:.3f}")
if not np.allclose(factors["fall"], right, rtol=0.01):
    raise SystemExit("CHANGED: after falls the factor is another one")
if not (np.all(np.diff(factors["time limit"]) > 0.03) and factors["time limit"][-1] > 4 * right):
    raise SystemExit("CHANGED: a time limit ends returns, too")
PY
