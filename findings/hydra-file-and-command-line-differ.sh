#!/usr/bin/env bash
# Hydra reads a value on the command line by other rules than the same value in the YAML file.
#
# Expected: `key=VALUE` on the command line sets what `key: VALUE` in the file would; both are "YAML".
# Happens: the file is YAML 1.1, the command line a grammar of its own. `no` and `off` are false in the file and texts, so
#   true in a condition, on the command line; 1:30 is the number 90 against a text; 010 is 8 against a text; nan is a
#   text in the file and a number on the command line. All pass, where the key has no declared type.
# Seen with: hydra-core 1.3.8, omegaconf 2.3.1, PyYAML 6.0.3.
# Means: an experiment file moved into overrides, or a sweep over `push=no,yes`, runs other settings without an error.
#   Write true and false; give keys a type (a structured config turns a text `no` into False); never write times as 1:30.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check hydra-core==1.3.8 omegaconf==2.3.1 PyYAML==6.0.3
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
import os

WRITTEN = ("no", "off", "1:30", "010", "0x10", "nan", "true", "1e-3", "1_000")
print("hydra-core", version("hydra-core"), "omegaconf", version("omegaconf"))
seen = {}
with initialize_config_dir(os.getcwd(), version_base="1.3"):
    for written in WRITTEN:
        with open("config.yaml", "w") as file:
            file.write(f"value: {written}\nother: 0\n")
        in_file = compose("config").value
        given = compose("config", overrides=[f"other={written}"]).other
        seen[written] = in_file, given
        print(f"{written:6s} file {in_file!r:8} command line {given!r:8} {'' if repr(in_file) == repr(given) else '<- differ'}")
if seen["no"] != (False, "no") or seen["off"] != (False, "off") or seen["1:30"] != (90, "1:30") or seen["010"] != (8, "010"):
    raise SystemExit("CHANGED: file and command line read these values alike")
if seen["true"] != (True, True) or seen["1e-3"] != (0.001, 0.001):
    raise SystemExit("CHANGED: plain booleans and numbers are no longer read alike")
PY
