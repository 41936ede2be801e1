"""Results kept for the very objects they came from."""

from rotctl.caching import kept


def test_the_same_object_is_asked_about_once():
    asked = []

    @kept(most=10)
    def size(items):
        asked.append(items)
        return len(items)

    one, other = [1, 2], [1, 2]
    assert [size(one), size(one), size(other)] == [2, 2, 2]
    assert len(asked) == 2
    assert asked[0] is one
    assert asked[1] is other


def test_numbers_and_texts_are_compared_with_their_type():
    asked = []

    @kept(most=10)
    def told(value):
        asked.append(value)
        return str(value)

    assert [told(v) for v in (1, True, 1.0, "1", 1, 10**20, 10**20)] == [
        *("1", "True", "1.0", "1", "1"),
        *(str(10**20),) * 2,
    ]
    assert len(asked) == 5


def test_no_id_is_used_again_while_its_result_is_kept():
    @kept(most=3)
    def first(items):
        return items[0]

    for n in range(100):  # a list that is gone leaves its place to the next one
        assert first([n]) == n
