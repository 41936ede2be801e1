#!/usr/bin/env bash
# A run that never falls, logged to MLflow with a time of infinity, falls after 1.8e308 seconds.
#
# Expected: log_metric takes a float. Infinity is kept, as NaN is, or refused, as other values are that the store can't hold.
# Happens: infinity comes back as the largest finite number, without a word. isinf is false, so that runs that never fell are not found as such, and
#   their mean with nine others is 1.8e307 s. Two of them give infinity again, by overflow. NaN in the same column comes back as NaN.
# Seen with: mlflow-skinny 3.17.2 on SQLite; the documentation of log_metric says that stores on SQLAlchemy may do so.
# Means: time to the first fall, the cost of a failed run and ratios are infinite in the ordinary course of things, and medians and ranks are right
#   with them. Means, charts and tests for infinity are not. Log as a metric of its own whether the run fell, and the time only where it did.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mlflow-skinny==3.17.2 sqlalchemy==2.1.9 alembic==1.20.1 pandas==3.1.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import logging
import math
from importlib.metadata import version

logging.disable(logging.CRITICAL)

import mlflow
import numpy as np

TIMES = {"falls": 2.5, "never falls": math.inf, "not simulated": math.nan}
mlflow.set_tracking_uri("sqlite:///runs.db")
experiment = mlflow.create_experiment("rolls")
client = mlflow.MlflowClient()
for name, time in TIMES.items():
    client.log_metric(client.create_run(experiment, run_name=name).info.run_id, "time_of_fall", time)
back = {run.info.run_name: run.data.metrics["time_of_fall"] for run in client.search_runs([experiment])}
print("mlflow", version("mlflow-skinny"))
for name, time in TIMES.items():
    print(f"{name}: logged {time}, read {back[name]}, infinite: {math.isinf(back[name])}")
mean = float(np.mean([back["never falls"]] + 9 * [back["falls"]]))
print(f"mean of one that never falls and nine others: {mean:.2e}, expected inf")
orders = {way: [run.info.run_name for run in client.search_runs([experiment], order_by=[f"metrics.time_of_fall {way}"])] for way in ("ASC", "DESC")}
print("in order:", orders)
if back["falls"] != 2.5 or not math.isnan(back["not simulated"]) or any(names[-1] != "not simulated" for names in orders.values()):
    raise SystemExit("CHANGED: other values come back or are ordered in another way")
if math.isinf(back["never falls"]) or back["never falls"] != np.finfo(float).max or math.isinf(mean):
    raise SystemExit("CHANGED: infinity is kept")
PY
