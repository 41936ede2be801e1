"""Content-Security-Policies: what a page may run and load, whatever a log says; little else."""

from base64 import b64encode
from hashlib import sha256

# What lies beside a page. Not all browsers count that as 'self' when a page is opened from disk.
BESIDE = "'self' file:"


def policy(**sources: str) -> str:
    """A policy that allows these sources, such as `style=this(css)`, and no others."""
    allowed = [f"{kind}-src {source}" for kind, source in sources.items()]
    return "; ".join(["default-src 'none'", *allowed, "base-uri 'none'", "form-action 'none'"])


def this(text: str) -> str:
    """The very script or style inside the page that reads so."""
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode('ascii')}'"
