"""What a search leaves for people and for the next run: config choices, and its history."""

import json
from collections import defaultdict
from io import BytesIO
from pathlib import Path
from statistics import median
from typing import Any

import yaml

from rotctl import files
from rotctl.listing import conf_dir
from rotctl.log import collect
from rotctl.plain import way
from rotctl.tune.choice import Candidate
from rotctl.tune.history import Trial
from rotctl.tune.objective import finished
from rotctl.tune.search import Found
from rotctl.tune.values import final_seeds, put, training_seeds


def write(found: Found, folder: Path) -> list[Path]:
    """Write the best candidate as config choices, and the history as a table and a picture.

    A choice is `folder/GROUP/NAME_tuned.yaml`, for each config group that the search changed.

    Returns:
        The files of the choices.

    Raises:
        InputError: the folder cannot be written.
    """
    written = []
    for group, text in choices(found).items():
        written.append(folder / group / f"{choice_name(found)}.yaml")
        with files.folder(written[-1].parent, linked=False):
            files.replace(written[-1], text.encode())
    files.replace(folder / "history.txt", table(found.trials).encode())
    files.replace(folder / "history.svg", plot(found.trials))
    return written


def choice_name(found: Found) -> str:
    """How the choice is called in every group."""
    return f"{found.search.space.name}_tuned"


def choices(found: Found) -> dict[str, str]:
    """Config group to the text of its choice: complete, the provenance as comments."""
    data = put(found.data, found.candidates[0].values)
    described = "\n".join(f"# {line}".rstrip() for line in provenance(found))
    texts = {}
    for group in _groups(found):
        plain = json.loads(json.dumps(data[group])) | {"name": choice_name(found)}
        if "description" in plain:
            plain["description"] = f"Found by rotctl tune: {found.search.space.title}"
        body = yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100)
        texts[group] = f"{described}\n{body}"
    return texts


def provenance(found: Found) -> list[str]:
    """Where the result comes from, line by line."""
    search, best = found.search, found.candidates[0]
    space, last = search.space, max(trial.generation for trial in found.trials)
    seeds = training_seeds(space, search.seed, 0)[0], training_seeds(space, search.seed, last)[-1]
    final = final_seeds(space, search.seed)
    source = collect()
    dirty = ", with changes" if source["git_dirty"] else ""
    return [
        f"Found by rotctl tune: {space.title}",
        f"space      {space.name}, {len(space.parameters)} parameters",
        f"base       {_shell([*space.base, *search.overrides])}",
        f"sampler    {space.sampler.name}, population {space.sampler.population}, "
        f"sigma {space.sampler.sigma:g}, seed {search.seed}",
        f"trials     {len(found.trials)} in {last + 1} generations, "
        f"{space.runs.seeds} runs of {found.data['duration']:g} s each",
        f"seeds      training {seeds[0]} to {seeds[1]}; final choice {final[0]} to {final[-1]}",
        f"taken      {best.name}",
        f"score      {summary(best)}; the start had {summary(found.start)}",
        f"versions   {', '.join(f'{k} {v}' for k, v in source['versions'].items())}",
        f"commit     {source['git_commit']}{dirty}",
    ]


def summary(candidate: Candidate) -> str:
    """Score and survival on the final seeds."""
    ended = finished(candidate.runs)
    return f"{candidate.score:.3f}, {ended:.0%} of {len(candidate.runs)} runs to the end"


def comparison(found: Found) -> str:
    """The start and the candidates on the final seeds, a line each."""
    best = found.candidates[0]
    lines = [
        f"  {row.name:32} {summary(row)}{'  <- taken' if row is best else ''}"
        for row in (found.start, *found.candidates)
    ]
    if best.score <= found.start.score:
        lines.append("none is better than the start: search on, or change the space")
    return "\n".join(lines)


def how_to_judge(found: Found, written: list[Path], folder: Path) -> str:
    """What to type next: the result on the judging seeds."""
    groups = _groups(found)
    kept = [
        text
        for text in (*found.search.space.base, *found.search.overrides)
        if text.lstrip("+~").partition("=")[0].partition(".")[0] not in {*groups, "duration"}
    ]
    chosen = [f"{group}={choice_name(found)}" for group in groups]
    overrides = _shell([*kept, *chosen, "seed=range(0,50)"])
    copies = [f"  cp {file} {conf_dir() / file.parent.name}/" for file in written]
    judged = f"  rotctl sweep {overrides} --out {folder / 'judged'}"
    return "\n".join(["to judge it, on seeds that no search has seen:", *copies, judged])


def table(trials: list[Trial]) -> str:
    """The history, a line for each generation."""
    lines = ["generation  trials    best  median   worst  to the end    lost  time [s]"]
    for number, group in sorted(_by_generation(trials).items()):
        scores = [trial.score for trial in group]
        ended = sum(trial.finished for trial in group) / len(group)
        lost, seconds = sum(t.lost for t in group), max(t.seconds for t in group)
        lines.append(
            f"{number:10} {len(group):7} {max(scores):7.3f} {median(scores):7.3f} "
            f"{min(scores):7.3f} {ended:11.0%} {lost:7} {seconds:9.1f}"
        )
    return "\n".join(lines) + "\n"


def plot(trials: list[Trial]) -> bytes:
    """The history as an SVG picture: every trial, and the median of each generation."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 3.5), layout="constrained")
    axes = figure.add_subplot()
    groups = sorted(_by_generation(trials).items())
    numbers = [number for number, _ in groups]
    axes.scatter(
        [t.generation for t in trials], [t.score for t in trials], s=8, alpha=0.4, label="trials"
    )
    axes.plot(numbers, [median(t.score for t in g) for _, g in groups], label="median")
    ended = [sum(t.finished for t in g) / len(g) for _, g in groups]
    axes.plot(numbers, ended, linestyle=":", label="runs to the end")
    axes.set(xlabel="generation", ylabel="score [-], fraction [-]", ylim=(None, 1.05))
    axes.legend(loc="lower right")
    with matplotlib.rc_context({"svg.hashsalt": "rotctl"}):
        packed = BytesIO()
        figure.savefig(packed, format="svg", metadata={"Date": None})
    return packed.getvalue()


def _groups(found: Found) -> list[str]:
    keys = (str(way(parameter.key)[0]) for parameter in found.search.space.parameters)
    return list(dict.fromkeys(keys))


def _by_generation(trials: list[Trial]) -> dict[int, list[Trial]]:
    groups: dict[int, list[Trial]] = defaultdict(list)
    for trial in trials:
        groups[trial.generation].append(trial)
    return groups


def _shell(words: list[Any]) -> str:
    from shlex import join

    return join(map(str, words)) or "the defaults"
