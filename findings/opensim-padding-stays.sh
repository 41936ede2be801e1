#!/usr/bin/env bash
# Low-pass filtered with padding by OpenSim, a clip of one second lasts two and begins half a second before its start.
#
# Expected: padData=True extends the data for the filter's sake and cuts them back, as scipy's filtfilt does.
# Happens: the padding stays in the table, half the number of rows before and again after: 101 rows from 0 to 1 s come back
#   as 201 from -0.5 to 1.5 s, the motion mirrored at its first and last point. Without padding the rows are kept.
# Seen with: opensim 4.6, TableUtilities.filterLowpass.
# Means: row 0 is no longer the first frame: whoever joins the table to forces of the same clip by rows is off by half its
#   length, and one somersault becomes two. An inverse dynamics of it has two seconds of torques, half of them for a
#   motion that nobody made. Trim the table to the clip's own times afterwards.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check opensim==4.6 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import opensim

opensim.Logger.setLevelString("Off")
RATE, ROWS, CUT_OFF = 100, 101, 6.0


def clip():
    """A body that turns by 360 degrees in a second."""
    table = opensim.TimeSeriesTable()
    table.setColumnLabels(["pitch"])
    for row in range(ROWS):
        table.appendRow(row / RATE, opensim.RowVector([360.0 * row / RATE]))
    return table


print("opensim", version("opensim"), f"- {ROWS} rows from 0 to 1 s, 0 to 360 degrees")
seen = {}
for padded in (False, True):
    table = clip()
    opensim.TableUtilities.filterLowpass(table, CUT_OFF, padded)
    times, pitch = table.getIndependentColumn(), table.getDependentColumn("pitch")
    seen[padded] = table.getNumRows(), round(times[0], 6), round(times[-1], 6), round(pitch[0]), round(pitch[table.getNumRows() - 1])
    print("padded={}: {} rows from {} to {} s, {} to {} degrees".format(padded, *seen[padded]))
table.trim(0, 1)
print(f"padded and trimmed: {table.getNumRows()} rows")
if seen[False][:3] != (ROWS, 0, 1):
    raise SystemExit("CHANGED: the rows are not kept without padding")
if seen[True][:3] != (2 * ROWS - 1, -0.5, 1.5) or table.getNumRows() != ROWS:
    raise SystemExit("CHANGED: the padding is cut off again")
PY
