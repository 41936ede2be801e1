#!/usr/bin/env bash
# A minute of muscle signals at 2148.148 Hz, written by pyEDFlib, lasts a day and a half.
#
# Expected: EDF has no field for a rate, but for the length of a record and the samples in it; a writer that is given a rate finds a pair that
#   makes it, to a millionth or so as the length has eight characters, or says that it found none, as this one does of rates that cannot go together.
# Happens: 2148.148 and 1925.926 Hz, which are rates of EMG sensors that are sold, become 1 Hz: one sample to a record of one second. 1259.259
#   becomes 1260.504, 59 ms off after a minute. With a digit more 1259.2593 and 2148.1481 are right to 0.1 and 4 ms, and fractions,
#   58000/27 for the latter or a camera's 60/1.001, are exact. No error, no warning; the samples are all there.
# Seen with: pyEDFlib 0.1.42, EdfWriter.setSignalHeaders with sample_frequency.
# Means: signals of muscles that are laid beside the motion by their times are drawn out or slip. Read the rate back after writing
#   (getSampleFrequency), or set the length of a record yourself.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyedflib==0.1.42 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W error - <<'PY'
from importlib.metadata import version

import numpy as np
import pyedflib

SECONDS = 60
print("pyEDFlib", version("pyEDFlib"), f"- {SECONDS} s of one signal")
lasts = {}
for rate in (1259.259, 1925.926, 2148.148, 1259.2593, 2148.1481, 58000 / 27, 148.148, 60 / 1.001):
    samples = np.sin(np.arange(int(rate * SECONDS)))
    with pyedflib.EdfWriter("emg.edf", 1, file_type=pyedflib.FILETYPE_EDFPLUS) as file:
        file.setSignalHeaders([pyedflib.highlevel.make_signal_header("EMG", dimension="mV", sample_frequency=rate, physical_min=-2, physical_max=2)])
        file.writeSamples([samples])
    with pyedflib.EdfReader("emg.edf") as file:
        told, kept = file.getSampleFrequency(0), np.abs(file.readSignal(0)[: len(samples)] - samples).max() < 1e-3
        record = f"{file.samples_in_datarecord(0)} in {file.datarecord_duration} s"
    lasts[rate] = SECONDS * rate / told
    print(f"{rate:11.6f} Hz: {record:17s} = {told:11.6f} Hz, a minute lasts {SECONDS * rate / told:10.3f} s; all samples kept: {kept}")
    if not kept:
        raise SystemExit("CHANGED: samples are lost")
if not lasts[2148.148] > 100_000 or not lasts[1925.926] > 100_000 or not 59.93 < lasts[1259.259] < 59.95:
    raise SystemExit("CHANGED: the rates are no longer lost")
if any(abs(lasts[rate] - SECONDS) > 0.01 for rate in (1259.2593, 2148.1481, 58000 / 27, 148.148, 60 / 1.001)):
    raise SystemExit("CHANGED: rates that were right no longer are")
PY
