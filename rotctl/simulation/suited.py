"""Which starts suit a roll, for messages about one that does not."""

from rotctl.choices.contents import content
from rotctl.choices.listing import shipped_files


def suited(roll_about: str) -> str:
    """The starts that come with rotctl for a roll about an axis; one's own may be wrong."""
    fit = []
    for name, path in shipped_files("start").items():
        data = content(path)
        postures = data.get("postures")
        elsewhere = roll_about != "left" and ("falling" in data or "aloft" in data)
        if not elsewhere and (not isinstance(postures, dict) or roll_about in postures):
            fit.append(name)
    return f"valid: {', '.join(fit)}"
