"""The one root of all rotctl errors: a single clear line for the user, and an exit code."""

LONGEST = 2000  # characters of a message; the longest list of valid choices has 900


def bounded(message: str) -> str:
    """The message, or its beginning: what it repeats may be a stranger's megabyte."""
    return message if len(message) <= LONGEST else f"{message[: LONGEST - 3]}..."


class RotctlError(Exception):
    """Base of every error rotctl raises on purpose.

    Attributes:
        exit_code: what the command line returns for it (1: the run itself broke down,
            2: bad input).
    """

    exit_code = 1

    def __init__(self, message: str) -> None:
        super().__init__(bounded(message))


class InputError(RotctlError):
    """Bad input: names the bad value and the valid choices or range."""

    exit_code = 2


class LogError(InputError):
    """A log that cannot be read: truncated, foreign, damaged or unsafe."""
