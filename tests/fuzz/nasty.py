"""What is done to good input: bytes, texts, plain data, numbers."""

import json
import math

NUMBERS = (
    *("0", "-1", "1e308", "-1e308", "nan", "-nan", "inf", ".nan", "-.inf", "1e-320", "1e400"),
    *("9" * 400, "9" * 5000, "0x" + "f" * 600, "1:60:60", "0b1", "08", "1_0", "٣", "½", "1e"),
    *("2147483648", "-9223372036854775809", "18446744073709551616", "1e9", "1e15", "0.1.2", "+"),
)
TEXTS = (
    *("", " ", "\0", "\x1b[31m", "\x7f", "\u202e", "\u2028", "\ufeff", "\r\n", "\t"),
    *("é" * 300, "a" * 9000, "\\ud800", "__class__", "--1"),
    *("'", '"', "\\", "`", "@", "%", "*x", "&x", "&x [*x]", "!!python/object/apply:os.system [id]"),
    *("!x", "<<: *x", "- " * 2000, "[" * 3000, "{" * 600, "{a: " * 200, "(" * 300, "]", "}", "---"),
    *("${oc.env:CANARY}", "${seed}", "???", "null", "~", "yes", "no", "2026-13-45", "2026-01-01"),
    *("../../outside/victim", "/dev/zero", "/dev/stdin", "outside", "<script>alert(1)</script>"),
    *("$x^2$", "$\\frac{", "{{ 7*7 }}", "%s%n", "a|b", "]]>", "<!DOCTYPE a>"),
)
VALUES = (
    *(None, True, False, [], {}, "", "x", -1, 0, 1, 0.5, -0.0, 1e308, -1e308, 1e15),
    *(math.nan, math.inf, 2**31, 2**63, 2**70, -(2**63), 10**45, [[[[]]]], ["x"] * 300),
    *({"a": {"b": []}}, [0.0] * 3, {f"k{i}": i for i in range(4000)}),
    *("\ud800", "\0", "\x1b[31m", "a" * 9000, "a" * 10**6, "${oc.env:CANARY}", "1" * 50),
)


def text(rng):
    """A text that somebody may type."""
    return rng.choice((rng.choice(TEXTS), rng.choice(NUMBERS)))


def value(rng):
    """Plain data."""
    return rng.choice((rng.choice(VALUES), rng.choice(VALUES), text(rng)))


def mangled(rng, content):
    """Bytes, some of them otherwise."""
    content = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 5, 20))):
        at, size = rng.randrange(len(content) + 1), rng.choice((1, 1, 2, 8, 64, 1000))
        rng.choice((_flip, _cut, _repeat, _insert, _number, _swap, _end))(rng, content, at, size)
    return bytes(content)


def _flip(rng, content, at, size):
    for i in range(at, min(at + size, len(content))):
        content[i] = rng.choice((0, 255, content[i] ^ (1 << rng.randrange(8)), rng.randrange(256)))


def _cut(rng, content, at, size):
    del content[at : at + size]


def _end(rng, content, at, size):
    del content[at:]


def _repeat(rng, content, at, size):
    content[at:at] = content[at : at + size] * rng.choice((1, 2, 100))


def _insert(rng, content, at, size):
    content[at:at] = text(rng).encode()


def _swap(rng, content, at, size):
    other = rng.randrange(len(content) + 1)
    content[at:at], content[other:other] = content[other : other + size], content[at : at + size]


def _number(rng, content, at, size):
    """In the place of the next number."""
    begin = next((i for i in range(at, len(content)) if chr(content[i]) in "0123456789"), None)
    if begin is not None:
        end = begin
        while end < len(content) and chr(content[end]) in "0123456789.e-":
            end += 1
        content[begin:end] = rng.choice(NUMBERS).encode()


def changed(rng, data):
    """Plain data, something in it otherwise: a value, a key, one more or one less."""
    if rng.random() < 0.02:
        return value(rng)
    owners = []
    _collect(data, owners)
    owner = rng.choice(owners)
    keys = list(owner) if isinstance(owner, dict) else list(range(len(owner)))
    key = rng.choice(keys) if keys else None
    how = rng.choice(("value", "value", "value", "drop", "add", "rename", "twice"))
    if how == "add" or key is None:
        _put(rng, owner, rng.choice((text(rng), "name", "seed", "defaults", "_target_", "hydra")))
    elif how == "value":
        owner[key] = value(rng)
    elif how == "drop":
        del owner[key]
    elif how == "rename" and isinstance(owner, dict):
        owner[text(rng)] = owner.pop(key)
    elif isinstance(owner, list):
        owner[:] = owner * rng.choice((2, 3, 100))
    return data


def _put(rng, owner, name):
    if isinstance(owner, dict):
        owner[name] = value(rng)
    else:
        owner.insert(rng.randrange(len(owner) + 1), value(rng))


def _collect(data, owners):
    if isinstance(data, dict | list):
        owners.append(data)
        for inner in data.values() if isinstance(data, dict) else data:
            _collect(inner, owners)


def dumped(rng, data):
    """Plain data as YAML, which JSON is too, in one of several hands."""
    import yaml

    try:
        if rng.random() < 0.5:
            return json.dumps(data).encode()
        return yaml.safe_dump(data, allow_unicode=True).encode("utf-8", "surrogatepass")
    except (yaml.YAMLError, ValueError):  # a surrogate that YAML cannot spell
        return json.dumps(data).encode()
