"""The one root of all rotctl errors: a single clear line for the user, and an exit code."""


class RotctlError(Exception):
    """Base of every error rotctl raises on purpose.

    Attributes:
        exit_code: what the command line returns for it (1: the run itself broke down,
            2: bad input).
    """

    exit_code = 1


class InputError(RotctlError):
    """Bad input: names the bad value and the valid choices or range."""

    exit_code = 2


class LogError(InputError):
    """A log that cannot be read: truncated, foreign, damaged or unsafe."""
