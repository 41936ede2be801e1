#!/usr/bin/env bash
# A cylinder of trimesh that weighs 3.1 kg resists turning as if it weighed 3 grams.
#
# Expected: density scales mass and moment of inertia alike; so it does for a box, a capsule and any mesh.
# Happens: the primitives Cylinder and Sphere have a formula of their own for moment_inertia, with their volume where the mass
#   belongs. At 1000 kg/m3 it is a thousandth of the right value; mass, and the inertia in mass_properties, are right.
# Seen with: trimesh 5.2.0, trimesh.primitives. At the density of 1 that a new mesh has, nothing shows.
# Means: a character built from primitives has limbs of the right weight that spin like paper; feedback that is steady on it is
#   not on the real body. mass_properties["inertia"] instead, or a mesh of the primitive (to_mesh). Watch for densities
#   that are lost, too: convex_hull and subdivide() give meshes of density 1 again.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
import numpy as np
import trimesh
from trimesh import primitives

DENSITY, RADIUS, LENGTH = 1000.0, 0.05, 0.4
SHAPES = {
    "cylinder": primitives.Cylinder(radius=RADIUS, height=LENGTH),
    "sphere": primitives.Sphere(radius=0.1),
    "capsule": primitives.Capsule(radius=RADIUS, height=LENGTH),
    "box": primitives.Box(extents=(0.1, 0.1, LENGTH)),
}

print("trimesh", trimesh.__version__, f"- density {DENSITY:.0f} kg/m3, inertia about x in kg m2")
factor = {}
for name, shape in SHAPES.items():
    shape.density = DENSITY
    mesh = shape.to_mesh()
    mesh.density = DENSITY
    own, listed, meshed = (float(inertia[0, 0]) for inertia in (shape.moment_inertia, shape.mass_properties["inertia"], mesh.moment_inertia))
    factor[name] = meshed / own
    print(f"{name:8s} {shape.mass:5.2f} kg: moment_inertia {own:.2e}, in mass_properties {listed:.2e}, of its mesh {meshed:.2e}")
    if abs(listed / meshed - 1) > 0.01:
        raise SystemExit("CHANGED: mass_properties has not the inertia of the mesh")
mesh.density = DENSITY
lost = mesh.convex_hull.density, mesh.subdivide().density, mesh.copy().density
print("density of the hull, after subdivide(), of a copy:", *lost)
if not np.allclose([factor["cylinder"], factor["sphere"]], DENSITY, rtol=0.05):
    raise SystemExit("CHANGED: the inertia of cylinder and sphere goes with their density")
if not np.allclose([factor["capsule"], factor["box"]], 1, rtol=0.01) or lost != (1.0, 1.0, DENSITY):
    raise SystemExit("CHANGED: capsule and box are wrong as well, or densities are kept")
PY
