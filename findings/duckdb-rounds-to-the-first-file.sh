#!/usr/bin/env bash
# DuckDB reads the results of many runs and rounds all times to whole seconds, because the first run fell at 3.
#
# Expected: Parquet files of which a column is whole in one and fractional in another are read as fractional, or refused, as by pyarrow and
#   Polars; a number that does not fit its column is no reason to change it.
# Happens: the type is that of the first file of the list, and what comes after is cast to it: 3.7 s becomes 4 and 0.4 s becomes 0.
#   Where the first file is a fractional one nothing is lost, and which is first goes by the names of the files. With union_by_name all
#   files are looked at first, and all is right.
# Seen with: duckdb 2.0.1; pyarrow 26.0.1 and polars 2.1.0 beside it. Its pull request 3238 brought it in.
# Means: JSON and YAML write 3.0 as 3, and a reader makes a whole number of it, so that the type of a column hangs on the run. A mean of rounded times
#   looks like one of times. Ask for union_by_name=true in every read of more than one file, or cast when writing.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check duckdb==2.0.1 pyarrow==26.0.1 polars==2.1.0
cd "$work"
"$work/venv/bin/python" - <<'PY'
import duckdb
import polars
import pyarrow as pa
import pyarrow.dataset
import pyarrow.parquet as pq

for seed, fell in enumerate([3, 3.7, 0.4]):  # s, as a reader of JSON gives them
    pq.write_table(pa.table({"seed": [seed], "fell_at": [fell]}), f"run{seed}.parquet")


def times(files, options=""):
    return [row[0] for row in duckdb.sql(f"SELECT fell_at FROM read_parquet({files}{options}) ORDER BY seed").fetchall()]


read = {
    "run*.parquet": times("'run*.parquet'"),
    "first run last": times("['run1.parquet', 'run2.parquet', 'run0.parquet']"),
    "union_by_name": times("'run*.parquet'", ", union_by_name = true"),
}
print("duckdb", duckdb.__version__, "- written: 3, 3.7 and 0.4 s")
for how, seen in read.items():
    print(f"{how:15s}", seen)
files = [f"run{seed}.parquet" for seed in range(3)]
for name, reader in (("pyarrow", lambda: pyarrow.dataset.dataset(files).to_table()), ("polars", lambda: polars.read_parquet(files))):
    try:
        print(f"{name:15s}", reader())
    except (pa.ArrowInvalid, polars.exceptions.SchemaError) as error:
        print(f"{name:15s} {type(error).__name__}: {str(error).splitlines()[0]}")
    else:
        raise SystemExit(f"CHANGED: {name} no longer refuses")
if read["run*.parquet"] != [3, 4, 0] or read["first run last"] != [3.0, 3.7, 0.4] or read["union_by_name"] != [3.0, 3.7, 0.4]:
    raise SystemExit("CHANGED: the times are no longer rounded to the type of the first file")
PY
