"""What can be chosen, and where it is written."""

import pytest

from rotctl.choices import config_folders
from rotctl.choices.config_folders import conf_dir
from rotctl.choices.describing import groups
from rotctl.choices.listing import choices
from rotctl.errors import InputError


def test_every_group_of_the_issue_is_listed():
    found = groups()
    assert {"behaviour", "character", "controller", "physics", "start", "terrain"} <= set(found)
    assert list(found) == sorted(found)
    assert "forward_roll_1" in found["behaviour"]
    assert {"rest", "symmetric", "tucked"} <= set(found["start"])


def test_every_choice_has_one_line_of_description():
    for group, described in groups().items():
        for choice, description in described.items():
            assert description, f"{group}={choice}"
            assert "\n" not in description
            assert len(description) < 120, f"{group}={choice}"
            assert description.endswith((".", "?", ".md")), f"{group}={choice}: is cut off"


def test_the_choices_of_one_group():
    for group, described in groups().items():
        assert choices(group) == list(described)
    for no_group in ("seed", "nope", "", "..", "../conf/start", "/etc", "behaviour.poses"):
        assert choices(no_group) == []


@pytest.fixture
def conf(tmp_path, monkeypatch):
    """A package folder of our own, with a conf/ beside it."""
    (tmp_path / "package").mkdir()
    (tmp_path / "conf" / "start").mkdir(parents=True)
    (tmp_path / "conf" / "config.yaml").write_text("seed: 0\n")
    monkeypatch.setattr(config_folders, "__file__", str(tmp_path / "package/choices/here.py"))
    return tmp_path / "conf"


def test_the_opening_comment_describes_a_file_that_does_not_describe_itself(conf):
    (conf / "start" / "a.yaml").write_text("# A start.\n# More of it.\nname: a\n")
    (conf / "start" / "b.yaml").write_text("# Not this.\nname: b\ndescription: This.\n")
    (conf / "start" / "c.yaml").write_text("name: c\n")
    (conf / "start" / "d.yaml").write_text("")
    (conf / "start" / "e.yaml").write_text("title: Of an experiment.\n")
    told = {"a": "A start.", "b": "This.", "c": "", "d": "", "e": "Of an experiment."}
    assert groups() == {"start": told}


def test_configs_inside_the_package_come_first(conf, tmp_path):
    assert conf_dir() == conf
    inside = tmp_path / "package" / "conf"
    inside.mkdir()
    assert conf_dir() == conf
    (inside / "config.yaml").write_text("seed: 0\n")
    assert conf_dir() == inside


def test_an_installation_without_configs_says_so(conf, tmp_path):
    (conf / "config.yaml").unlink()
    with pytest.raises(InputError) as caught:
        conf_dir()
    assert str(caught.value) == (
        f"no conf/config.yaml in {tmp_path / 'package'} or beside it; reinstall rotctl"
    )
