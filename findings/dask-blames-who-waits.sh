#!/usr/bin/env bash
# Dask says of a task that never began that four workers died while running it.
#
# Expected: KilledWorker, "Attempted to run task ... on 4 different workers, but all those workers died while running it",
#   names the task that kills; one that waits its turn is given to the next worker, and a worker of one thread has one task.
# Happens: a worker of one thread is sent two tasks, one to run and one to wait there (distributed.scheduler.worker-saturation
#   is 1.1, rounded up). Both are suspects when it dies, and both go to the next worker in the same order, so that the second
#   dies with the first each time and is given up after as many deaths, with the same words. It was never begun.
# Seen with: distributed 2026.8.0, with its own settings, one worker of one thread.
# Means: of a sweep with one run that kills its worker a harmless one is missing, too, and blamed. worker-saturation 1.0 sends no
#   more than threads; with several threads, what runs beside the killer is blamed still: try each suspect by itself.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check distributed==2026.8.0 dask==2026.8.0
cd "$work"
cat >tasks.py <<'PY'
import logging
import os
import signal
import time
from pathlib import Path

import dask
from distributed import Client, KilledWorker, LocalCluster


def work(name):
    Path(name).touch()
    if name == "kills":
        time.sleep(0.5)  # s, until the others have been handed out
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


def blamed(saturation):
    """The names of those that Dask gives up on, and of those that were begun."""
    names = ["kills", "second", "third", "fourth"]
    with (
        dask.config.set({"distributed.scheduler.worker-saturation": saturation}),
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL) as cluster,
        Client(cluster) as client,
    ):
        found = []
        for name, future in zip(names, client.map(work, names, pure=False), strict=True):
            try:
                future.result(timeout=60)
            except KilledWorker as error:
                found.append(name)
                print(f"  {name:7}: {str(error).partition('. ')[0]}".replace(future.key, "..."))
    begun = [name for name in names if Path(name).exists()]
    print("  begun  :", ", ".join(begun))
    for name in begun:
        Path(name).unlink()
    return found, begun


if __name__ == "__main__":
    logging.disable(logging.CRITICAL)
    print("distributed", __import__("distributed").__version__, "- four tasks, of which the first kills its worker")
    print("as it is:")
    usual = blamed(dask.config.get("distributed.scheduler.worker-saturation"))
    print("worker-saturation 1.0:")
    less = blamed(1.0)
    if usual != (["kills", "second"], ["kills", "third", "fourth"]) or less[0] != ["kills"]:
        raise SystemExit("CHANGED: who waits behind a task that kills is not given up with it")
PY
"$work/venv/bin/python" -W ignore tasks.py
