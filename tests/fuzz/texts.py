"""Text files: tune spaces, clips, key poses, captures, configs; and the history of a search."""

import shutil

import yaml

from fuzz.case import Case, other
from fuzz.nasty import changed, dumped, mangled
from rotctl.choices import config_folders, listing


def space(rng, samples, here):
    _text_file(rng, here / "s.yaml", samples.space, here)
    return Case(["tune", "s.yaml", "--out", "o", "--trials", "4"], simulates=True)


def history(rng, samples, here):
    (here / "s.yaml").write_text(samples.space)
    (here / "o").mkdir()
    (here / "o" / "study.db").write_bytes(mangled(rng, samples.history.read_bytes()))
    if rng.random() < 0.2:
        other(rng, here / "o" / rng.choice(("study.db", "study.db-journal", "history.txt")), here)
    return Case(["tune", "s.yaml", "--out", "o", "--trials", "4"], simulates=True)


def clip(rng, samples, here):
    _text_file(rng, here / "c.yaml", samples.clip, here)
    if rng.random() < 0.05:
        return Case(["preview-motion", "c.yaml", "--out", "x.png", "--frames", "2"])
    run = ["behaviour=reference_roll", "behaviour.reference.clip=./c.yaml", "duration=0.05"]
    return Case(["run", *run, "--out", "o"])


def keys(rng, samples, here):
    _text_file(rng, here / "k.yaml", samples.keys, here)
    return Case(["author-motion", "k.yaml", "--out", "c.yaml"])


def capture(rng, samples, here):
    name = rng.choice(list(samples.captures))
    for file, content in samples.captures.items():
        (here / file).write_bytes(content)
    (here / name).write_bytes(mangled(rng, samples.captures[name]))
    if rng.random() < 0.05:
        other(rng, here / name, here)
    if name == "m.xml" and rng.random() < 0.7:
        return Case(["inspect-model", "m.xml", "--out", "c.yaml"])
    file = {"m.asf": "m.amc", "m.xml": "m.csv"}.get(name, name)
    robot = ["--model", "m.xml"] if file in ("m.csv", "m.npz") else []
    return Case(["import-motion", file, "--out", "c.yaml", *robot])


def conf(rng, samples, here):
    shutil.copytree(config_folders.conf_dir(), here / "conf")
    groups = [here / "conf", *(here / "conf" / name for name in listing.group_names())]
    path = rng.choice(sorted(rng.choice(groups).glob("*.yaml")))
    _text_file(rng, path, path.read_text(), here)
    command = ["list"]
    if path.parent.name != "conf" and rng.random() < 0.7:
        group, name = path.parent.name, path.stem
        users = [chosen for chosen, data in samples.configs if _uses(data, group, name)]
        choice = rng.choice(users) if users else []
        if not any(word.startswith(f"{group}=") for word in choice):
            choice = [*choice, f"{'+' if group == 'reference' else ''}{group}={name}"]
        command = rng.choice((["show", *choice], ["run", *choice, "duration=0.05", "--out", "o"]))
    return Case(command, conf=here / "conf", simulates=True)


def _uses(config, group, name):
    """Whether a config is made with this choice of a group."""
    return group in config and config[group].get("name") == name


def _text_file(rng, path, content, here):
    path.unlink(missing_ok=True)
    if rng.random() < 0.05:
        other(rng, path, here)
    elif rng.random() < 0.6:
        path.write_bytes(dumped(rng, changed(rng, yaml.safe_load(content))))
    else:
        path.write_bytes(mangled(rng, content.encode()))
