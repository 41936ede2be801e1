"""Logs: bytes, content under a right checksum, and objects that do not belong there."""

import json
import os
import shutil

import h5py
import numpy as np
import yaml

from fuzz.case import Case, other
from fuzz.nasty import NUMBERS, changed, dumped, mangled, text
from rotctl.log import RunLog, write_run
from rotctl.log.schema import MODEL_PATH, WRITER_ATTRIBUTES

MODEL_PARTS = (
    '<hfield name="x" nrow="1024" ncol="1024" size="1 1 1 1"/>',
    '<texture name="x" type="2d" builtin="flat" width="1024" height="1024"/>',
    '<texture name="x" builtin="flat" width="400" height="400"/>',
    "<body><freejoint/><geom size='1'/></body>",
    "<body><joint type='ball'/><geom size='1'/>",
    "</body>",
    "<geom size='nan'/>",
    "<geom type='box' size='1 1 1' pos='1e300 0 0'/>",
    "<site/>",
    "<light/>",
    "<include file='../outside/secret'/>",
    "<mesh name='x' file='../outside/secret'/>",
    "<option timestep='0' gravity='nan 0 0'/>",
    "<!-- x -->",
    "<a/>",
)
ATTRIBUTES = (1, -1, "x", b"x", 1.5, [1, 2], np.nan, "\x1b[31m", h5py.Empty("f8"), "")
HARM = ("gone", "soft", "external", "shape", "type", "group", "empty", "attribute", "attribute")


def log_bytes(rng, samples, here):
    (here / "run.h5").write_bytes(mangled(rng, rng.choice(samples.logs).read_bytes()))
    return _with_a_log(rng, here)


def log_content(rng, samples, here):
    """A log with a right checksum: other arrays, attributes, outcome, config or model."""
    whole = RunLog.open(rng.choice(samples.logs))
    arrays = {name: whole[name] for name in whole.names if name != MODEL_PATH}
    attributes = {k: v for k, v in whole.attributes.items() if k not in WRITER_ATTRIBUTES}
    model = whole.model_xml
    for _ in range(rng.choice((1, 1, 2))):
        what = rng.choice(("array", "array", "outcome", "config", "model", "model", "attribute"))
        if what == "array":
            name = rng.choice(list(arrays))
            arrays[name] = _numbers(rng, arrays[name])
        elif what == "outcome":
            attributes["outcome"] = json.dumps(changed(rng, whole.outcome))
        elif what == "config":
            data = changed(rng, yaml.safe_load(whole.config_yaml))
            attributes["config"] = dumped(rng, data).decode("utf-8", "replace").replace("\0", "?")
        elif what == "model":
            model = _model(rng, model)
        else:
            name = rng.choice(("run_id", "git_commit", "versions", "machine", "seed", "wall_time"))
            old = attributes[name]
            attributes[name] = (
                rng.choice((0, -1, 2**62))
                if name == "seed"
                else (float("nan") if name == "wall_time" else text(rng).replace("\0", "?"))
            )
            attributes[name] = type(old)(attributes[name])
    write_run(here / "run.h5", arrays, model_xml=model.replace("\0", "?"), attributes=attributes)
    return _with_a_log(rng, here)


def log_structure(rng, samples, here):
    """A log with objects of HDF5 that do not belong there, or are gone."""
    shutil.copy(rng.choice(samples.logs), here / "run.h5")
    with h5py.File(here / "run.h5", "r+") as file:
        for _ in range(rng.choice((1, 1, 3))):
            name = rng.choice(_datasets(file))
            how = rng.choice(HARM)
            if how == "attribute":
                owner = rng.choice((file, file[name]))
                owner.attrs[rng.choice((*owner.attrs, "x"))] = rng.choice(ATTRIBUTES)
                continue
            about, shape, kind = dict(file[name].attrs), file[name].shape, file[name].dtype
            del file[name]
            if how == "soft":
                file[name] = h5py.SoftLink(rng.choice(("/trajectory/qpos", "/nothing", "/")))
            elif how == "external":
                file[name] = h5py.ExternalLink("../outside/secret", "x")
            elif how == "group":
                file.create_group(name)
            elif how == "empty":
                file.create_dataset(name, data=h5py.Empty("f8")).attrs.update(about)
            elif how in ("shape", "type"):
                if how == "shape":
                    shape = tuple(rng.choice((0, 1, n, n + 1, 10**6)) for n in shape)
                else:
                    kind = rng.choice(("f4", "i8", "S5", "c16", "?"))
                chunks = tuple(min(n, 4) for n in shape) if shape and all(shape) else None
                file.create_dataset(name, shape, kind, chunks=chunks).attrs.update(about)
    return _with_a_log(rng, here)


def _datasets(file):
    """Names of what is in the groups, and of the scales beside them, but for harmed links."""
    names = []
    for top in filter(file.__contains__, file):
        group = isinstance(file[top], h5py.Group)
        names += [f"{top}/{leaf}" for leaf in file[top]] if group else [top]
    return list(filter(file.__contains__, names))


def _with_a_log(rng, here):
    if rng.random() < 0.03:
        other(rng, here / "run.h5", here)
    command = rng.choices(
        ["inspect", "replay", "plot", "strip", "summarise", "report", "verify", "again", "video"]
        + ["export"],
        [30, 25, 12, 6, 12, 5, 5, 4, 1, 10],
    )[0]
    if command in ("summarise", "report"):
        (here / "d" / "x").mkdir(parents=True)
        os.rename(here / "run.h5", here / "d" / "x" / "run.h5")
        return Case([command, "d"], drawn=rng.choice((0, 0, 1)))
    if command == "strip":
        return Case(["render", "run.h5", "--filmstrip", "x.png", "--frames", "2"])
    if command == "export":
        return Case(["export", "run.h5", "--to", rng.choice(("bvh", "csv", "npz", "gltf", "mjcf"))])
    if command == "video":
        return Case(["render", "run.h5", "--video", "x.mp4"])
    if command == "again":
        return Case(["run", "--again", "run.h5", "--out", "o"], simulates=True)
    return Case([command, "run.h5"], simulates=command == "verify")


def _numbers(rng, array):
    array = array.copy()
    if not array.size:
        return array
    kind = array.dtype.kind
    if kind == "S":
        some = [b"", b"\xff\xfe", b"\x1b[31m", b"a" * array.dtype.itemsize, b"$x^2$"]
    elif kind == "f":
        some = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1.0, -1.0, 1e308, -1e308, 1e30, 1e-308, 1e5]
    elif kind == "b":
        some = [True, False]
    else:
        some = [np.iinfo(array.dtype).min, np.iinfo(array.dtype).max, -1, 0, 1]
    new = rng.choice(some)
    with np.errstate(all="ignore"):
        if rng.random() < 0.3:
            array[...] = new
        elif rng.random() < 0.5:
            array[rng.randrange(len(array)) if array.ndim else ()] = new
        else:
            array.flat[rng.randrange(array.size)] = new
    return array


def _model(rng, model):
    how = rng.choice(("bytes", "number", "number", "part", "many"))
    if how == "bytes":
        return mangled(rng, model.encode()).decode("utf-8", "replace")
    if how == "number":
        pieces = model.split('"')
        pieces[rng.randrange(1, len(pieces), 2)] = (
            rng.choice(
                (rng.choice(NUMBERS), " ".join(rng.choices(NUMBERS, k=3)), text(rng), "1 1 1")
            )
            .replace("<", "&lt;")
            .replace("&x", "&amp;x")
        )
        return '"'.join(pieces)
    part = rng.choice(MODEL_PARTS) * (1 if how == "part" else rng.choice((10, 400, 3000, 30_000)))
    at = rng.choice([i + 1 for i, c in enumerate(model) if c == ">"])
    return model[:at] + part + model[at:]
