"""JSON from strangers: plain data, or why it is none."""

import os

import pytest

from rotctl.errors import InputError
from rotctl.settings.json_documents import MOST_LINES, from_json, read_json_lines


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("NaN", "NaN is no number"),
        ('{"a": -Infinity}', "-Infinity is no number"),
        ("1e400", "a number is too large"),
        ("1" * 41, "a number has more than 40 digits"),
        ("[" * 13 + "]" * 13, "nested more than 12 deep"),
        ("[" * 100_000, "nested too deeply"),
        ('{"a": 1, "a": 2}', "a key comes twice"),
        ('{"a": "\\ud800"}', "a text has a control character"),
        ('{"\\udfff": 1}', "a text has a control character"),
        ('"\\u0000"', "a text has a control character"),
        ("{", "Expecting property name enclosed in double quotes: line 1 column 2 (char 1)"),
    ],
)  # fmt: skip
def test_what_is_more_than_plain_json_is_refused(text, message):
    with pytest.raises(ValueError, match=r".") as caught:
        from_json(text)
    assert str(caught.value) == message


def test_lines_are_read_one_by_one(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_text('{"a": "\u2028"}\n\nNaN\n[1]')
    found = list(read_json_lines(path, linked=False))
    assert found == [(1, {"a": "\u2028"}), (2, None), (3, None), (4, [1])]
    path.write_text("1\n" * (MOST_LINES + 1))
    with pytest.raises(InputError) as caught:
        list(read_json_lines(path, linked=False))
    assert str(caught.value) == f"{path}: more than 500000 lines"
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(InputError) as caught:
        list(read_json_lines(path, linked=False))
    assert str(caught.value) == f"{path}: is no plain file"
