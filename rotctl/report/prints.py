"""Where the ground bore a body: prints on it as it stands, seen from behind.

What the ground bore is drawn where it is on the body, in the colour of the phase of the roll: a
shoulder roll is a line from one hand over the shoulder and across the back to the other hip.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.skeleton import ROUND
from rotctl.report import axes as draw
from rotctl.report import stored_model
from rotctl.report.plot import heading, write
from rotctl.report.shapes import triangles

if TYPE_CHECKING:
    import mujoco

SIZE = (5.2, 7.2)  # [inch]
AWAY = 0.35  # [rad] the arms hang off the sides, so that they cover nothing
LEAST = 0.02  # [body weights] less is no print
AREA = 60.0  # [points2] of a print of a body weight
ROUNDED = 17  # corners of the half circle at the end of a limb


def prints(log: RunLog, out: Path, start: float | None = None, end: float | None = None) -> None:
    """Plot where the ground bore a body; see `rotctl.report.plot.plot`."""
    write(log, out, SIZE, _draw, start, end)


def borne(
    log: RunLog, mj: "mujoco.MjModel", rows: slice
) -> tuple[NDArray[np.int64], Array, Array, Array]:
    """Body (k,), place on it (k, 3) [m], force (k,) [body weights] and row (k,) of all prints."""
    import mujoco

    data, weight = mujoco.MjData(mj), float(mj.body_subtreemass[1] * np.abs(mj.opt.gravity).max())
    body = np.asarray(log["contacts/body"])[rows]
    load = np.sqrt((np.asarray(log["contacts/force_realised"], dtype=float)[rows] ** 2).sum(axis=2))
    load /= weight or 1.0
    at, slots = np.nonzero((body > 0) & (body < mj.nbody) & (load > LEAST))
    states = np.asarray(log["trajectory/qpos"], dtype=float)[rows]  # each read once: it unpacks all
    places = np.asarray(log["contacts/position"], dtype=float)[rows]
    found = np.zeros((len(at), 3))
    for row in np.unique(at).tolist():
        data.qpos[:] = states[row]
        mujoco.mj_kinematics(mj, data)
        for k in np.flatnonzero(at == row).tolist():
            which = body[row, slots[k]]
            off = places[row, slots[k]] - data.xpos[which]
            found[k] = (data.xmat[which].reshape(3, 3) * off[:, None]).sum(axis=0)
    return body[at, slots].astype(np.int64), found, load[at, slots], at.astype(float)


def _draw(figure: Any, log: RunLog, rows: slice) -> None:
    import mujoco

    heading(figure, log, SIZE[1])
    axes = figure.add_subplot(
        figure.add_gridspec(1, 1, left=0.1, right=0.87, top=0.87, bottom=0.09)[0]
    )
    mj = stored_model.load(log)
    stands = mujoco.MjData(mj)
    stands.qpos[:] = mj.qpos0
    for side in ("_l", "_r"):
        joint = mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_JOINT, "shoulder_x" + side)
        if joint >= 0:
            stands.qpos[mj.jnt_qposadr[joint]] = AWAY
    mujoco.mj_kinematics(mj, stands)
    for outline in outlines(mj, stands):
        axes.fill(*outline.T, color="#dfe4e9", lw=0.5, ec=draw.LIGHT)
    body, place, load, row = borne(log, mj, rows)
    turned = stands.xmat[body].reshape(-1, 3, 3)
    there = stands.xpos[body] + (turned * place[:, None, :]).sum(axis=2)
    phase = np.asarray(log["trajectory/phase"])[rows][row.astype(int)] / (2.0 * np.pi) % 1.0
    dots = axes.scatter(
        -there[:, 1],
        there[:, 2],
        s=AREA * load,
        c=phase,
        cmap="turbo",
        vmin=0,
        vmax=1,
        alpha=0.6,
        lw=0,
    )
    axes.set_aspect("equal")
    axes.set_xlabel("left and right, from behind [m]")
    axes.set_ylabel("height [m]")
    bar = figure.colorbar(dots, ax=axes, fraction=0.04, pad=0.03)
    bar.solids.set_alpha(1.0)
    bar.set_label("phase of the roll [rev]")


def outlines(mj: "mujoco.MjModel", data: "mujoco.MjData") -> list[Array]:
    """Outlines (n, 2) of a character's capsules, spheres and hulls, seen from behind [m]."""
    import mujoco

    angles = np.linspace(0.0, np.pi, ROUNDED)
    found = []
    for geom in range(mj.ngeom):
        kind, body = int(mj.geom_type[geom]), mj.geom_bodyid[geom]
        if mj.body_rootid[body] != 1 or not mj.geom_contype[geom]:
            continue
        if kind == mujoco.mjtGeom.mjGEOM_MESH:
            found.append(_around(mj, data, geom))
        if kind not in ROUND:
            continue
        radius = float(mj.geom_size[geom, 0])
        half = float(mj.geom_size[geom, 1]) if kind == ROUND[0] else 0.0
        x, y = float(-data.geom_xmat[geom, 5]), float(data.geom_xmat[geom, 8])
        middle = np.array([-data.geom_xpos[geom, 1], data.geom_xpos[geom, 2]])
        along = np.arctan2(y, x)
        ends = []
        for sign, first in ((1.0, along - np.pi / 2), (-1.0, along + np.pi / 2)):
            arc = np.stack((np.cos(first + angles), np.sin(first + angles)), axis=1)
            ends.append(middle + sign * half * np.array([x, y]) + radius * arc)
        found.append(np.concatenate(ends))
    return found


def _around(mj: "mujoco.MjModel", data: "mujoco.MjData", geom: int) -> Array:
    """Outline (n, 2) of a hull, seen from behind [m]."""
    from scipy.spatial import ConvexHull

    corners = np.unique(triangles(mj, geom).reshape(-1, 3), axis=0)
    turned = (data.geom_xmat[geom].reshape(3, 3) * corners[:, None, :]).sum(axis=2)
    seen = (data.geom_xpos[geom] + turned)[:, 1:] * (-1.0, 1.0)
    return np.asarray(seen[ConvexHull(seen, qhull_options="QJ").vertices])  # QJ: may be thin
