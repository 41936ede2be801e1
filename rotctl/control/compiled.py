"""The compiled control step: `compiled.c` on numpy's memory, through ctypes.

Serves the condensed form with boxqp, which is the default. The library is built when rotctl
is installed, if there is a C compiler; it carries no Python of its own, and finds MuJoCo's
functions in the library that the mujoco package has loaded.
"""

import ctypes
from functools import lru_cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.control.condensed import LIMIT_SLACK
from rotctl.control.decision import Decision
from rotctl.control.settings import ControllerSettings
from rotctl.control.targets import Desired
from rotctl.errors import RotctlError
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import Momentum
from rotctl.mechanics.state import State
from rotctl.qp.scaling import DIAGONAL, TOLERANCE

LIBRARY = Path(__file__).with_name("_compiled.so")
CAPACITY = 64  # CONTACTS in compiled.c
LARGEST_TRUNK = 16
SUPERVISORS = {"as_written": 0, "modified": 1, "none": 2}
FAILED = -1
WEIGHTS = (
    "linear_momentum",
    "angular_momentum",
    "out_of_plane",
    "pose",
    "contact_velocity",
    "contact_force",
    "blend",
)
AXIS_GAINS = ("linear_stiffness", "linear_damping", "angular_stiffness", "angular_damping")

_double, _int, _pointer = ctypes.c_double, ctypes.c_int, ctypes.c_void_p


class _Functions(ctypes.Structure):
    _fields_ = [(name, _pointer) for name in ("mulM", "solveM", "factorM", "boxQP")]


class _Constants(ctypes.Structure):
    _fields_ = [
        *((name, _double) for name in ("period", "friction", "diagonal", "tolerance", "slack")),
        *((name, _double) for name in WEIGHTS),
        *((name, _double * 3) for name in AXIS_GAINS),
        ("pose_stiffness", _double),
        ("pose_damping", _double),
        ("threshold_force", _double),
        ("threshold_torque", _double),
        ("threshold_separation", _double),
        ("touch", _double),
        ("look_ahead", _double),
        ("mass", _double),
        ("gravity", _double * 3),
        ("supervisor", _int),
        ("trunk_count", _int),
        ("trunk", _int * LARGEST_TRUNK),
        ("trunk_weight", _double * LARGEST_TRUNK),
        ("torque_limit", _pointer),
        ("armature", _pointer),
        ("excluded", _pointer),
    ]


class _Reading(ctypes.Structure):
    _fields_ = [
        *((name, _double * 3) for name in ("com", "com_velocity", "linear", "angular")),
        ("inertia", _double * 9),
        ("angular_velocity", _double * 3),
        ("rotation", _double * 9),
        ("offset", _double * 3),
        ("trunk_axes", _double * 9),
        ("position", _double * (3 * CAPACITY)),
        ("frame", _double * (9 * CAPACITY)),
        ("friction", _double * (2 * CAPACITY)),
        ("gap", _double * CAPACITY),
        ("body", _int * CAPACITY),
        ("row", ctypes.c_longlong * CAPACITY),
        ("count", _int),
    ]


class _Wishes(ctypes.Structure):
    _fields_ = [
        *(
            (name, _double * 3)
            for name in ("com", "com_velocity", "excursion_error", "angular_velocity")
        ),
        ("blend", _double),
        ("pose_a", _pointer),
        ("pose_b", _pointer),
    ]


class _Answer(ctypes.Structure):
    _fields_ = [
        ("force", _double * (3 * CAPACITY)),
        ("rates_wanted", _double * 6),
        ("rates_predicted", _double * 6),
        ("blend", _double),
        ("residual", _double),
        ("torque", _pointer),
        ("used", ctypes.c_ubyte * CAPACITY),
    ]


@lru_cache(maxsize=1)
def library() -> ctypes.CDLL | None:
    """The built library; None where there is none, or it was built for other code or MuJoCo."""
    try:
        found = ctypes.CDLL(str(LIBRARY))
        layout = found.rotctl_layout()
    except (OSError, AttributeError):
        return None
    ours = (_Constants, 2), (_Reading, 7), (_Wishes, 49), (_Answer, 343)
    if layout != sum(factor * ctypes.sizeof(structure) for structure, factor in ours):
        return None
    found.rotctl_new.restype = _pointer
    found.rotctl_new.argtypes = [_pointer] * 4
    found.rotctl_free.argtypes = [_pointer]
    found.rotctl_free.restype = None
    found.rotctl_read.argtypes = [_pointer] * 3
    found.rotctl_decide.argtypes = [_pointer] * 5
    return found if found.rotctl_mujoco_version() == mujoco.mj_version() else None


def serves(settings: ControllerSettings, model: Model) -> bool:
    """Whether these settings are ones that the compiled step knows."""
    return (
        settings.solver == "boxqp"
        and settings.form == "condensed"
        and settings.weights.pose > 0
        and model.mj.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        and len(model.trunk) <= LARGEST_TRUNK
    )


class CompiledStep:
    """Reads the state and decides torques."""

    def __init__(self, model: Model, settings: ControllerSettings) -> None:
        """Hand the run's constants over; `library()` must be there."""
        found = library()
        if found is None:
            raise RotctlError("the compiled control step is not built")
        self._library = found
        self._scratch = mujoco.MjData(model.mj)
        self._kept = (model, model.torque_limit, model.armature, model.excluded)
        self._reading, self._wishes, self._answer = _Reading(), _Wishes(), _Answer()
        self._torque = np.zeros(model.mj.nu)
        self._answer.torque = self._torque.ctypes.data
        constants = _constants(model, settings)
        self._self = found.rotctl_new(
            model.mj._address,
            self._scratch._address,
            ctypes.addressof(_functions()),
            ctypes.addressof(constants),
        )
        if not self._self:
            raise MemoryError("no memory for the compiled control step")
        self._pointers = [
            ctypes.addressof(part) for part in (self._reading, self._wishes, self._answer)
        ]
        names = [field[0] for field in _Reading._fields_ if field[0] != "count"]
        self._read = {name: _view(self._reading, name) for name in names}
        wishes = ("com", "com_velocity", "excursion_error", "angular_velocity")
        self._wished = [(name, _view(self._wishes, name)) for name in wishes]
        self._force = _view(self._answer, "force").reshape(CAPACITY, 3)
        self._used = _view(self._answer, "used").view(bool)
        self._rates_wanted = _view(self._answer, "rates_wanted")
        self._rates_predicted = _view(self._answer, "rates_predicted")
        self._last: State | None = None

    def __del__(self) -> None:
        """Give the memory back."""
        if getattr(self, "_self", None):
            self._library.rotctl_free(self._self)

    def read(self, data: mujoco.MjData) -> State | None:
        """The state, as `rotctl.mechanics.state.read` reads it; None if there is no room."""
        self._last = None  # what C keeps is overwritten now, whatever comes of it
        m = self._library.rotctl_read(self._self, data._address, self._pointers[0])
        if m == FAILED:
            return None
        found = {name: view.copy() for name, view in self._read.items() if view.size <= 9}
        self._last = State(
            time=data.time,
            position=data.qpos.copy(),
            velocity=data.qvel.copy(),
            momentum=Momentum(
                com=found["com"],
                com_velocity=found["com_velocity"],
                linear=found["linear"],
                angular=found["angular"],
                inertia=found["inertia"].reshape(3, 3),
                angular_velocity=found["angular_velocity"],
                root_rotation=found["rotation"].reshape(3, 3),
                root_offset=found["offset"],
            ),
            contacts=Contacts(
                body=self._read["body"][:m].copy(),
                position=self._read["position"][: 3 * m].reshape(m, 3).copy(),
                frame=self._read["frame"][: 9 * m].reshape(m, 3, 3).copy(),
                row=self._read["row"][:m].copy(),
                friction=self._read["friction"][: 2 * m].reshape(m, 2).copy(),
                gap=self._read["gap"][:m].copy(),
            ),
            trunk_axes=found["trunk_axes"].reshape(3, 3),
            data=data,
        )
        return self._last

    def decide(self, state: State, desired: Desired, blend: float) -> Decision | None:
        """Torques; None where the reference has to take over.

        That is where a solve fails, and for any state but the one that `read` read last,
        as part of it is kept on the C side.
        """
        if state is not self._last:
            return None
        for name, view in self._wished:
            view[:] = getattr(desired, name)
        wishes, answer = self._wishes, self._answer
        wishes.blend = blend
        wishes.pose_a = desired.pose_a.ctypes.data
        wishes.pose_b = desired.pose_b.ctypes.data
        m = self._library.rotctl_decide(self._self, state.data._address, *self._pointers)
        if m == FAILED:
            return None
        return Decision(
            torque=self._torque.copy(),
            blend=answer.blend,
            used=self._used[:m].copy(),
            force=self._force[:m].copy(),
            rates_wanted=self._rates_wanted.copy(),
            rates_predicted=self._rates_predicted.copy(),
            status=0,
            fallback=0,
            iterations=0,
            residual=answer.residual,
            reasons=(),
        )


def _view(structure: ctypes.Structure, name: str) -> NDArray[Any]:
    return np.ctypeslib.as_array(getattr(structure, name))


@lru_cache(maxsize=1)
def _functions() -> _Functions:
    """Addresses of MuJoCo's functions, in the library its Python package has loaded."""
    folder = Path(mujoco.__file__).parent
    loaded = ctypes.CDLL(str(next(folder.glob("libmujoco.*"))))
    names = ("mj_mulM", "mj_solveM", "mj_factorM", "mju_boxQP")
    return _Functions(*(ctypes.cast(getattr(loaded, name), _pointer) for name in names))


def _constants(model: Model, settings: ControllerSettings) -> _Constants:
    constants = _Constants(
        period=1.0 / settings.rate,
        friction=settings.friction,
        diagonal=DIAGONAL,
        tolerance=TOLERANCE,
        slack=LIMIT_SLACK,
        pose_stiffness=settings.gains.pose_stiffness,
        pose_damping=settings.gains.pose_damping,
        threshold_force=settings.thresholds.force,
        threshold_torque=settings.thresholds.torque,
        threshold_separation=settings.thresholds.separation,
        touch=model.touch,
        look_ahead=model.look_ahead,
        mass=model.mass,
        supervisor=SUPERVISORS[settings.supervisor],
        trunk_count=len(model.trunk),
        torque_limit=model.torque_limit.ctypes.data,
        armature=model.armature.ctypes.data,
        excluded=model.excluded.ctypes.data,
    )
    for name in WEIGHTS:
        setattr(constants, name, getattr(settings.weights, name))
    for name in AXIS_GAINS:
        getattr(constants, name)[:] = getattr(settings.gains, name)
    constants.gravity[:] = model.gravity
    for i, (body, weight) in enumerate(zip(model.trunk, model.trunk_weights[:, 0], strict=True)):
        constants.trunk[i], constants.trunk_weight[i] = int(body), float(weight)
    return constants
