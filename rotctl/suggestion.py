"""Of the valid names the one that was probably meant."""

from collections.abc import Iterable

LONGEST = 60  # characters: a longer one is no slip of the finger, and looking takes its square
ALIKE = 0.65  # of 1; `wieght` and `weight` are 0.83, `rnu` and `run` 0.67, `start` and `stand` 0.6

MANY, NEAR = 25, 6  # names: more are too many for a line, and so many are told of those


def meant(word: object, valid: Iterable[str]) -> str:
    """`did you mean NAME? `, to stand before the names that are valid; empty if none is like it."""
    from difflib import get_close_matches

    if not isinstance(word, str) or len(word) > LONGEST:
        return ""
    near = get_close_matches(word, list(valid), n=1, cutoff=ALIKE)
    return f"did you mean {near[0]}? " if near else ""


def instead_of_many(word: object, valid: Iterable[str], shown_by: str) -> str:
    """As `instead`; of more than `MANY` names only those most like the word.

    Args:
        shown_by: what to type to see them all.
    """
    from difflib import get_close_matches

    names = list(valid)
    if len(names) <= MANY:
        return instead(word, names)
    alike = isinstance(word, str) and len(word) <= LONGEST
    near = get_close_matches(str(word), names, n=NEAR, cutoff=0.0) if alike else names[:NEAR]
    more = f"and {len(names) - len(near)} more, see: {shown_by}"
    return f"{meant(word, names)}valid: {', '.join(near)} {more}"


def instead(word: object, valid: Iterable[str]) -> str:
    """What to write instead of a word: the name that was probably meant, and all that are valid."""
    names = list(valid)
    return f"{meant(word, names)}valid: {', '.join(names)}"
