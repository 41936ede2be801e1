"""YAML from strangers: plain data, or one line that does not repeat it."""

import subprocess
import sys

import pytest
import yaml

from rotctl.choices.config_folders import conf_dir, shipped
from rotctl.errors import InputError
from rotctl.settings.documents import from_yaml, read_yaml

NO_TEXT = "a key is no text; put it in quotes"


def test_values_are_counted(tmp_path):
    with pytest.raises(InputError) as caught:
        from_yaml("f", "[1, 2,\n[3]]", 4)
    assert str(caught.value) == "f:2: has more than 4 values"
    assert from_yaml("f", "[1, 2,\n[3]]", 5) == [1, 2, [3]]


def refused(text):
    with pytest.raises(InputError) as caught:
        from_yaml("f", text)
    return str(caught.value).removeprefix("f:")


def laughs(form, times):
    """Aliases of aliases of aliases, so many times each."""
    lines = ["a0: &a0 [x]"]
    lines += [
        f"a{i + 1}: &a{i + 1} " + form.format(", ".join([f"*a{i}"] * times)) for i in range(15)
    ]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("title: " + "9" * 5000, "1: a number has more than 40 digits"),
        ("title: 0x" + "f" * 5000, "1: a number has more than 40 digits"),
        ("\na: " + "[" * 3000, "2: nested more than 12 deep"),
        ("a: " + "[" * 12 + "]" * 12, "1: nested more than 12 deep"),
        ("- " * 100_000, "1: nested more than 12 deep"),
        ("a: &x [*x]", "1: has an alias of what it is in, or of nothing"),
        ("a: *x", "1: has an alias of what it is in, or of nothing"),
        (laughs("[{}]", 10), "6: has more than 200000 values"),
        (laughs("[{}]", 1), "12: nested more than 12 deep"),
        ("a: !!python/object/apply:os.system [x]", "1: has a tag; write plain values"),
        ("a: !!timestamp 2026-13-45", "1: has a tag; write plain values"),
        ("a: !!binary aGk=", "1: has a tag; write plain values"),
        ("a: 1\nb: 2\na: 3", "3: a key comes twice"),
        ("? [a]\n: 1", f"1: {NO_TEXT}"),
        ("2: 1", f"1: {NO_TEXT}"),
        ("no: 1", f"1: {NO_TEXT}"),
        ('a: "\\e[31m"', "1: a text has a control character"),
        ('"\\0": 1', "1: a text has a control character"),
        ("a: \x1b", " is no YAML: it has a control character"),
        ("a: 1\n---\nb: 2", "2: is no YAML: expected a single document in the stream, "
         "but found another document"),
        ("a:\n\tb: 1", "2: is no YAML: the line begins with a tab, and YAML indents with spaces"),
        ("a: 1\n  \tb: 1", "2: is no YAML: the line begins with a tab, and YAML indents with "
         "spaces"),
        ("a: [1", "2: is no YAML: while parsing a flow sequence, did not find expected ',' or ']'"),
    ],
)  # fmt: skip
def test_what_is_more_than_plain_yaml_is_one_line(text, message):
    assert refused(text) == message


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("", None),
        ("a: 2026-13-45", {"a": "2026-13-45"}),
        ("a: 2026-01-02", {"a": "2026-01-02"}),
        ("<<: {a: 1}", {"<<": {"a": 1}}),
        ("a: &x [1, &y {b: 2}]\nc: *x\nd: [*y, *y]",
         {"a": [1, {"b": 2}], "c": [1, {"b": 2}], "d": [{"b": 2}] * 2}),
        ("[1, 0x10, -2.5, 1e3, yes, ~, x, 'no']", [1, 16, -2.5, "1e3", True, None, "x", "no"]),
        ("[" * 12 + "]" * 12, [[[[[[[[[[[[]]]]]]]]]]]]),
        (f"a: {'9' * 40}", {"a": int("9" * 40)}),
        ("a: ü\U0001f938\u2028", {"a": "ü\U0001f938"}),
    ],
)  # fmt: skip
def test_plain_yaml_is_read(text, data):
    assert from_yaml("f", text) == data


SECRETS = (
    *("a: [secret", "secret: @secret", "%YAML secret", "a: *secret", "a: !secret 1"),
    *("&secret a: [", "{secret: 1, secret: 2}", "'secret", "a: `secret", "secret: [1\nsecret: 2"),
    *("%TAG !secret! x\n---\na: !other!x 1", "? secret: 1\n- secret"),
)


def test_no_message_repeats_what_is_in_the_file():
    for text in SECRETS:
        assert "secret" not in refused(text)


def test_nor_does_one_of_the_parser_in_python():
    """It is used where C's is missing, and quotes the text in its messages."""
    script = (
        "import yaml; del yaml.CSafeLoader; import sys\n"
        "from rotctl.settings import documents\n"
        "for text in eval(sys.stdin.read()):\n"
        "    try: print(documents.from_yaml('f', text))\n"
        "    except documents.InputError as error: print(error, file=sys.stderr)"
    )
    finished = subprocess.run(
        [sys.executable, "-c", script], input=repr(SECRETS), text=True, capture_output=True
    )
    assert (finished.returncode, finished.stdout) == (0, "")
    assert finished.stderr.count("\n") == len(SECRETS)
    assert "secret" not in finished.stderr


def test_all_that_we_ship_is_plain_yaml():
    paths = [*conf_dir().rglob("*.yaml"), *shipped("experiments").glob("*.yaml")]
    assert len(paths) > 50
    for path in paths:
        assert read_yaml(path, linked=False) == yaml.safe_load(path.read_text()), path
