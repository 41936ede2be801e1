"""What stands above every picture of a run: its name, which one it is, and how it ended."""

from dataclasses import dataclass

from rotctl.log import RunLog

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
        done, took = outcome.get("revolutions"), outcome.get("duration")
        if isinstance(done, float) and isinstance(took, float):
            return True, f"success: {done:.1f} revolutions in {took:.1f} s"
        return True, "success"
    if outcome.get("success") is False:
        return False, f"FAILED: {plain(outcome.get('failure_reason') or 'no reason given')}"
    return None, "outcome unknown"


def plain(value: object) -> str:
    """A stranger's text on one printable line."""
    return "".join(c if c.isprintable() else " " for c in f"{value!s:.{LONGEST}}")
