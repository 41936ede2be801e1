"""The schema is complete in itself."""

from rotctl.log.schema import ATTRIBUTES, GROUPS, SCHEMA, WRITER_ATTRIBUTES


def test_every_dataset_has_a_unit_and_a_one_line_description():
    for spec in SCHEMA.values():
        assert spec.unit
        assert spec.description
        assert "\n" not in spec.description


def test_groups_and_writer_attributes_are_part_of_the_schema():
    names = "trajectory command contacts disturbance solver events model"
    assert list(GROUPS) == names.split()
    assert set(WRITER_ATTRIBUTES) < set(ATTRIBUTES)
