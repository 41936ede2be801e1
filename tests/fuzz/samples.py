"""The good input that hostile input is made of."""

import io
import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from rotctl.choices import config_folders, listing
from rotctl.config.loading import load
from rotctl.log import RunLog, write_run
from rotctl.log.schema import MODEL_PATH, WRITER_ATTRIBUTES
from rotctl.settings.writing import to_dict

OVERRIDES = ["seed=range(0,2)", "duration=0.1", "--quiet"]
SPACE = """\
name: small
title: A small search
base: [behaviour=forward_roll_1]
parameters:
  - {key: controller.pose.stiffness, low: 200.0, high: 2000.0, scale: log, unit: 1/s2}
  - {key: "behaviour.poses.{a,b}.knee", low: -0.1, high: 2.8, unit: rad}
runs: {seeds: 1, duration: 0.1, final: 1}
objective: {over_runs: mean, survival: 0.6, progress: 0.4, pace: 0.65, drift: 0.03, heading: 0.001}
stopping: {stall_time: 1.5, stall_progress: 0.1, off_axis: 70.0}
sampler: {name: cmaes, population: 4, sigma: 0.15}
trials: 4
"""
EXPERIMENT = """\
title: A test
source: "[Brown2013] Table 1"
matrix: [["behaviour=forward_roll_1"]]
seeds: range(0,2)
deviations: [{text: Ours., where: {behaviour: forward_roll_1}}]
limitations: [Short.]
claims:
  - {id: roll, metric: success_rate, comparison: at_least, expected: 0.9, tolerance: 0.0,
     source: paper, where: {behaviour: forward_roll_1}}
  - {id: roll.speed, metric: speed_mean, expected: 1.2, tolerance: 0.1, source: paper}
"""
CLAIMS = """\
sweep,experiment,id,verdict,metric
d,x,roll,reproduced,success_rate
d,x,roll.speed,partly,speed_mean
"""


def make(folder, whole=True):
    """Samples in a folder, which is made by simulating a little.

    Args:
        whole: with captures and a search, which take some seconds more.
    """
    from here import swept

    sweep = swept(folder / "sweep", *OVERRIDES[:-1])
    (sweep / "experiment-x.yaml").write_text(EXPERIMENT)
    pushed = ("behaviour=turn_over", "disturbance=push", "disturbance.time=[0,0.05]")
    swept(folder / "staged", *pushed, "duration=0.1")
    for log in folder.rglob("run.h5"):
        _without_clock(log)
    behaviours = listing.choices("behaviour") if whole else ("forward_roll_1", "turn_over")
    chosen = [[f"behaviour={name}"] for name in behaviours]
    more = ("disturbance=push", "disturbance=wind", "plant=randomised") if whole else ()
    chosen += [[*chosen[0], word] for word in more]
    made = SimpleNamespace(
        sweep=sweep,
        logs=sorted(folder.rglob("run.h5")),
        manifest=(sweep / "sweep.jsonl").read_text(),
        overrides=OVERRIDES,
        experiment=EXPERIMENT,
        space=SPACE,
        claims=CLAIMS,
        clip=(config_folders.conf_dir() / "motion" / "forward_roll.yaml").read_text(),
        keys=(config_folders.conf_dir() / "motion" / "keys" / "forward_roll.yaml").read_text(),
        configs=[(overrides, to_dict(load(overrides))) for overrides in chosen],
    )
    if whole:
        made.captures = _captures()
        made.history = _history(folder)
    return made


def _without_clock(path):
    """The same log wherever and whenever it is made, so that an input can be made again."""
    log = RunLog.open(path)
    arrays = {name: log[name] for name in log.names if name != MODEL_PATH}
    attributes = {k: v for k, v in log.attributes.items() if k not in WRITER_ATTRIBUTES}
    fixed = {"wall_time": 1.0, "git_commit": "0" * 40, "git_dirty": False}
    fixed["machine"] = {"platform": "none", "cpu": "none", "cores": 1}
    fixed["outcome"] = {**log.outcome, "real_time_factor": 1.0}
    write_run(path, arrays, model_xml=log.model_xml, attributes={**attributes, **fixed})
    path.with_name("summary.json").write_text(json.dumps(fixed["outcome"], indent=2))


def _captures():
    """Every kind of capture, of a second or two."""
    from captures import bvh_text, in_order
    from test_motion_files import AMC, ASF, STANDING

    rolling = [[1 / 60, *STANDING[1:]] for _ in range(30)]
    for i, row in enumerate(rolling):
        row[1] = 0.02 * i
    return {
        "m.bvh": bvh_text(in_order("forward_roll", 1.2, frames=40)).encode(),
        "m.asf": ASF.encode(),
        "m.amc": AMC.encode(),
        "m.json": json.dumps({"Loop": "wrap", "Frames": rolling}).encode(),
        **_robots_captures(),
    }


def _robots_captures():
    """A roll as joints of a model, with the model, and as rotation vectors."""
    from captures import adult, in_order

    roll = in_order("forward_roll", 1.2, frames=40)
    table = np.hstack([roll[:, :3], np.roll(roll[:, 3:7], -1, axis=1), roll[:, 7:]])
    joints, vectors = io.BytesIO(), io.BytesIO()
    np.savez(joints, qpos=roll, frequency=60.0)
    np.savez(vectors, poses=np.tile([0.1, 1.0, 0.2], (40, 22)), trans=roll[:, :3], fps=60)
    return {
        "m.csv": "\n".join(",".join(f"{x:.5f}" for x in row) for row in table).encode(),
        "m.npz": joints.getvalue(),
        "n.npz": vectors.getvalue(),
        "m.xml": adult().mjcf.encode(),
    }


def _history(folder):
    """The history of a small search."""
    from here import Here

    from rotctl.tune.search import Watch, prepare, tune

    (folder / "s.yaml").write_text(SPACE)
    (folder / "search").mkdir()
    search, budget = prepare(str(folder / "s.yaml"), [], 0, None, 4, None)
    tune(search, folder / "search", budget, Here(), Watch(lambda line: None, lambda: None))
    return Path(folder / "search" / "study.db")
