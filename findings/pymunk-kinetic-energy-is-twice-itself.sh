#!/usr/bin/env bash
# A gymnast who drops by 5 m in Pymunk has twice the kinetic energy that the height gives, and so has one who only turns.
#
# Expected: kinetic_energy of a body is m v^2 / 2 + I w^2 / 2, so that what a fall gains is what it loses in m g h, and what a torque times its angle puts in is there.
# Happens: the half is missing: it is m v^2 + I w^2. A body of 60 kg has 5887 J after a drop by 5 m without air, where m g h is 2943 J; a moment of 12 kg m2 at 6 rad/s
#   has 432 J for 216. Velocities, heights and angles are right, and so is what impulses do. The documentation has no formula, only the name.
# Seen with: pymunk 7.3.1 (its Munk2D 2.0.1, which goes back to Chipmunk). Ratios of two such energies are right, which hides it.
# Means: it is at hand for planar models of somersaults and swings on a bar. Potential plus kinetic energy of a fall that loses nothing grows, which one
#   blames on the integrator; work of a motor by the change of this energy is twice what it did, and a cost of transport as well. Halve it, or
#   compute it of mass, velocity, moment and angular_velocity.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pymunk==7.3.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from math import isclose

import pymunk

MASS, MOMENT, GRAVITY, STEP = 60.0, 12.0, 9.81, 1e-4  # kg, kg m2, m/s2, s


def world(gravity=0.0):
    space, body = pymunk.Space(), pymunk.Body(MASS, MOMENT)
    space.gravity = (0.0, -gravity)
    space.add(body)
    return space, body


def by_hand(body):
    return body.mass * body.velocity.length**2 / 2.0 + body.moment * body.angular_velocity**2 / 2.0


print("pymunk", pymunk.version)
space, falls = world(GRAVITY)
while falls.position.y > -5.0:
    space.step(STEP)
from_height = -MASS * GRAVITY * falls.position.y
print(f"fallen by {-falls.position.y:.2f} m: {from_height:.0f} J by height, {by_hand(falls):.0f} J by velocity, kinetic_energy {falls.kinetic_energy:.0f} J")

space, turns = world()
work = 0.0
while turns.angular_velocity < 6.0:
    turns.torque = 30.0  # N m, taken back by each step
    before = turns.angle
    space.step(STEP)
    work += 30.0 * (turns.angle - before)
print(f"turned up to {turns.angular_velocity:.2f} rad/s: {work:.0f} J of work, {by_hand(turns):.0f} J by angular velocity, kinetic_energy {turns.kinetic_energy:.0f} J")
if not isclose(from_height, by_hand(falls), rel_tol=1e-3) or not isclose(work, by_hand(turns), rel_tol=1e-3):
    raise SystemExit("CHANGED: bodies move otherwise")
for body in (falls, turns):
    if not isclose(body.kinetic_energy, 2.0 * by_hand(body), rel_tol=1e-9):
        raise SystemExit("CHANGED: the kinetic energy has its half")
PY
