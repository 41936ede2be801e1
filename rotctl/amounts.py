"""How many there are of something, for people."""


def count(n: int, one: str, many: str = "") -> str:
    """`1 run`, `3 runs`."""
    return f"{n} {one if n == 1 else many or one + 's'}"
