"""All kinds of input, and how often each is made."""

import random

from fuzz import folders, logs, texts, words

KINDS = {
    logs.log_bytes: 12,
    logs.log_content: 16,
    logs.log_structure: 8,
    folders.sweep: 16,
    folders.against: 4,
    texts.space: 7,
    texts.history: 3,
    texts.clip: 6,
    texts.keys: 4,
    texts.capture: 8,
    texts.conf: 14,
    words.overrides: 12,
    words.options: 8,
    words.environment: 2,
}
# Those of which `make test` gives some: a small part of a second each.
CHEAP = {
    logs.log_bytes: 3,
    logs.log_structure: 3,
    folders.against: 2,
    texts.space: 3,
    texts.conf: 1,
    words.overrides: 2,
}


def make(samples, seed, number, here, some):
    """The input of a number: files in `here`, and what is to be done with them."""
    rng = random.Random(f"{seed}:{number}")
    return rng.choices(list(some), list(some.values()))[0](rng, samples, here)
