#!/usr/bin/env bash
# Append today's runs to a Parquet file with fastparquet: yesterday's controllers have today's names, and times of 3.7 and 0.4 s are 3 and 0.
#
# Expected: append=True is refused where columns don't fit those of the file, as it is where one is missing; columns in another order are put in order by name. What was
#   in the file stays.
# Happens: types are not compared. Into a column of whole numbers fractions go without their fraction and large ones modulo 256, for a column of int8. Of a column of categories each
#   part of the file has its own list, and on reading the list of the last part is taken for all: rows of "kick" and "tuck" read "pike" and "straight" after rows of
#   those two were appended. A later part with fewer names than an earlier one can't be read with it. Read part by part all names are right. Neither writing nor reading says anything.
# Seen with: fastparquet 2026.9.0, pandas 3.1.1, one file and a folder of files alike. Its issue 949, open since 2025, tells of categories; of the fractions none was found.
# Means: a table of results grows run by run. Times that happened to be whole on the first day make the column whole for ever, and means too short by half a second.
#   Names are categories where memory is short, and a list with as many of them shows nothing. Cast to float and text before each append, or write a file for each day.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check fastparquet==2026.9.0 pandas==3.1.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import fastparquet
import numpy as np
import pandas as pd

SCHEMES = ("simple", "hive")


def grown(scheme, *tables):
    """A Parquet file to which one table after the other was appended."""
    path = f"{scheme}-{grown.count}.parquet"
    grown.count += 1
    fastparquet.write(path, tables[0], file_scheme=scheme)
    for table in tables[1:]:
        fastparquet.write(path, table, file_scheme=scheme, append=True)
    return fastparquet.ParquetFile(path)


grown.count = 0


def runs(*names):
    return pd.DataFrame({"controller": pd.Categorical(names)})


print("fastparquet", version("fastparquet"), "pandas", version("pandas"))
for scheme in SCHEMES:
    times = grown(scheme, pd.DataFrame({"time": [3, 12]}), pd.DataFrame({"time": [3.7, 0.4]})).to_pandas()["time"].tolist()
    falls = grown(scheme, pd.DataFrame({"falls": np.array([1, 2], "int8")}), pd.DataFrame({"falls": [300]})).to_pandas()["falls"].tolist()
    file = grown(scheme, runs("kick", "tuck"), runs("pike", "straight"))
    names = file.to_pandas()["controller"].astype(str).tolist()
    parts = [part.to_pandas()["controller"].astype(str).tolist() for part in (file[0], file[1])]
    print(f"{scheme}: times 3, 12 and 3.7, 0.4 are {times}; falls 1, 2 and 300 are {falls}; names kick, tuck and pike, straight are {names}, part by part {parts}")
    if times != [3, 12, 3, 0] or falls != [1, 2, 44]:
        raise SystemExit("CHANGED: numbers are appended otherwise")
    if names != 2 * ["pike", "straight"] or parts != [["kick", "tuck"], ["pike", "straight"]]:
        raise SystemExit("CHANGED: names are read otherwise")
    try:
        fewer = grown(scheme, runs("kick", "pike", "tuck"), runs("tuck")).to_pandas()["controller"].tolist()
    except IndexError as error:
        fewer = f"IndexError: {error}"
    print("    fewer names in the later part:", fewer)
    if not str(fewer).startswith("IndexError"):
        raise SystemExit("CHANGED: fewer names can be read")
    two = pd.DataFrame({"hip": [1.0], "knee": [2.0]})
    if grown(scheme, two, two[["knee", "hip"]]).to_pandas().to_dict("list") != {"hip": [1, 1], "knee": [2, 2]}:
        raise SystemExit("CHANGED: another order of columns is not put right")
PY
