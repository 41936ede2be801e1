"""The light of pictures, and their sky."""

from math import tan

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.report.camera import FIELD_OF_VIEW, View

SKY_TOP = (0.655, 0.780, 0.900)
SKY_LOW = (0.945, 0.962, 0.975)
SUN = (0.25, 0.45, -1.0)  # direction of its light
FAR = 60.0  # [m] where the ground has faded into the sky


def set_up(model: mujoco.MjModel, width: int, height: int, fine: bool) -> None:
    """Set every visual option that matters here: a log's model has its own, or a stranger's."""
    visual = model.vis
    visual.global_.offwidth, visual.global_.offheight = width, height
    visual.global_.fovy = np.degrees(FIELD_OF_VIEW)
    visual.global_.orthographic = 0
    quality = visual.quality
    quality.offsamples = 0  # we draw larger and scale down: much faster in software
    quality.shadowsize = 2048
    quality.numslices, quality.numstacks = (32, 16) if fine else (20, 10)
    quality.numquads = 4
    model.stat.extent = 1.0  # the lengths below are in metres
    visual.map.znear, visual.map.zfar = 0.5, 4 * FAR
    visual.map.fogstart, visual.map.fogend = 5.0, 0.5 * FAR
    visual.map.shadowclip, visual.map.shadowscale = 3.0, 0.8
    visual.rgba.fog = [*SKY_LOW, 1.0]
    visual.headlight.active = 1
    visual.headlight.ambient = [0.42, 0.43, 0.45]
    visual.headlight.diffuse = [0.22, 0.22, 0.22]
    visual.headlight.specular = [0.0, 0.0, 0.0]


def add_sun(seen: mujoco.MjvScene, target: Array) -> None:
    """Shine on a point, with shadows."""
    direction = np.array(SUN) / np.linalg.norm(SUN)
    seen.nlight = 2  # the first is the headlight; the model's own are not for pictures
    sun = seen.lights[1]
    sun.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    sun.headlight, sun.castshadow, sun.texid = 0, 1, -1
    sun.pos, sun.dir = target - 5.0 * direction, direction
    sun.ambient, sun.diffuse, sun.specular = [0.0] * 3, [0.62, 0.60, 0.56], [0.12] * 3
    sun.attenuation = [1.0, 0.0, 0.0]


def sky(view: View, width: int, height: int) -> NDArray[np.uint8]:
    """The sky: blue above, as pale at the horizon as the ground fades to."""
    horizon = max(0.5 - 0.5 * tan(-view.elevation) / tan(0.5 * FIELD_OF_VIEW), 1e-3)
    down = np.clip(np.linspace(0.0, 1.0 / horizon, height), 0.0, 1.0)[:, None, None]
    sky = (1.0 - down) * np.array(SKY_TOP) + down * np.array(SKY_LOW)
    return np.broadcast_to(np.uint8(np.round(255.0 * sky)), (height, width, 3))


def clear(model: mujoco.MjModel) -> float:
    """What share of light goes through the clearest of the world, in at a face and out at another.

    0 where nothing is clear.
    """
    opaque = model.geom_rgba[model.geom_bodyid == 0, 3]
    return float(1.0 - opaque[opaque > 0.0].min(initial=1.0)) ** 2


def before_sky(
    picture: NDArray[np.uint8], far: NDArray[np.bool_], sky: NDArray[np.uint8], clear: float
) -> NDArray[np.uint8]:
    """A picture (height, width, 3) drawn on black, with the sky behind it.

    Water is drawn over what is behind it and has no depth of its own: where that is nothing, the
    sky shines through it.

    Args:
        far: (height, width) where nothing solid is.
        clear: share of the sky's light that what is not solid lets through; 0 if nothing is so.
    """
    seen = np.where(far[..., None], sky, picture)
    if clear:
        veiled = far & picture.any(axis=2)
        lit = np.round(picture[veiled] + clear * sky[veiled])
        seen[veiled] = np.minimum(lit, 255.0).astype(np.uint8)
    return seen
