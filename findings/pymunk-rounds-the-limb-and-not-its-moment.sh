#!/usr/bin/env bash
# One round limb, made in Pymunk's two ways: as a segment it is a fifth too hard to turn, as a polygon with rounded edges four times too easy.
#
# Expected: a segment with a radius and a thin polygon with the same radius are the same shape, a bar with half-discs at its ends. Their areas agree, so with
#   one mass their moments agree as well, with each other and with the integral of r^2 over that shape.
# Happens: areas are right. The moment of a segment is that of a box over its whole length, corners included; the moment of a polygon is that of its
#   core, as if it had no radius. A trunk 0.6 m long and 0.3 m wide, 40 kg, has 1.50 kg m2 as a segment and 0.30 as a polygon, where it is 1.27. A forearm 0.3 m
#   long and 0.08 m wide is off by 11 % and by 44 %. moment_for_segment and moment_for_poly, which takes a radius and leaves it, say so, and so do
#   bodies whose moment is summed up from the masses of their shapes.
# Seen with: pymunk 7.3.1; the truth by sums over a fine grid. Chipmunk, which it goes back to, was asked in issue 164 what the unused radius is for; closed.
# Means: polygons get a radius to roll smoothly over edges, and lose three quarters of what resists turning: a somersault comes from a fraction of the push, at the same
#   mass and with the same picture. Set body.moment oneself, of the true shape.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pymunk==7.3.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from math import hypot, isclose, pi

import pymunk

FINE = 400  # cells over the half length
CORE = 1e-4  # m, half the width of a polygon's core


def truth(mass, half, radius):
    """Area and moment of a bar with half-discs, by the cells of one quarter whose middle lies in it."""
    cell = (half + radius) / FINE
    inside = []
    for i in range(FINE):
        for j in range(int(radius / cell) + 1):
            x, y = (i + 0.5) * cell, (j + 0.5) * cell
            if hypot(max(x - half, 0.0), y) < radius:
                inside.append(x * x + y * y)
    return 4 * len(inside) * cell**2, mass * sum(inside) / len(inside)


def summed(shape_of, mass):
    """Moment that a body has by the mass of its one shape."""
    space, body = pymunk.Space(), pymunk.Body()
    shape = shape_of(body)
    shape.mass = mass
    space.add(body, shape)
    return body.moment


print("pymunk", pymunk.version)
for name, mass, length, width, seen in (("trunk", 40.0, 0.6, 0.3, (1.18, 0.24)), ("forearm", 1.2, 0.3, 0.08, (1.11, 0.56))):
    radius = width / 2
    half = length / 2 - radius
    ends = (-half, 0.0), (half, 0.0)
    corners = [(-half, -CORE), (half, -CORE), (half, CORE), (-half, CORE)]
    area, moment = truth(mass, half, radius)
    areas = pymunk.area_for_segment(*ends, radius), pymunk.area_for_poly(corners, radius)
    moments = pymunk.moment_for_segment(mass, *ends, radius), pymunk.moment_for_poly(mass, corners, (0, 0), radius)
    bodies = summed(lambda body: pymunk.Segment(body, *ends, radius), mass), summed(lambda body: pymunk.Poly(body, corners, radius=radius), mass)
    print(f"{name}: area {area:.4f} m2, {areas[0]:.4f} as a segment, {areas[1]:.4f} as a polygon; "
          f"moment {moment:.4f} kg m2, {moments[0]:.4f} as a segment, {moments[1]:.4f} as a polygon, {bodies[0]:.4f} and {bodies[1]:.4f} by masses")
    right = 2 * half * width + pi * radius**2
    if not all(isclose(told, right, rel_tol=5e-3) for told in (area, *areas)):
        raise SystemExit("CHANGED: areas are others")
    by_masses = all(isclose(told, summed_up, rel_tol=1e-6) for told, summed_up in zip(moments, bodies))
    if not by_masses or not all(isclose(told / moment, ratio, abs_tol=0.01) for told, ratio in zip(moments, seen)):
        raise SystemExit("CHANGED: moments are others")
PY
