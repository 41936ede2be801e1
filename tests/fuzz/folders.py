"""Folders of sweeps, and earlier reports."""

import json
import shutil
import zlib

import yaml

from fuzz.case import Case, other
from fuzz.nasty import changed, dumped, mangled, text


def sweep(rng, samples, here):
    shutil.copytree(samples.sweep, here / "d")
    files = [path for path in sorted((here / "d").rglob("*")) if path.is_file()]
    files += [here / "d" / name for name in ("sweep.jsonl", "runs.jsonl", "experiment-x.yaml")]
    for path in dict.fromkeys(rng.choices(files, k=rng.choice((1, 1, 2)))):
        if rng.random() < 0.25:
            other(rng, path, here)
        elif path.name == "sweep.jsonl" and rng.random() < 0.6:
            lines = [json.loads(line) for line in samples.manifest.splitlines()]
            changed(rng, rng.choice(lines))
            lines += [rng.choice(lines)] * rng.choice((0, 0, 1, 50))
            path.write_bytes(b"".join(json.dumps(line).encode() + b"\n" for line in lines))
        elif path.name == "runs.jsonl" and rng.random() < 0.6:
            path.write_bytes(b"".join(_rows(rng, path.read_bytes())))
        elif path.suffix == ".yaml" and rng.random() < 0.6:
            path.write_bytes(dumped(rng, changed(rng, yaml.safe_load(samples.experiment))))
        else:
            path.write_bytes(mangled(rng, path.read_bytes()))
    for _ in range(rng.choice((0, 0, 1))):
        name = rng.choice(("sweep.lock", "sweep.jsonl.part", "summary.csv", "summary.csv.part",
                           "groups.csv", "experiment-y.yaml", "x/run.h5", "run.h5"))  # fmt: skip
        (here / "d" / name).parent.mkdir(exist_ok=True)
        other(rng, here / "d" / name, here)
    commands = {"summarise": 40, "report": 30, "sweep": 15, "judge": 10, "by": 5}
    command = rng.choices([*commands], [*commands.values()])[0]
    if command == "sweep":
        return Case(["sweep", *samples.overrides, "--out", "d"], simulates=True)
    if command == "judge":
        own = ["--metric", "m=max(com[:, 2])"]
        by = rng.choice((["criteria.stall_time=1"], ["criteria=standing"], own))
        return Case(["judge", "d", *by])
    if command == "by":
        return Case(["summarise", "d", "--by", f"behaviour,{text(rng)}".replace("\0", "?")])
    into = rng.choice((["--out", "o"], ["--out", "d"], []))
    return Case([command, "d", *(into if command == "report" else [])], drawn=rng.random() < 0.04)


def _rows(rng, content):
    """The lines of an index, of which one says something else under a checksum that fits."""
    lines = content.splitlines(keepends=True)
    i = rng.randrange(len(lines))
    data = json.loads(lines[i])
    del data["crc"]
    changed(rng, data)
    body = b'", ' + json.dumps(data).encode()[1:]
    lines[i] = b'{"crc": "%08x' % zlib.crc32(body) + body + b"\n"
    return lines


def against(rng, samples, here):
    content = mangled(rng, samples.claims.encode())
    (here / "claims.csv").write_bytes(content)
    if rng.random() < 0.2:
        other(rng, here / "claims.csv", here)
    (here / "none").mkdir()
    folder = samples.sweep if rng.random() < 0.1 else "none"
    return Case(["report", str(folder), "--out", "o", "--against", "claims.csv"])
