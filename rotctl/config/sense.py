"""Whether a run that is newly asked for comes to what it is told."""

from rotctl.behaviours import BehaviourSettings
from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.choices.brought import brought
from rotctl.config.diving import require_dive
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.mechanics.changes import Slip
from rotctl.mechanics.character import Character
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.flesh import Flesh
from rotctl.mechanics.model import Model
from rotctl.mechanics.physics import LockstepPhysics, MujocoPhysics
from rotctl.mechanics.physics.mujoco_physics import IMPEDANCES
from rotctl.mechanics.terrain.ground import LEAST_FRICTION, MOST_FRICTION
from rotctl.motion import make_pose
from rotctl.settings.checking import checked
from rotctl.settings.complaints import brief
from rotctl.settings.fields import ends
from rotctl.settings.plain import find, way
from rotctl.settings.writing import to_dict
from rotctl.simulation.start import StartSettings

ROUNDED = 0.999  # [-] of two steps: a time of three digits is no less than they are


def require_sense(config: Config, known: Model) -> None:
    """See that a run that is newly asked for comes to what it is told.

    Older runs, made before this was refused, are repeated and judged as they are.

    Args:
        known: the model of the config.

    Raises:
        InputError: a finish comes too late, the ground may be drawn as none can be, a joint is to
            begin where it cannot be, a dive never comes over the edge or is to enter in a pose out
            of reach, or what is said of a contact, a pull or a halt acts on nothing.
    """
    _require_ground(config)
    if not isinstance(config.physics, LockstepPhysics):
        _require_contact(config.physics)
        _require_slow(config.character, config.physics, config.controller.rate)
    else:
        _require_hard(config.character, config.physics)
    _require_bent(config.start, known)
    _require_pulled(config.behaviour, config.excursion)
    _require_halts(config.behaviour)
    _require_end(config.behaviour, config.duration)
    require_dive(config, known)


def _require_ground(config: Config) -> None:
    """The ground is one that there may be, of another plant too, whatever is drawn, and stays one.

    With less friction than MuJoCo has it is the same ground as with that.
    """
    usual, factors = config.terrain.friction, config.plant.friction
    key, drawn, with_these, least, most = "terrain.friction", f"{usual:g}", "", usual, usual
    if _may_be(least, most) and factors != (1.0, 1.0):
        key, drawn, with_these = "plant.friction", brief(factors), f"terrain.friction={usual:g}"
        least, most = (usual * factor for factor in factors)
    if _may_be(least, most) and isinstance(config.disturbance, Slip):
        low, high = ends(config.disturbance.friction)
        least, most = least * low, most * high
        key, drawn = "disturbance.friction", brief(config.disturbance.friction)
        with_these = f"terrain.friction={usual:g}"
        with_these += f" and plant.friction={brief(factors)}" if factors != (1.0, 1.0) else ""
    if not _may_be(least, most):
        has = f"with {with_these} the ground has {least:g} to {most:g}, " if with_these else ""
        raise InputError(
            f"{key}={drawn}: {has}valid: {LEAST_FRICTION:g}, the least that MuJoCo has, to "
            f"{MOST_FRICTION:g}"
        )


def _may_be(least: float, most: float) -> bool:
    return LEAST_FRICTION <= least <= most <= MOST_FRICTION


def _require_contact(physics: MujocoPhysics) -> None:
    """What MuJoCo would take for another number, without a word, is refused."""
    onset, firm, _, middle, power = physics.contact_solimp
    for i, value in ((0, onset), (1, firm), (3, middle)):
        if not IMPEDANCES[0] <= value <= IMPEDANCES[1]:
            raise InputError(
                f"physics.contact_solimp.{i}={value:g}: MuJoCo takes the nearest of "
                f"{IMPEDANCES[0]:g} to {IMPEDANCES[1]:g}; give one of them"
            )
    if power < 1.0:
        raise InputError(f"physics.contact_solimp.4={power:g}: MuJoCo takes 1; give that or more")


def _require_slow(character: Character, physics: MujocoPhysics, rate: float) -> None:
    """MuJoCo stops nothing in less than two steps; what a choice brings along is not told."""
    least = 2.0 / (rate * physics.substeps)
    for group, name, key, (told, _) in (
        ("character", character.name, "limit_solref", character.limit_solref),
        ("physics", physics.name, "contact_solref", physics.contact_solref),
    ):
        if told < ROUNDED * least and told != brought(group, name).get(key, (told,))[0]:
            raise InputError(
                f"{group}.{key}.0={told:g}: MuJoCo takes two physics steps, {least:.4g} s; give "
                "that or more"
            )


def _require_hard(character: Character, physics: LockstepPhysics) -> None:
    """Contacts in lockstep are hard: flesh is not told there, but as a character brings it."""
    whole = brought("character", character.name) if character.flesh else {}
    if not character.flesh or not whole:
        return
    flesh = whole.get("flesh")
    usual = to_dict(checked(Flesh, flesh)) if flesh else {}
    for key, value in to_dict(character.flesh).items():
        if value != usual.get(key):
            raise InputError(
                f"character.flesh.{key}={brief(value)}: acts on nothing, as contacts of "
                f"physics={physics.name} are hard; leave flesh as character={character.name} has it"
            )


def _require_bent(start: StartSettings, known: Model) -> None:
    """Joints begin within their ranges; a choice's own poses any body takes as far as it can."""
    whole = brought("start", start.name)
    poses = {f"postures.{about}.pose": posture.pose for about, posture in start.postures.items()}
    if start.aloft:
        poses["aloft.pose"] = start.aloft.pose
    if start.falling:
        poses["falling.landing.pose"] = start.falling.landing.pose
    for key, pose in poses.items():
        usual = find(whole, way(key))
        told = {name: angle for name, angle in pose.items() if find(usual, [name]) != angle}
        make_pose(known, told, f"start.{key}")


def _require_pulled(behaviour: BehaviourSettings, measured: ExcursionSettings) -> None:
    """A pull that is told acts on something; what every measure has of it is not told."""
    lacking: dict[str, str] = {}
    if measured.measure in ("integral", "root"):
        lacking["correction_time"] = f"measure={measured.measure} has no pull"
    elif not behaviour.by_excursion:
        lacking["correction_time"] = f"no task of behaviour={behaviour.name} turns or holds"
    if measured.measure == "clock":
        lacking["phase_time"] = "with measure=clock the phase goes by time"
    for key, why in lacking.items():
        told, usual = getattr(measured, key), brought("excursion", "oriented")[key]
        if told != usual:
            raise InputError(
                f"excursion.{key}={told:g}: acts on nothing, as {why}; leave it at {usual:g}"
            )


def _require_halts(behaviour: BehaviourSettings, key: str = "behaviour") -> None:
    """How a halt brakes is told where there is one; what a behaviour brings along is not told.

    One that does not come with rotctl brings what it has: its file may be anywhere, or edited.
    """
    if isinstance(behaviour, ChainSettings):
        for number, part in enumerate(behaviour.parts):
            _require_halts(part.behaviour, f"{part.place(number)}: behaviour")
    if not isinstance(behaviour, RollingSettings) or behaviour.pace is None or behaviour.halts:
        return
    told, whole = behaviour.pace.easing, brought("behaviour", behaviour.name)
    usual = (whole.get("pace") or {}).get("easing") if whole else told
    if told not in (None, usual):
        raise InputError(
            f"{key}.pace.easing={brief(told)}: acts on nothing, as nothing tells it to halt, "
            f"which is a 0 in pace.schedule; leave it at {brief(usual)}"
        )


def _require_end(behaviour: BehaviourSettings, duration: float, key: str = "behaviour") -> None:
    """A roll with a finish is told to end before a run of that duration [s] is over.

    Of a chain's parts only those of which it was said when: a run may be cut before the others.
    """
    if isinstance(behaviour, ChainSettings):
        for number, part in enumerate(behaviour.parts):
            if "finish.after" in part.said:
                _require_end(part.behaviour, duration, f"{part.place(number)}: behaviour")
    if isinstance(behaviour, RollingSettings) and behaviour.finish:
        after = behaviour.finish.after
        if after >= duration:
            raise InputError(
                f"{key}.finish.after={after:g}: it is never told to end, the run is over at "
                f"{duration:g} s; give less than that, or a longer duration"
            )
