"""What stands above every picture of a run: its name, which one it is, and how it ended."""

from dataclasses import dataclass
from itertools import islice

from rotctl.log import RunLog
from rotctl.settings.complaints import clip

# What a success was, by the columns that a kind of motion has.
DONE = {
    ("revolutions", "duration"): "{:.1f} revolutions in {:.1f} s",
    ("entry_angle",): "enters {:.1f} deg off the vertical",
    ("revolved", "flight_time"): "turned {:.0f} deg, {:.2f} s in the air",
    ("turned", "arrival"): "turned {:.0f} deg in {:.1f} s",
}
LONGEST = 140  # characters of a stranger's text


@dataclass(frozen=True)
class Title:
    """The words above a picture.

    Attributes:
        name: of the behaviour.
        about: seed and run id.
        success: None where the log does not say.
        verdict: one line on how the run ended.
    """

    name: str
    about: str
    success: bool | None
    verdict: str


def title(log: RunLog) -> Title:
    """The title of a run.

    Raises:
        LogError: the outcome is damaged.
    """
    outcome = log.outcome
    about = f"seed {log.attributes['seed']}   run {plain(log.attributes['run_id'])}"
    return Title(plain(outcome.get("behaviour", "run")), about, *verdict(outcome))


def verdict(outcome: dict[str, object]) -> tuple[bool | None, str]:
    """Whether a run succeeded (None: it does not say), and that in words."""
    if outcome.get("success") is True:
        told = (
            words.format(*[outcome[key] for key in keys])
            for keys, words in DONE.items()
            if all(isinstance(outcome.get(key), float) for key in keys)
        )
        return True, ": ".join(["success", *islice(told, 1)])
    if outcome.get("success") is False:
        return False, f"FAILED: {plain(outcome.get('failure_reason') or 'no reason given')}"
    return None, "outcome unknown"


def plain(value: object, longest: int = LONGEST) -> str:
    """A stranger's text on one printable line of so many characters at most."""
    return "".join(c if c.isprintable() else " " for c in clip(str(value), longest))
