"""Metrics of one's own: what they say, what they may not say, and what they may cost."""

import random

import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.log.schema import SCHEMA
from rotctl.metrics.expressions.evaluation import evaluate
from rotctl.metrics.expressions.expression import LONGEST, NAMES, read, read_all
from rotctl.metrics.expressions.operations import FUNCTIONS, LOOKED_UP

STEPS = 8
BODIES = ["world", "pelvis", "head"]
RNG = np.random.default_rng(5)
LOG = {
    "trajectory/time": 0.5 * np.arange(STEPS),
    "trajectory/com": RNG.normal(size=(STEPS, 3)),
    "trajectory/qpos": RNG.normal(size=(STEPS, 9)),
    "contacts/count": np.array([2, 0, 0, 0, 1, 0, 0, 3], dtype="i4"),
    "contacts/body": np.tile(np.array([2, 1, -1], dtype="i4"), (STEPS, 1)),
    "contacts/force_peak": RNG.uniform(size=(STEPS, 3)).astype("f4"),
    "contacts/used": RNG.uniform(size=(STEPS, 3)) > 0.5,
    "model/body": np.array(BODIES, dtype="S64"),
    "model/joint": np.array(["hip", "knee"], dtype="S64"),
}


def value(text):
    return evaluate(read("m", text), LOG)


def refusal(text):
    with pytest.raises(InputError) as caught:
        value(text)
    return str(caught.value)


COM, QPOS, COUNT, TIME = (
    LOG[name] for name in ("trajectory/com", "trajectory/qpos", "contacts/count", "trajectory/time")
)
PEAK, USED = LOG["contacts/force_peak"].astype(float), LOG["contacts/used"]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("max(com[:, 2])", COM[:, 2].max()),
        ("trajectory_com[-1, 0] - com[0, 0]", COM[-1, 0] - COM[0, 0]),
        ("mean(count == 0)", 5 / 8),
        ("longest(count == 0) * period", 1.5),
        ("first(count == 0) * period", 0.5),
        ("first(count > 9)", np.nan),
        ("sum(1 <= time < 3)", 4.0),
        ("sum(time < 1 or time >= 3 and not count)", 3.0),
        ("sum((time < 1) | ~(count > 0) & (time >= 3))", 3.0),
        ("max(norm(com))", np.sqrt((COM**2).sum(axis=1)).max()),
        ("max(norm(com, axis=0))", np.sqrt((COM**2).sum(axis=0)).max()),
        ("sum(where(contacts_body == body('head'), force_peak, 0))", PEAK[:, 0].sum()),
        ("degrees(max(qpos[:, 7 + joint('knee')]))", np.degrees(QPOS[:, 8].max())),
        ("percentile(abs(com), 90, axis=0)[1]", np.percentile(np.abs(COM), 90, axis=0)[1]),
        ("median(com[::2, 1])", np.median(COM[::2, 1])),
        ("mean(com[count > 0, 0])", COM[COUNT > 0, 0].mean()),
        ("mean(com[count > 9, 0])", np.nan),
        ("sum(used) - sum(not used)", 2 * USED.sum() - USED.size),
        ("-any(used) + +all(used)", -1.0),
        ("max(abs(diff(com[:, 0]))) / period", np.abs(np.diff(COM[:, 0])).max() / 0.5),
        ("2 ** 0.5 // 1 + 7 % 4", 4.0),
        ("clip(pi, 0, 3) + minimum(1, 2) + maximum(1, 2)", 6.0),
        ("1 / 0", np.inf),
        ("sum(com ** 2 - com * com) + sum(com ** 3)", (COM**3).sum()),
        ("sum(abs(com) ** 0.5)", np.sqrt(np.abs(COM)).sum()),
        ("exp(1) + log(2) + atan2(1, 2)", np.e + np.log(2) + np.arctan2(1, 2)),
        ("sum(sin(com)) + sum(cos(qpos))", np.sin(COM).sum() + np.cos(QPOS).sum()),
        ("log(0)", -np.inf),
        ("log(-0.0)", -np.inf),
        ("log(-1)", np.nan),
        ("sin(1 / 0)", np.nan),
        ("(-1) ** 0.5", np.nan),
        ("exp(1000)", np.inf),
        ("9 ** 9 ** 9", np.inf),
    ],
)
def test_values_are_those_of_numpy(text, wanted):
    assert value(text) == pytest.approx(wanted, nan_ok=True)


def test_of_numpys_own_there_are_those_alone_that_are_the_same_everywhere():
    """Sines and the like have other last bits where a processor has wider vectors."""
    own = {name for name, function in FUNCTIONS.items() if isinstance(function.made, np.ufunc)}
    exact = {"abs", "sqrt", "degrees", "radians", "isfinite", "minimum", "maximum"}
    assert own <= exact


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("com.T", "metric m: Attribute is not allowed; numbers, arrays and functions are"),
        ("__import__('os')", "metric m: no function '__import__'; valid: max, min"),
        ("lambda: 1", "metric m: Lambda is not allowed"),
        ("(lambda: 1)()", "metric m: lambda: 1(...) is no function; such as max(com[:, 2]) is"),
        ("[x for x in com]", "metric m: ListComp is not allowed"),
        ("max(*com)", "metric m: Starred is not allowed"),
        ("max(com, out=com)", "metric m: max takes axis=0, 1 or 2, and no other keyword"),
        ("max(com, **com)", "metric m: max takes axis=0, 1 or 2, and no other keyword"),
        ("abs(com, axis=0)", "metric m: abs takes no axis, and no other keyword"),
        ("max(com, axis=com)", "metric m: max takes axis=0, 1 or 2, and no other keyword"),
        ("max()", "metric m: max takes 1 argument: arrays and numbers"),
        ("max('com')", "metric m: max takes 1 argument: arrays and numbers"),
        ("body(1)", "metric m: body takes one name in quotes"),
        ("com[0](1)", "metric m: com[0](...) is no function; such as max(com[:, 2]) is"),
        ("com.mean()", "metric m: com.mean(...) is no function; write mean(com)"),
        ("com[0].men()", "metric m: com[0].men(...) is no function; such as max(com[:, 2]) is"),
        ("kom[0, 0]", "metric m: no array 'kom' in a log; did you mean com? valid: "),
        ("max", "metric m: no array 'max' in a log; "),
        ("comm", "metric m: no array 'comm' in a log; did you mean com? valid: "),
        ("men(com)", "metric m: no function 'men'; did you mean mean? valid: max, min"),
        ("'a' == 'a'", "metric m: 'a' is no number here"),
        ("1j", "metric m: 1j is no number here"),
        ("com[..., 0]", "metric m: Ellipsis is no number here"),
        ("9" * 20, f"metric m: {'9' * 20} is no number here"),
        ("com[0, 0", "metric m='com[0, 0': cannot be read; such as max(com[:, 2])"),
        ("x = 1", "metric m='x = 1': cannot be read; such as max(com[:, 2])"),
        ("(" * 300, "metric m='"),
        ("1" * (LONGEST + 1), f"metric m: longer than {LONGEST} characters"),
        ("+".join("1" * 120), "metric m: more than 200 parts"),
        # What only a run tells.
        ("com", "metric m: gives 8 x 3 values; make one of them, such as by max(...)"),
        ("com[:, 9]", "metric m: index 9 is out of bounds for axis 1 with size 3"),
        ("com[0.5, 0]", "metric m: an index must be a whole number, or a truth value for each row"),
        ("com[com]", "metric m: an index must be a whole number, or a truth value for each row"),
        ("max(com + time)", "metric m: shape mismatch: objects cannot be broadcast"),
        ("body('tail')", "metric m: model/body has no 'tail'; it has: world, pelvis, head"),
        ("max(phase)", "metric m: this log has no trajectory/phase"),
        ("max(com, axis=2)", "metric m: axis 2 is out of bounds"),
        ("max(com[:0])", "metric m: zero-size array to reduction operation maximum"),
    ],
)
def test_whatever_else_is_one_line(text, said):
    assert refusal(text).startswith(said)
    assert "\n" not in refusal(text)


def test_names_of_metrics():
    for name in ("a b", "1a", "", "ä"):
        with pytest.raises(InputError, match=r"must be letters, digits and _, a letter first$"):
            read(name, "1")
    with pytest.raises(InputError, match=r"^metrics: 51 of them, valid: up to 50$"):
        read_all({f"m{i}": "1" for i in range(51)})


def test_every_array_of_numbers_has_a_name():
    numbers = {path for path, spec in SCHEMA.items() if np.dtype(spec.dtype).kind in "fib"}
    assert set(NAMES.values()) == numbers
    assert NAMES["time"] == "trajectory/time"
    assert not set(NAMES) & {*FUNCTIONS, *LOOKED_UP}


@pytest.mark.parametrize(
    "text",
    [
        "max(time[:, 0:1] * time[:, 0])",  # an outer product
        " + ".join(["sum(cumsum(com))"] * 8),
        "+".join(["median(com)"] * 8),
    ],
)
def test_memory_and_work_are_bounded(text):
    many = 20_000
    log = {"trajectory/time": np.zeros((many, 2)), "trajectory/com": np.zeros((5_000_000, 3))}
    with pytest.raises(InputError, match="elements, valid|too much to compute"):
        evaluate(read("m", text), log)


WORDS = [
    *("com", "time", "count", "qpos", "used", "force_peak", "contacts_body", "period", "pi", "x"),
    *FUNCTIONS,
    *LOOKED_UP,
    *"()[]:,.+-*/%<>=!&|~^@'\"",
    *("**", "//", "==", "!=", "<=", ">=", " and ", " or ", " not ", " if ", " else ", " for "),
    *("0", "1", "-1", "2.5", "1e308", "'head'", "axis=0", "lambda ", "__class__", "\0", "é"),
]  # fmt: skip


def grown(rng, depth):
    """An expression that is mostly right."""
    kind = rng.random()
    if depth == 0 or kind < 0.2:
        return rng.choice(["com", "time", "count", "qpos", "used", "force_peak", "1", "0.5", "pi"])
    if kind < 0.5:
        name = rng.choice(list(FUNCTIONS))
        least, most = FUNCTIONS[name].arguments
        inner = [grown(rng, depth - 1) for _ in range(rng.randint(least, most))]
        return f"{name}({', '.join(inner)}{rng.choice(['', '', ', axis=0', ', axis=1'])})"
    if kind < 0.7:
        index = rng.choice(
            ["0", "-1", ":, 0", ":0", "::2", "used", "0, 0", "1e9", "-2:2", "time > 1"]
        )
        return f"({grown(rng, depth - 1)})[{index}]"
    sign = rng.choice(
        ["+", "-", "*", "/", "//", "%", "**", "<", ">=", "==", " and ", " or ", "&", "|"]
    )
    return f"({grown(rng, depth - 1)}{sign}{grown(rng, depth - 1)})"


@pytest.mark.parametrize("seed", range(3))
def test_any_text_is_a_number_or_one_line(seed):
    rng = random.Random(seed)
    outcomes, lines = {"number": 0, "refused": 0}, []
    for i in range(600):
        text = (
            grown(rng, rng.randint(0, 5))
            if i % 2
            else "".join(rng.choices(WORDS, k=rng.randint(0, 9)))
        )
        try:
            assert isinstance(value(text), float)
            outcomes["number"] += 1
        except InputError as error:
            outcomes["refused"] += 1
            lines.append(str(error))
    assert min(outcomes.values()) > 30
    assert not any("\n" in line for line in lines)
