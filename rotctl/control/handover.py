"""What Python and C hand each other in a control step: signatures, constants, views of memory."""

import ctypes
from itertools import accumulate
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.control.condensed import LIMIT_SLACK
from rotctl.control.settings import ControllerSettings
from rotctl.control.task import TASK
from rotctl.errors import RotctlError
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import Momentum
from rotctl.native.layout import structure
from rotctl.qp.scaling import DIAGONAL, TOLERANCE

POINTER = ctypes.c_void_p
# Names and shapes of what a reading begins with.
_MOMENTUM = {
    **dict.fromkeys(("com", "com_velocity", "linear", "angular"), (3,)),
    "inertia": (3, 3),
    "angular_velocity": (3,),
    "root_rotation": (3, 3),
    "root_offset": (3,),
}
MOMENTUM_SIZE = sum(map(prod, _MOMENTUM.values()))
_ENDS = list(accumulate(map(prod, _MOMENTUM.values())))
_CUTS = [
    (slice(begin, end), shape if len(shape) > 1 else None)
    for begin, end, shape in zip([0, *_ENDS], _ENDS, _MOMENTUM.values(), strict=False)
]


def prepared(found: ctypes.CDLL) -> ctypes.CDLL:
    """The library with its signatures, if Python and C agree on what they hand each other."""
    theirs, ours = structure("Task"), dict(TASK.fields or {})
    places = [(name, getattr(theirs, name).offset) for name, *_ in theirs._fields_]
    if places != [(name, field[1]) for name, field in ours.items()]:
        raise RotctlError("native/layout.h and rotctl.control.task differ in what a task is")
    found.rotctl_new.restype = POINTER
    found.rotctl_new.argtypes = [POINTER] * 6
    found.rotctl_free.argtypes = [POINTER]
    found.rotctl_free.restype = None
    found.rotctl_read.argtypes = [POINTER] * 3
    found.rotctl_decide.argtypes = [POINTER] * 5
    return found


def address(found: ctypes.CDLL, name: str) -> int | None:
    """Where a function is; None where the library has none of that name."""
    try:
        return ctypes.cast(getattr(found, name), POINTER).value
    except AttributeError:
        return None


def view(shared: ctypes.Structure, name: str) -> NDArray[Any]:
    """A member as an array on the same memory."""
    return np.ctypeslib.as_array(getattr(shared, name))


def block(shared: ctypes.Structure, first: str, *shape: int) -> NDArray[np.float64]:
    """Several members in one array from the `first` on: one copy is cheaper than one of each."""
    start = getattr(type(shared), first).offset
    found = np.frombuffer(shared, float, prod(shape), start)  # type: ignore[call-overload]
    return np.asarray(found).reshape(shape)


def momentum(whole: NDArray[np.float64]) -> Momentum:
    """Cut from one block, which is cheaper than a copy each."""
    return Momentum(*[whole[cut].reshape(shape) if shape else whole[cut] for cut, shape in _CUTS])


def constants(model: Model, settings: ControllerSettings) -> ctypes.Structure:
    """The run's, which C copies; its arrays stay where they are."""
    made = structure("Constants")(
        period=1.0 / settings.rate,
        friction=settings.friction,
        diagonal=DIAGONAL,
        tolerance=TOLERANCE,
        slack=LIMIT_SLACK,
        touch=model.touch,
        look_ahead=model.look_ahead,
        merge_distance=settings.merging.distance,
        merge_parallel=settings.merging.parallel,
        mass=model.mass,
        sees_disturbance=settings.sees_disturbance,
        trunk_count=len(model.trunk),
        torque_limit=model.torque_limit.ctypes.data,
        armature=model.armature.ctypes.data,
        joint_range=model.joint_range.ctypes.data,
    )
    made.gravity[:] = model.gravity
    for i, (body, weight) in enumerate(zip(model.trunk, model.trunk_weights[:, 0], strict=True)):
        made.trunk[i], made.trunk_weight[i] = int(body), float(weight)
    return made
