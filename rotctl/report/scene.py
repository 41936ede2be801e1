"""A character on its ground: qpos to pictures, and world points to pixels.

It is seen from the side of its way; who lies across it, as in a log roll, from ahead.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from math import tan
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.report import character, gl, light, shapes
from rotctl.report.camera import ABOVE, AHEAD, FIELD_OF_VIEW, FLAT, LONG, SIDE, Camera, View

Pixels = NDArray[np.uint8]

MARGIN = 1.25  # of the picture around the character
FALL = 5.0  # [m] of heights over the ground, at an adult's size: who jumps stays below
AROUND = 1.6  # half of a picture of a fall, as a multiple of half the body's height
LEAST_HALF_HEIGHT = 0.5  # [m] keeps a tucked adult from filling the picture
GROUND_LINE = 0.9  # how far below the middle the ground is, in half heights
DISC = 0.17  # [m] radius of the disc that stands for a shadow, at the ground
DISC_GROWTH = 0.12  # [m] for each metre above
_CHARACTER, _WORLD, _LOOSE = 0, 1, 2  # geom groups, all drawn


class Scene:
    """Draws a model in given states; see `opened`."""

    def __init__(self, model: mujoco.MjModel, width: int, height: int, shadows: bool) -> None:
        self.model = model
        self.shadows = shadows
        self.width, self.height = width, height
        self._data = mujoco.MjData(model)
        self._limbs = character.is_limb(model)
        self._clear = light.clear(model)
        self._distance = 0.0
        self._falls = False
        self._centre = 0.0  # [m] height of the camera's target above the ground
        self._view_in = SIDE
        self.heading = 0.0  # of the way, from +x towards +y [rad]
        self.beside = 0.0  # [m] half the character's width across the way
        light.set_up(model, width, height, shadows)
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
        self._sky = light.sky(SIDE, width, height)
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
        self._sky = light.sky(self._view_in, self.width, self.height)
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
        self._distance = min(MARGIN * half / tan(0.5 * FIELD_OF_VIEW), 0.5 * light.FAR)
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
        light.add_sun(self._view, target)
        if not self.shadows:
            self._add_discs()
        frame = mujoco.MjrRect(0, 0, self.width, self.height)
        mujoco.mjr_render(frame, self._view, self._drawing)
        picture = np.empty((self.height, self.width, 3), dtype=np.uint8)
        depth = np.empty((self.height, self.width), dtype=np.float32)
        mujoco.mjr_readPixels(picture, depth, frame, self._drawing)
        far = depth[::-1] >= 1.0
        return (
            light.before_sky(picture[::-1], far, self._sky, self._clear),
            Camera(self._view_in, target, self._distance, self.width, self.height),
        )

    @property
    def weight(self) -> float:
        """Of the character [N]."""
        return character.weight(self.model)

    @property
    def size(self) -> float:
        """Of the character [-]."""
        return character.size(self.model)

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


def _shade_left(model: mujoco.MjModel) -> None:
    model.geom_rgba[shapes.left_geoms(model), :3] *= shapes.LEFT_SHADE
