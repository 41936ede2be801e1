#!/usr/bin/env bash
# To Arrow a direction of 0 and one of -0 degrees are equal, and two groups.
#
# Expected: 0.0 and -0.0 are equal, and a group, a set, a join and a count of distinct values go by equality, as in pandas, DuckDB and Polars.
# Happens: pyarrow's `equal` says that they are; group_by, unique, value_counts, is_in and join look at bits and keep them apart. A table has three
#   runs with way == 0 and one with way in [0], also as filters of a Parquet file. pandas on Arrow's types is between both: of
#   three directions nunique counts 4, isin misses the -0, and drop_duplicates leaves 3.
# Seen with: pyarrow 26.0.1, pandas 3.1.1 (double[pyarrow]).
# Means: -0 comes from mirroring: the middle of a fan of directions times -1, a yaw times a side, round(-0.2). A success rate by direction is
#   split in two, of which a plot shows the one on top, and a join loses rows. Nothing prints otherwise than "-0.0". Add 0.0 to such columns
#   before they are keys.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyarrow==26.0.1 pandas==3.1.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

way = np.append(np.array([-90.0, 0.0, 90.0]) * -1.0, [0.0, -0.0])  # mirrored: 90, -0, -90; and two more
runs = pa.table({"way": way, "success": [1.0, 0.0, 1.0, 1.0, 0.0]})
names = pa.table({"way": [-90.0, 0.0, 90.0], "name": ["right", "ahead", "left"]})
pq.write_table(runs, "runs.parquet")
frame = runs.to_pandas().astype({"way": "double[pyarrow]"})
seen = {
    "rows that equal 0": pc.sum(pc.equal(runs["way"], 0.0)).as_py(),
    "Parquet rows, filter way = 0": pq.read_table("runs.parquet", filters=[("way", "=", 0.0)]).num_rows,
    "Parquet rows, filter way in [0]": pq.read_table("runs.parquet", filters=[("way", "in", [0.0])]).num_rows,
    "groups": runs.group_by("way").aggregate([("success", "mean")]).num_rows,
    "distinct": len(pc.unique(runs["way"])),
    "without a name after a join": runs.join(names, "way")["name"].null_count,
    "pandas on Arrow, nunique": int(frame["way"].nunique()),
    "pandas on Arrow, drop_duplicates": len(frame.drop_duplicates("way")),
    "pandas on Arrow, isin [0]": int(frame["way"].isin([0.0]).sum()),
    "pandas on its own, groups": runs.to_pandas()["way"].nunique(),
}
print("pyarrow", pa.__version__, "pandas", pd.__version__)
for name, count in seen.items():
    print(f"{name:34s} {count}")
if list(seen.values()) != [3, 3, 1, 4, 4, 2, 4, 3, 1, 3]:
    raise SystemExit("CHANGED: other counts")
PY
