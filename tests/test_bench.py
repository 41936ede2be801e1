"""The benchmark runs and says what it should; what it measures is nobody's assertion."""

import mujoco
import pytest

from rotctl.bench import scaling, solvers, split, startup, whole
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode


def test_the_split_adds_up(monkeypatch):
    monkeypatch.setattr(split, "SECONDS", 0.5)
    table = split.split(1)
    for word in (*split.STAGES, "control / physics", "real-time factor", "compiled", "reference"):
        assert word in table


def test_the_physics_alone_are_those_of_the_run(monkeypatch):
    """Else they were no limit: a roll's torques lead to its last state again."""
    ends, usual = [], whole.rollout.rollout
    monkeypatch.setattr(
        whole.rollout, "rollout", lambda *asked: ends.append(usual(*asked)[0][0, -1])
    )
    scenario = build(load(["duration=0.5"]))
    buffer, _ = in_memory(scenario)
    whole._physics(scenario.model, buffer, 4)
    data = mujoco.MjData(scenario.model.mj)
    mujoco.mj_setState(scenario.model.mj, data, ends[0], whole.FULL)
    episode = Episode(build(load(["duration=0.5"])))
    for _ in range(30):
        episode.step()
    assert data.qpos.tobytes() == episode.data.qpos.tobytes()


def test_the_whole_loop_beside_the_physics(monkeypatch):
    runs = {"a roll": ("duration=0.2",)}
    monkeypatch.setattr(whole, "RUNS", runs)
    assert whole.table(1).splitlines()[-1].startswith("a roll")


def test_solvers_agree_with_the_reference_solver():
    lines = solvers.compare(4).splitlines()
    rows = {line[:28].strip(): line[28:].split() for line in lines[4:]}
    assert set(rows) == set(solvers.CHOICES)
    assert float(rows[solvers.TRUTH][4]) == 0.0
    for name in ("boxqp condensed, compiled", "boxqp condensed, numpy"):
        assert float(rows[name][4]) < 1e-3  # [N m]


@pytest.mark.parametrize("contacts", [0, 3, 11])
def test_a_lying_character_has_the_contacts_asked_for(contacts):
    config = scaling.load([])
    model = scaling._model(config, 31)
    assert model.mj.nu == 31
    state = scaling.Controller(model, config.controller).read(scaling._lying(model, contacts))
    assert state.contacts.count == contacts


def test_costs_are_plotted(tmp_path):
    costs = [scaling.Cost(m, 29, 10.0 * m, 20.0 * m, 100.0 * m) for m in scaling.CONTACTS if m]
    scaling.plot(costs, tmp_path / "cost.svg")
    assert (tmp_path / "cost.svg").read_text().startswith("<?xml")
    assert "contacts" in scaling.table(costs)


def test_processes(monkeypatch):
    monkeypatch.setattr(startup, "SECONDS", 0.5)
    assert "start-up" in startup.processes(1)


def test_repeats_must_be_positive(capsys):
    assert main(["bench", "--repeats", "0"]) == 2
    assert capsys.readouterr().err == "rotctl: --repeats=0: must be at least 1\n"
