#!/usr/bin/env bash
# Whether DuckDB counts a torque that is NaN among those above 5 depends on how the Parquet file was cut into row groups.
#
# Expected: DuckDB holds NaN to be greater than all numbers, its pull request 16962 says, so that a NaN is "> 5", wherever the table lies; the layout of a
#   file bears on the speed alone.
# Happens: a row group is skipped, or taken whole, by the smallest and greatest value that the writer noted, and pyarrow, as Parquet wants
#   it, leaves NaN out of these. In a group whose numbers are all below 5 the NaN is dropped from "> 5" and counted in "<= 5". In a group of
#   its own, where there is nothing to note, it is above 5, and so it is in memory and in a file by DuckDB, which then notes nothing.
# Seen with: duckdb 2.0.1, files by pyarrow 26.0.1; DuckDB's issue 25521 tells of it. Polars 2.1.0, which sorts NaN likewise, always counts one.
# Means: in a simulation NaN is what a run that blew up leaves behind. The number of runs over a limit changes when the file is written
#   again, or the limit moves. Ask isnan() as well.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check duckdb==2.0.1 pyarrow==26.0.1 polars==2.1.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import duckdb
import numpy as np
import polars
import pyarrow as pa
import pyarrow.parquet as pq

peaks = np.append(np.linspace(0.0, 3.0, 1000), np.nan)  # a thousand runs, and one that blew up
runs = pa.table({"peak": peaks})
pq.write_table(runs, "one_group.parquet")
pq.write_table(runs, "four_groups.parquet", row_group_size=250)  # and the NaN in a fifth
duckdb.sql("COPY (SELECT * FROM 'one_group.parquet') TO 'by_duckdb.parquet'")
print("duckdb", duckdb.__version__, "pyarrow", pa.__version__, "polars", polars.__version__)
counts = {}
for name in ("one_group", "four_groups", "by_duckdb"):
    ask = lambda where: duckdb.sql(f"SELECT count(*) FROM '{name}.parquet' WHERE {where}").fetchall()[0][0]
    peak = polars.scan_parquet(f"{name}.parquet").filter(polars.col("peak") > 5).collect()
    counts[name] = ask("peak > 5"), ask("peak <= 5"), len(peak)
    print(f"{name:12s} DuckDB: {counts[name][0]} above 5, {counts[name][1]} others; Polars: {counts[name][2]} above 5")
counts["memory"] = tuple(duckdb.sql(f"SELECT count(*) FROM runs WHERE peak {sign} 5").fetchall()[0][0] for sign in (">", "<="))
print("in memory    DuckDB: %d above 5, %d others" % counts["memory"])
if counts["one_group"] != (0, 1001, 1) or counts["four_groups"] != (1, 1000, 1) or counts["memory"] != (1, 1000):
    raise SystemExit("CHANGED: the row groups no longer decide")
PY
