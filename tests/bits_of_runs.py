"""A process of its own: runs configs, and prints what all they made comes down to."""

import hashlib
import importlib
import json
import sys
from dataclasses import replace
from pathlib import Path

from rotctl.config.schema import check
from rotctl.log import collect
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise


def digest(config):
    """SHA-256 of every array of a run and of its summary row, and the fallbacks it took."""
    scenario = build(config)
    buffer, breakdown = in_memory(scenario)
    arrays = buffer.arrays()
    summary = summarise(scenario, buffer, breakdown, wall=1.0)
    assert not breakdown, breakdown
    content = hashlib.sha256(scenario.model.mjcf.encode())
    for name in sorted(arrays):
        content.update(name.encode() + arrays[name].tobytes())
    content.update(json.dumps(summary | {"real_time_factor": 0}).encode())
    return content.hexdigest(), int(arrays["solver/fallback"].sum())


def main():
    """From stdin: what to run, for how long [s], and the library to use, if not the one built."""
    order = json.load(sys.stdin)
    if order["library"]:
        native = importlib.import_module("rotctl.native.library")
        native.LIBRARY = Path(order["library"])
        assert native.library()
    runs = {
        name: digest(replace(check(config), duration=order["duration"]))
        for name, config in order["configs"].items()
    }
    json.dump({"blas": collect()["machine"]["blas"], "runs": runs}, sys.stdout)


if __name__ == "__main__":
    main()
