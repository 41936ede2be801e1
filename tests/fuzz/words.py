"""Words on the command line: overrides and options."""

import json
import shutil

from fuzz.case import Case
from fuzz.nasty import NUMBERS, text, value
from rotctl.choices import listing
from rotctl.settings.plain import dotted, leaves


def overrides(rng, samples, here):
    chosen, config = rng.choice(samples.configs)
    plain = [(dotted(way), json.dumps(value)) for way, value in leaves(config)]
    some = rng.choice((1, 1, 2, 4))
    given = [*chosen, *(_override(rng, *zip(*plain, strict=True)) for _ in range(some))]
    command = rng.choices(["show", "run", "sweep"], [6, 3, 2])[0]
    if command == "show":
        return Case(["show", *given])
    short = ["duration=0.05"] if rng.random() < 0.9 else []
    return Case([command, *given, *short, "--out", "o"], simulates=True)


SWEEPS = ("range(0,3)", "range(0,1e9)", "1,2", "glob(*)", "choice(a,b)", "{a: 1}", "[1,2,3]")


def _override(rng, keys, values):
    key = rng.choice((*keys, *keys, *listing.group_names(), text(rng)))
    if rng.random() < 0.2:
        at = rng.randrange(len(key) + 1)
        key = key[:at] + rng.choice((".", "@", "/", "[0]", text(rng)[:300], "x")) + key[at:]
    new = rng.choice((text(rng), json.dumps(value(rng)), rng.choice(values), rng.choice(SWEEPS)))
    sign = rng.choices(["", "+", "++", "~"], [8, 2, 1, 1])[0]
    return f"{sign}{key}={new}"[: rng.choice((40, 300, 20_000))].replace("\0", "?")


def options(rng, samples, here):
    shutil.copy(rng.choice(samples.logs), here / "run.h5")
    shutil.copytree(samples.sweep, here / "d")
    (here / "s.yaml").write_text(samples.space)
    for name, content in samples.captures.items():
        (here / name).write_bytes(content)
    command = list(rng.choice(OPTIONS))
    for _ in range(rng.choice((1, 1, 2))):
        at = rng.randrange(1, len(command) + 1)
        new = rng.choice((text(rng), rng.choice(NUMBERS), rng.choice(WORDS)))
        if at < len(command) and not command[at].startswith("--") and rng.random() < 0.9:
            command[at] = new
        else:
            command.insert(at, new)
    for i, word in enumerate(command):  # what would leave the folder at our own wish
        if word.startswith(("/", "..", "~")) and command[i - 1].startswith("--"):
            command[i] = "x"
    return Case([word.replace("\0", "?") for word in command], simulates=True)


def environment(rng, samples, here):
    shutil.copy(rng.choice(samples.logs), here / "run.h5")
    new = rng.choice((text(rng), rng.choice(BACKENDS))).replace("\0", "?")
    return Case(list(rng.choice(ANYWHERE)), simulates=True, environ={rng.choice(READ): new})


WORDS = (
    *("run.h5", "d", ".", "..", "/", "no/x.png", "/dev/null", "--x", "--", "-", "d/x.png"),
    *("a?b=c", "0:1", "1:0"),
)
READ = ("MUJOCO_GL", "MUJOCO_GL", "COLUMNS", "TERM", "OPENBLAS_NUM_THREADS", "PYTHONWARNINGS")
BACKENDS = ("osmesa", "egl", "glfw", "disable", "off", "1", "EGL ", "wgl", "bogus")
ANYWHERE = (
    ["run", "duration=0.05", "--out", "o", "--filmstrip"],
    ["render", "run.h5", "--filmstrip", "x.png", "--frames", "1"],
    ["plot", "run.h5", "--out", "x.png"],
    ["list"],
    ["sweep", "--help"],
)
OPTIONS = (
    ["run", "duration=0.05", "--out", "o", "--json"],
    ["render", "run.h5", "--filmstrip", "x.png", "--frames", "2", "--from", "0", "--to", "0.1"],
    ["render", "run.h5", "--video", "x.mp4", "--from", "0", "--to", "0.05"],
    ["replay", "run.h5", "--html", "x.html", "--compare", "run.h5"],
    ["plot", "run.h5", "--out", "x.svg", "--from", "0", "--to", "0.1"],
    ["inspect", "run.h5"],
    ["verify", "run.h5", "--json"],
    ["run", "duration=0.05", "--out", "o", "--force", "--filmstrip", "--quiet"],
    ["run", "--again", "run.h5", "--out", "o"],
    ["list"],
    ["show", "seed=1"],
    ["bench", "--repeats", "1", "--plot", "x.svg"],
    ["sweep", "seed=0", "duration=0.05", "--out", "o", "--jobs", "1", "--retries", "1"],
    ["sweep", "seed=0", "duration=0.05", "--out", "d", "--strict", "--dry-run", "--quiet"],
    ["sweep", "seed=0", "duration=0.05", "--out", "o", "--scheduler", "tcp://127.0.0.1:1"],
    ["summarise", "d", "--by", "seed", "--mixed"],
    ["report", "d", "--out", "o", "--against", "d"],
    ["tune", "s.yaml", "--out", "o", "--trials", "4", "--seed", "0", "--sampler", "tpe"],
    ["tune", "s.yaml", "--out", "o", "--minutes", "0.01"],
    ["import-motion", "m.bvh", "--out", "c.yaml", "--cycle", "0:1", "--rate", "60"],
    ["import-motion", "m.amc", "--out", "c.yaml", "--skeleton", "m.asf", "--licence", "x"],
    ["import-motion", "m.json", "--out", "c.yaml", "--symmetric", "--character", "adult"],
    ["import-motion", "m.bvh", "--out", "c.yaml", "--up", "y", "--map", "left_hip=LeftUpLeg"],
    ["import-motion", "m.csv", "--out", "c.yaml", "--model", "m.xml", "--cycle", "0:0.5"],
    ["inspect-model", "m.xml", "--out", "c.yaml", "--map", "hips=pelvis"],
    ["export", "run.h5", "--to", "gltf", "--out", "x.glb"],
    ["export", "run.h5", "--to", "mjcf"],
    ["new", "behaviour", "mine", "--from", "land"],
    ["--config-dir", "d", "ls", "d"],
    ["diff", "d", "run.h5"],
    ["author-motion", "s.yaml", "--out", "c.yaml", "--character", "adult"],
    ["preview-motion", "forward_roll", "--out", "x.png", "--frames", "2", "--character", "adult"],
)
