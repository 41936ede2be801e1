"""The compiled control step: `native/step.c` on numpy's memory, through ctypes.

Serves the condensed form with boxqp, which is the default. Its programs are solved by an active
set of our own, to the same minimum: `native/active_set.c`.
"""

import ctypes

import mujoco
import numpy as np

from rotctl.control import handover
from rotctl.control.decision import Decision
from rotctl.control.kinds import KINDS
from rotctl.control.settings import ContactGains, ControllerSettings, PoseGains
from rotctl.control.supervisor import Thresholds
from rotctl.control.task import TASK, Command, Tasks
from rotctl.errors import RotctlError
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.native import functions, library
from rotctl.native.layout import constant, structure

SUPERVISORS = {
    "as_written": constant("AS_WRITTEN"),
    "modified": constant("MODIFIED"),
    "none": constant("NO_SUPERVISOR"),
}
FAILED, TASKS = constant("FAILED"), constant("TASKS")


_READ = ("trunk_axes", "position", "frame", "friction", "gap", "body", "row")


def serves(settings: ControllerSettings, model: Model) -> bool:
    """Whether these settings are ones that the compiled step knows."""
    return (
        settings.solver == "boxqp"
        and settings.supervisor in SUPERVISORS
        and settings.form == "condensed"
        and settings.tracking == "force"
        and model.mj.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        and len(model.trunk) <= constant("TRUNK")
    )


class CompiledStep:
    """Reads the state and decides torques.

    Attributes:
        lacks: kinds of task that have no function in C.
    """

    def __init__(self, model: Model, settings: ControllerSettings) -> None:
        """Hand the run's constants over; `library()` must be there."""
        found = library()
        if found is None:
            raise RotctlError("the compiled control step is not built")
        self._library = handover.prepared(found)
        self._scratch = mujoco.MjData(model.mj)
        self._kept = (model, model.torque_limit, model.armature, model.joint_range)
        self._reading, self._command, self._answer = (
            structure(name)() for name in ("Reading", "Command", "Answer")
        )
        nu, nv = model.mj.nu, model.mj.nv
        self._torque, self._bias = np.zeros(nu), np.zeros(nv)
        self._answer.torque = self._torque.ctypes.data
        self._reading.bias = self._bias.ctypes.data
        # Small arrays of a command are copied here: cheaper than asking for their addresses.
        self._poses, self._held_out = np.zeros((2, nu)), np.zeros(model.mj.nbody, dtype=bool)
        self._tasks: Tasks | None = None
        self._command.pose_a, self._command.pose_b = (p.ctypes.data for p in self._poses)
        self._command.held_out = self._held_out.ctypes.data
        # By their numbers: where C has the function of that name, and whether over qddot.
        addresses = [handover.address(found, f"rotctl_kind_{name}") for name in KINDS]
        self.lacks = [name for name, at in zip(KINDS, addresses, strict=True) if at is None]
        self._kinds = (handover.POINTER * len(KINDS))(*addresses)
        self._over_motion = (ctypes.c_ubyte * len(KINDS))(*(not k.momentum for k in KINDS.values()))
        constants = handover.constants(model, settings)
        self._self = found.rotctl_new(
            model.mj._address,
            self._scratch._address,
            ctypes.addressof(functions()),
            ctypes.addressof(constants),
            ctypes.addressof(self._kinds),
            ctypes.addressof(self._over_motion),
        )
        if not self._self:
            raise MemoryError("no memory for the compiled control step")
        self._pointers = [
            ctypes.addressof(part) for part in (self._reading, self._command, self._answer)
        ]
        self._momentum = handover.block(self._reading, "com", handover.MOMENTUM_SIZE)
        self._read = {name: handover.view(self._reading, name) for name in _READ}
        self._forward = handover.view(self._command, "forward")
        self._force = handover.view(self._answer, "force")
        self._used = handover.view(self._answer, "used").view(bool)
        self._rates = handover.block(self._answer, "rates_wanted", 2, 6)
        self._told = handover.block(self._answer, "error", 3, TASKS, 3)
        self._gains: tuple[PoseGains, ContactGains, Thresholds] | None = None
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
        read = self._read
        self._last = State(
            time=data.time,
            position=data.qpos.copy(),
            velocity=data.qvel.copy(),
            bias=self._bias.copy(),
            momentum=handover.momentum(self._momentum.copy()),
            contacts=Contacts(
                body=read["body"][:m].copy(),
                position=read["position"][:m].copy(),
                frame=read["frame"][:m].reshape(m, 3, 3).copy(),
                row=read["row"][:m].copy(),
                friction=read["friction"][:m].copy(),
                gap=read["gap"][:m].copy(),
            ),
            trunk_axes=read["trunk_axes"].reshape(3, 3).copy(),
            data=data,
        )
        return self._last

    def decide(self, state: State, command: Command, blend: float) -> Decision | None:
        """Torques; None where the reference has to take over.

        That is where a solve fails, for a kind of task or a supervisor that C has not, for more
        tasks than it has room for, and for any state but the one that `read` read last, as part
        of it is kept on the C side.
        """
        if state is not self._last or not self.ask(command, blend):
            return None
        answer, k = self._answer, len(command.tasks)
        m = self._library.rotctl_decide(self._self, state.data._address, *self._pointers)
        if m == FAILED:
            return None
        rates, told = self._rates.copy(), self._told[:, :k].copy()
        return Decision(
            torque=self._torque.copy(),
            blend=answer.blend,
            used=self._used[:m].copy(),
            force=self._force[:m].copy(),
            rates_wanted=rates[0],
            rates_predicted=rates[1],
            error=told[0],
            wanted=told[1],
            predicted=told[2],
            status=0,
            fallback=0,
            iterations=0,
            residual=answer.residual,
            reasons=(),
        )

    def ask(self, command: Command, blend: float) -> bool:
        """Hand over what is wanted; False where C has not the supervisor, or no room for it."""
        supervisor, k = SUPERVISORS.get(command.supervisor), len(command.tasks)
        if supervisor is None or k > TASKS:
            return False
        given = self._command
        gains = (command.pose, command.contact, command.thresholds)
        if gains is not self._gains and gains != self._gains:
            self._take(*gains)
            self._gains = gains
        self._forward[:] = command.forward
        given.blend = blend
        given.supervisor = supervisor
        if command.tasks is not self._tasks:  # a behaviour mostly fills the same ones again
            self._tasks = tasks = np.ascontiguousarray(command.tasks, TASK)
            given.task, given.tasks = tasks.ctypes.data, k
        self._poses[0], self._poses[1] = command.pose_a, command.pose_b
        self._held_out[:] = command.held_out
        given.behind = 0 if command.behind is None else command.behind.ctypes.data
        return True

    @property
    def blend(self) -> float:
        """Gamma of the step before, as C has it."""
        return float(self._command.blend)

    @property
    def addresses(self) -> dict[str, int]:
        """Of what C works on, by the names that `Run` in layout.h has for it."""
        reading, command, answer = self._pointers
        return {"self": self._self, "reading": reading, "command": command, "answer": answer}

    def _take(self, pose: PoseGains, contact: ContactGains, thresholds: Thresholds) -> None:
        given = self._command
        given.pose_stiffness, given.pose_damping = pose.stiffness, pose.damping
        given.pose_horizon = pose.horizon
        given.pose_explicit = pose.explicit
        given.pose_weight, given.blend_weight = pose.weight, pose.blend
        given.contact_damping, given.contact_weight = contact.damping, contact.weight
        given.contact_force = contact.force
        given.contact_centripetal = contact.centripetal
        given.threshold_force, given.threshold_torque = thresholds.force, thresholds.torque
        given.threshold_separation = thresholds.separation
