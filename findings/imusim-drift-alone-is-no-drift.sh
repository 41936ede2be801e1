#!/usr/bin/env bash
# Ask imusim for a gyroscope that drifts and has no other fault: it has none at all. Ask for one fault after another and each sensor has those of all before.
#
# Expected: set_gyroscope makes a model of a sensor out of the ideal one; each keyword is a fault of its own, zero unless given. random_walk alone gives a drift that grows with
#   the square root of time, and a second call, with other faults or none, starts from the ideal sensor again.
# Happens: whether there is a random walk depends on bias_instability: without one, random_walk does nothing. With a bias instability of 1e-9 it does what was asked. Offset, noise and
#   drift are added to the ideal sensor itself, so that an offset of 1 deg/s, asked for three times, is 3, and set_gyroscope() without a fault afterwards leaves 3. After four
#   calls with one and the same noise there is twice as much. Nothing is said. set_accelerometer goes by the same code.
# Seen with: imusim 1.1.2 (imusim.py, the model of a sensor), numpy 2.4.6, scipy 1.17.1. Its README tells nothing of the keywords.
# Means: the first costs whoever tests an estimator of attitude its slow drift, and with it all reason to estimate a bias; the second makes a sweep over qualities of sensors
#   worse from run to run, in the order in which they are tried. Give a tiny bias_instability with random_walk, and make a new Simulator for each model.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check imusim==1.1.2 matplotlib==3.11.2 numpy==2.4.6 scipy==1.17.1
cd "$work"
MPLBACKEND=Agg "$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import imusim
import numpy as np

RATE, WALK, NOISE = 100, 0.5, 0.1  # Hz, deg/s per root of s, deg/s per root of Hz
time = np.arange(0, 20, 1 / RATE)
motion = np.column_stack([time, np.zeros((len(time), 5)), 20 * np.sin(time)])  # turns about the vertical axis [deg]
np.savetxt("motion.csv", motion, delimiter=",", header="time,x,y,z,roll,pitch,yaw", comments="")
np.random.seed(0)


def every(number):
    return np.full(3, float(number))


def sensor():
    """A new simulator and its ideal gyroscope or accelerometer."""
    simulator = imusim.Simulator("motion.csv")
    return simulator, simulator.gyroscope.copy(), simulator.accelerometer.copy()


print("imusim", version("imusim"))
simulator, gyroscope, accelerometer = sensor()
simulator.set_gyroscope(random_walk=every(WALK))
simulator.set_accelerometer(random_walk=every(WALK))
alone = max(np.abs(simulator.gyroscope - gyroscope).max(), np.abs(simulator.accelerometer - accelerometer).max())
simulator, gyroscope, _ = sensor()
simulator.set_gyroscope(random_walk=every(WALK), bias_instability=every(1e-9))
steps = np.diff(simulator.gyroscope - gyroscope, axis=0).std() * np.sqrt(RATE)
print(f"random walk of {WALK}: alone the greatest fault is {alone}, beside a bias instability of 1e-9 its steps are those of {steps:.3f}")
if alone > 0:
    raise SystemExit("CHANGED: a random walk alone does something")
if abs(steps - WALK) > 0.03:
    raise SystemExit("CHANGED: beside a bias instability there is another random walk")

simulator, gyroscope, accelerometer = sensor()
offsets = []
for offset in (1, 1, 1, 0):
    simulator.set_gyroscope(offset=every(offset))
    simulator.set_accelerometer(offset=every(offset))
    offsets.append([(simulator.gyroscope - gyroscope).mean(), (simulator.accelerometer - accelerometer).mean()])
print("offsets of 1, 1, 1 and 0 are, for gyroscope and accelerometer:", np.round(offsets, 6).tolist())
if np.abs(np.array(offsets) - np.array([1, 2, 3, 3])[:, None]).max() > 1e-6:
    raise SystemExit("CHANGED: offsets add up in another way, or not")

simulator, gyroscope, _ = sensor()
noises = []
for _ in range(4):
    simulator.set_gyroscope(noise_density=every(NOISE))
    noises.append(float((simulator.gyroscope - gyroscope).std()))
print("standard deviations with one and the same noise, four times:", np.round(noises, 3).tolist(), "deg/s")
if np.abs(np.array(noises) / noises[0] - np.sqrt([1, 2, 3, 4])).max() > 0.1:
    raise SystemExit("CHANGED: noise adds up in another way, or not")
PY
