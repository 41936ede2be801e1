"""Of the valid names the one that was probably meant."""

from collections.abc import Iterable

LONGEST = 60  # characters: a longer one is no slip of the finger, and looking takes its square
ALIKE = 0.65  # of 1; `wieght` and `weight` are 0.83, `rnu` and `run` 0.67, `start` and `stand` 0.6


def meant(word: object, valid: Iterable[str]) -> str:
    """`did you mean NAME? `, to stand before the names that are valid; empty if none is like it."""
    from difflib import get_close_matches

    if not isinstance(word, str) or len(word) > LONGEST:
        return ""
    near = get_close_matches(word, list(valid), n=1, cutoff=ALIKE)
    return f"did you mean {near[0]}? " if near else ""


def instead(word: object, valid: Iterable[str]) -> str:
    """What to write instead of a word: the name that was probably meant, and all that are valid."""
    names = list(valid)
    return f"{meant(word, names)}valid: {', '.join(names)}"
