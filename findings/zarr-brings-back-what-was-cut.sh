#!/usr/bin/env bash
# Cut a Zarr log back to a checkpoint and make room for more: what was cut off is there again, as far as its chunk goes.
#
# Expected: an array that is made shorter forgets the rest, and one that is made longer has its fill value there, NaN say, as in HDF5; chunks
#   are a matter of speed.
# Happens: chunks that lie wholly outside are deleted, the one that is cut keeps all that it holds. Ten samples in chunks of eight, cut to three
#   and made twelve, are 0 to 7 and four NaN; with chunks of one sample, or in HDF5, 0 to 2 and nine NaN.
# Seen with: zarr 3.1.6, Array.resize, formats 2 and 3; h5py 3.16.0 for comparison. Its issue 1017 asks whether it is meant.
# Means: a run that is taken up again from a checkpoint, in a log with room made beforehand, is followed by some seconds of the future that it
#   did not have. Who looks for the end by the first NaN finds it too late, and a crash after the checkpoint leaves both runs in one
#   array. Write the fill value over what is to go before making the array shorter.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check zarr==3.1.6 h5py==3.16.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import h5py
import numpy as np
import zarr


def cut_and_grown(log):
    log[:] = np.arange(10.0)
    log.resize((3,))
    log.resize((12,))
    return log[:]


print("zarr", zarr.__version__, "h5py", h5py.__version__, "- samples 0 to 9, cut to three, then made twelve")
seen = {}
for chunk in (8, 4, 1):
    for version in (2, 3):
        log = zarr.create_array(f"{chunk}_{version}.zarr", shape=(10,), chunks=(chunk,), dtype="f8", fill_value=np.nan, zarr_format=version)
        seen[f"Zarr {version}", chunk] = cut_and_grown(log)
    with h5py.File(f"{chunk}.h5", "w") as file:
        seen["HDF5", chunk] = cut_and_grown(file.create_dataset("log", (10,), "f8", chunks=(chunk,), maxshape=(None,), fillvalue=np.nan))
kept = {}
for (library, chunk), values in seen.items():
    kept[library, chunk] = int(np.isfinite(values).sum())
    print(f"{library}, chunks of {chunk}: {values}")
if any(kept[f"Zarr {version}", chunk] != left for version in (2, 3) for chunk, left in ((8, 8), (4, 4), (1, 3))):
    raise SystemExit("CHANGED: the chunk that is cut no longer decides")
if any(kept["HDF5", chunk] != 3 for chunk in (8, 4, 1)):
    raise SystemExit("CHANGED: HDF5 no longer forgets")
PY
