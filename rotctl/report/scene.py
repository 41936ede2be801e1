"""A character on its ground: qpos to pictures, and world points to pixels.

It is seen from the side of its way; who lies across it, as in a log roll, from ahead.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import radians, tan
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.report import character, gl, shapes
from rotctl.rotations import Array

Pixels = NDArray[np.uint8]

FIELD_OF_VIEW = radians(24.0)  # vertical; narrow, so that limbs keep their lengths
MARGIN = 1.25  # of the picture around the character
FALL = 5.0  # [m] of heights over the ground, at an adult's size: who jumps stays below
AROUND = 1.6  # half of a picture of a fall, as a multiple of half the body's height
LEAST_HALF_HEIGHT = 0.5  # [m] keeps a tucked adult from filling the picture
ADULT_WEIGHT = 686.7  # [N] of 70 kg, at which other sizes here are as written
GROUND_LINE = 0.9  # how far below the middle the ground is, in half heights
SKY_TOP = (0.655, 0.780, 0.900)
SKY_LOW = (0.945, 0.962, 0.975)
DISC = 0.17  # [m] radius of the disc that stands for a shadow, at the ground
DISC_GROWTH = 0.12  # [m] for each metre above
SUN = (0.25, 0.45, -1.0)  # direction of its light
_FAR = 60.0  # [m] where the ground has faded into the sky
_CHARACTER, _WORLD, _LOOSE = 0, 1, 2  # geom groups, all drawn


@dataclass(frozen=True)
class View:
    """A direction to look in.

    Attributes:
        azimuth: of the horizontal direction, from +x to the left [rad].
        elevation: above the horizon [rad].
    """

    azimuth: float
    elevation: float

    @property
    def axes(self) -> Array:
        """Rows are the picture's right, its up and forward into it (3, 3), world."""
        ca, sa = np.cos(self.azimuth), np.sin(self.azimuth)
        ce, se = np.cos(self.elevation), np.sin(self.elevation)
        return np.array([[sa, -ca, 0.0], [-ca * se, -sa * se, ce], [ca * ce, sa * ce, se]])


SIDE = View(radians(90.0), radians(-7.0))  # along +y, so that +x is to the right; a little down
AHEAD = View(radians(150.0), radians(-16.0))  # from ahead and above, so that a long body is seen
ABOVE = View(radians(150.0), radians(-32.0))  # so that it is seen which way a lying body faces
LONG = 1.5  # times as wide across the way as along it, and a body is seen from ahead
FLAT = 0.5  # times as high as long, and it lies


@dataclass(frozen=True)
class Camera:
    """A camera that follows the character.

    Attributes:
        view: the direction it looks in.
        target: (3,) the point in the middle of the picture [m].
        distance: from there [m].
        width, height: of the picture in pixels.
    """

    view: View
    target: Array
    distance: float
    width: int
    height: int

    def pixels(self, points: Array) -> Array:
        """Where world points (..., 3) are in the picture (..., 2): x to the right, y down."""
        right, up, forward = self.view.axes
        offset = points - self.target
        scale = 0.5 * self.height / tan(0.5 * FIELD_OF_VIEW) / (offset @ forward + self.distance)
        return np.stack(
            [
                0.5 * self.width + scale * (offset @ right),
                0.5 * self.height - scale * (offset @ up),
            ],
            axis=-1,
        )


class Scene:
    """Draws a model in given states; see `opened`."""

    def __init__(self, model: mujoco.MjModel, width: int, height: int, shadows: bool) -> None:
        self.model = model
        self.shadows = shadows
        self.width, self.height = width, height
        self._data = mujoco.MjData(model)
        self._limbs = character.is_limb(model)
        self._distance = 0.0
        self._falls = False
        self._centre = 0.0  # [m] height of the camera's target above the ground
        self._view_in = SIDE
        self.heading = 0.0  # of the way, from +x towards +y [rad]
        self.beside = 0.0  # [m] half the character's width across the way
        _light(model, width, height, shadows)
        _shade_left(model)
        model.geom_group[:] = np.where(self._limbs, _CHARACTER, _LOOSE)
        model.geom_group[model.geom_bodyid == 0] = _WORLD
        self._view = mujoco.MjvScene(model, maxgeom=model.ngeom + model.nbody + 16)
        self._view.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        self._view.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = shadows
        self._view.flags[mujoco.mjtRndFlag.mjRND_FOG] = True
        self._view.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False
        self._option = mujoco.MjvOption()
        self._option.sitegroup[:] = 0
        self._sky = _gradient(SIDE, width, height)
        self._drawing: Any = None

    def fit(self, states: Array, heading: float = 0.0) -> None:
        """Choose one view and distance with which the character fits in all states (n, nq).

        Args:
            heading: of the way, which goes to the right of the picture [rad].
        """
        halves, low, high = np.zeros((len(states), 3)), 0.0, 0.0
        for i, state in enumerate(states):
            self._pose(state)
            least, most = self._outline()
            y = float(character.centre_of_mass(self._data)[1])
            ground = self.ground(0.5 * (least[0] + most[0]), y)
            halves[i] = 0.5 * (most - least)
            low, high = min(low, least[2] - ground), max(high, most[2] - ground)
        self.heading = heading
        turn = np.abs([[np.cos(heading), np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        reach = halves[:, 2]
        height, halves = reach.mean(), halves[:, :2]
        along, across = turn @ halves.mean(axis=0)
        lies = height < FLAT * halves.max(axis=1).mean()
        chosen = ABOVE if lies else AHEAD if across > LONG * along else SIDE
        self._view_in = View(chosen.azimuth + heading, chosen.elevation)
        self._sky = _gradient(self._view_in, self.width, self.height)
        self.beside = float((halves @ turn[1]).max())
        right, up, into = np.abs(self._view_in.axes)
        wide = float((halves @ right[:2]).max())
        if lies:
            low -= float((halves @ into[:2]).max()) * into[2] / up[2]  # the near side
        least_half = LEAST_HALF_HEIGHT * self.size
        tall = high - low
        self._falls = tall > FALL * self.size
        if self._falls:  # the camera goes down with it, and sees little more than it
            tall = 2.0 * AROUND * float(reach.max())
        half = max(0.5 * tall, wide * self.height / self.width, least_half)
        self._distance = min(MARGIN * half / tan(0.5 * FIELD_OF_VIEW), 0.5 * _FAR)
        self._centre = low + GROUND_LINE * half

    def draw(self, state: Array) -> tuple[Pixels, Camera]:
        """A picture (height, width, 3) of the character in a state (nq,), and its camera."""
        self._pose(state)
        target = self._target()
        camera = mujoco.MjvCamera()
        camera.lookat, camera.distance = target, self._distance
        camera.azimuth = np.degrees(self._view_in.azimuth)
        camera.elevation = np.degrees(self._view_in.elevation)
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            self.model, self._data, self._option, None, camera, everything, self._view
        )
        self._add_sun(target)
        if not self.shadows:
            self._add_discs()
        frame = mujoco.MjrRect(0, 0, self.width, self.height)
        mujoco.mjr_render(frame, self._view, self._drawing)
        picture = np.empty((self.height, self.width, 3), dtype=np.uint8)
        depth = np.empty((self.height, self.width), dtype=np.float32)
        mujoco.mjr_readPixels(picture, depth, frame, self._drawing)
        empty = depth[::-1] >= 1.0
        return (
            np.where(empty[..., None], self._sky, picture[::-1]),
            Camera(self._view_in, target, self._distance, self.width, self.height),
        )

    @property
    def weight(self) -> float:
        """Of the character [N]."""
        return character.weight(self.model)

    @property
    def size(self) -> float:
        """Of the character, 1 for an adult's weight [-]: what is drawn beside it keeps pace."""
        return float(np.cbrt(self.weight / ADULT_WEIGHT)) or 1.0

    def ground(self, x: float, y: float) -> float:
        """Height of the ground at world (x, y) [m], in the state drawn last; 0 beside it."""
        world_only = np.array([0, 1, 0, 0, 0, 0], dtype=np.uint8)
        above = np.array([x, y, 1000.0])
        hit = np.zeros(1, dtype=np.int32)
        depth = mujoco.mj_ray(
            self.model, self._data, above, np.array([0.0, 0.0, -1.0]), world_only, 1, -1, hit
        )
        return float(above[2] - depth) if depth >= 0 else 0.0

    def _pose(self, state: Array) -> None:
        self._data.qpos[:] = state
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        mujoco.mj_camlight(self.model, self._data)

    def _outline(self) -> tuple[Array, Array]:
        """Least and greatest x, y and z of the character [m]."""
        size, axis = self.model.geom_size, self._data.geom_xmat[:, 2::3]
        capsule = self.model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE
        reach = np.where(
            capsule[:, None],
            size[:, :1] + size[:, 1:2] * np.abs(axis),
            self.model.geom_rbound[:, None],
        )[self._limbs]
        low = (self._data.geom_xpos[self._limbs] - reach).min(axis=0)
        high = (self._data.geom_xpos[self._limbs] + reach).max(axis=0)
        return np.asarray(low), np.asarray(high)

    def _target(self) -> Array:
        """Above the ground, in the middle of the character; its height follows a fall alone."""
        least, most = self._outline()
        if self._falls:
            return np.asarray(0.5 * (least + most))
        x, y = 0.5 * (least[0] + most[0]), float(character.centre_of_mass(self._data)[1])
        return np.array([x, y, self.ground(x, y) + self._centre])

    def _add_discs(self) -> None:
        """A dark disc on the ground under each body: a shadow that costs next to nothing."""
        for body in range(2, self.model.nbody):
            x, y, z = self._data.xipos[body]
            ground = self.ground(x, y)
            grown = DISC + DISC_GROWTH * max(0.0, z - ground)
            mujoco.mjv_initGeom(
                self._view.geoms[self._view.ngeom],
                mujoco.mjtGeom.mjGEOM_ELLIPSOID,
                np.array([grown, grown, 0.001]),
                np.array([x, y, ground + 0.002]),
                np.eye(3).flatten(),
                np.array([0.05, 0.08, 0.12, 0.1 * DISC / grown], dtype=np.float32),
            )
            self._view.ngeom += 1

    def _add_sun(self, target: Array) -> None:
        direction = np.array(SUN) / np.linalg.norm(SUN)
        self._view.nlight = 2  # the first is the headlight; the model's own are not for pictures
        sun = self._view.lights[1]
        sun.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
        sun.headlight, sun.castshadow, sun.texid = 0, 1, -1
        sun.pos, sun.dir = target - 5.0 * direction, direction
        sun.ambient, sun.diffuse, sun.specular = [0.0] * 3, [0.62, 0.60, 0.56], [0.12] * 3
        sun.attenuation = [1.0, 0.0, 0.0]


@contextmanager
def opened(
    model: mujoco.MjModel, backend: str, width: int, height: int, shadows: bool = True
) -> Iterator[Scene]:
    """A scene with an OpenGL context, for as long as it is open.

    Args:
        model: its visual settings are changed.
        backend: from `gl.backend`.
        width: of the pictures in pixels.
        height: of the pictures in pixels.
        shadows: real ones, which take most of the time in software; else dark discs.
    """
    scene = Scene(model, width, height, shadows)
    with gl.context(backend, width, height):
        drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        try:
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, drawing)
            scene._drawing = drawing
            yield scene
        finally:
            drawing.free()


def _light(model: mujoco.MjModel, width: int, height: int, fine: bool) -> None:
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
    visual.map.znear, visual.map.zfar = 0.5, 4 * _FAR
    visual.map.fogstart, visual.map.fogend = 5.0, 0.5 * _FAR
    visual.map.shadowclip, visual.map.shadowscale = 3.0, 0.8
    visual.rgba.fog = [*SKY_LOW, 1.0]
    visual.headlight.active = 1
    visual.headlight.ambient = [0.42, 0.43, 0.45]
    visual.headlight.diffuse = [0.22, 0.22, 0.22]
    visual.headlight.specular = [0.0, 0.0, 0.0]


def _shade_left(model: mujoco.MjModel) -> None:
    model.geom_rgba[shapes.left_geoms(model), :3] *= shapes.LEFT_SHADE


def _gradient(view: View, width: int, height: int) -> Pixels:
    """The sky: blue above, as pale at the horizon as the ground fades to."""
    horizon = max(0.5 - 0.5 * tan(-view.elevation) / tan(0.5 * FIELD_OF_VIEW), 1e-3)
    down = np.clip(np.linspace(0.0, 1.0 / horizon, height), 0.0, 1.0)[:, None, None]
    sky = (1.0 - down) * np.array(SKY_TOP) + down * np.array(SKY_LOW)
    return np.broadcast_to(np.uint8(np.round(255.0 * sky)), (height, width, 3))
