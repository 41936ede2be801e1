"""What was probably meant, wherever a name is none."""

import pytest

from rotctl.cli.main import main
from rotctl.suggestion import MANY, NEAR, instead, instead_of_many, meant


def test_the_nearest_of_the_valid_names():
    assert meant("wieght", ["damping", "weight", "stiffness"]) == "did you mean weight? "
    assert meant("rnu", ["show", "run"]) == "did you mean run? "
    assert instead("lef", ["left", "right"]) == "did you mean left? valid: left, right"


def test_of_many_names_those_most_like_the_word():
    names = [f"{move}_{n}" for move in ("roll", "jump") for n in range(MANY)]
    told = instead_of_many("jmup_3", names, "rotctl list x")
    assert told.startswith("did you mean jump_3? valid: jump_3, jump_")
    assert told.endswith(f" and {2 * MANY - NEAR} more, see: rotctl list x")
    assert told.count("jump_") == 1 + NEAR
    assert "roll_" not in told
    assert instead_of_many("jmup_3", names[:MANY], "s") == instead("jmup_3", names[:MANY])
    assert instead_of_many(None, names, "s").endswith(" more, see: s")


@pytest.mark.parametrize("word", ["stand", "", "x" * 100_000, True, None, 3])
def test_what_is_like_none_of_them_has_no_hint(word):
    assert meant(word, ["start", "x" * 100_000]) == ""
    assert instead(word, ["start"]) == "valid: start"


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["run", "behaviour=forwrd_roll"], "no such choice; did you mean forward_roll? valid: "),
        (["run", "terain=flat"], "unknown key 'terain'; did you mean terrain? valid keys: "),
        (
            ["run", "controller.poze.damping=1"],
            "unknown key 'controller.poze.damping'; did you mean pose? valid keys under controller",
        ),
        (["run", "controller.pose.wieght=1"], "did you mean weight? valid keys under controller"),
        (["run", "criteria.kind=rollin"], "no such kind; did you mean rolling? valid: "),
        (
            ["run", "character.exclude_from_control=[haed]"],
            "unknown body 'haed'; did you mean head?",
        ),
        (
            ["run", "+behaviour.poses.a.kneee=1"],
            "unknown joint 'kneee'; did you mean knee? valid: ",
        ),
        (["run", "behaviour=back_flip", "behaviour.shape=tukc"], "did you mean tuck? valid: tuck"),
        (
            ["run", "behaviour=back_flip", "+course=circle"],
            "behaviour.course: staged settings have none; rolling ones have\n",
        ),
        (["sweep", "+experiment=tabel1", "--out=x"], "no such experiment; did you mean table1? "),
        (["tune", "clips", "--out=x"], "no such space; did you mean clip? valid: ablation, clip, "),
        (
            ["new", "behaviors", "a", "--from", "b"],
            "no such kind of file; did you mean behaviour? ",
        ),
        (
            ["new", "start", "a", "--from", "rset"],
            "no such start or run; did you mean rest? valid: ",
        ),
        (["run", "forward_roll_2"], "has no '='; write behaviour=forward_roll_2\n"),
        (["run", "landing"], "has no '='; write controller=landing or criteria=landing\n"),
        (["run", "start"], "has no '='; write start=CHOICE; valid: aloft, armstand, falling, "),
        (
            ["run", "--terrain", "flat"],
            "unrecognized arguments: --terrain (write terrain=CHOICE); ",
        ),
        (["run", "--seed=3"], "unrecognized arguments: --seed=3 (write seed=NUMBER); "),
        (["tune"], "the following arguments are required: NAME, --out; see rotctl tune --help"),
        (["rnu"], "'rnu': no such choice; did you mean run? valid: run, render, "),
        (
            ["run", "--filmstip"],
            "unrecognized arguments: --filmstip (did you mean --filmstrip?); see",
        ),
        (
            ["run", "--filmstrip", "roll.png"],
            "--filmstrip takes no file, but 'roll.png' follows it; it is drawn beside what is "
            "made; rotctl render RUN --filmstrip roll.png draws a run's elsewhere; see rotctl run",
        ),
        (
            ["author-motion", "keys.yaml", "--out", "a.yaml", "--filmstrip", "a.png"],
            "--filmstrip takes no file, but 'a.png' follows it; ",
        ),
        (["run", "seed=1", "--json", "row.json"], "so write: --json > row.json; see rotctl run"),
        (["run", "--filmstrip", "forward_roll_2"], "write behaviour=forward_roll_2\n"),
        (
            ["export", "r.h5", "--to", "gtlf"],
            "'gtlf': no such choice; did you mean gltf? valid: bvh",
        ),
    ],
)
def test_every_kind_of_name_has_it(arguments, hint, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    try:
        code = main(arguments)
    except SystemExit as end:  # argparse's own way to refuse
        code = end.code
    assert code == 2
    assert hint in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
