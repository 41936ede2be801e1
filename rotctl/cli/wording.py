"""Text in lines that any terminal can show."""


def one_line(text: str) -> str:
    """The text on one line that a terminal can show."""
    return printable(" ".join(text.split()))


def printable(text: str) -> str:
    """Text from files and shells, without what could steer a terminal."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in text)
