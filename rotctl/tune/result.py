"""What a search leaves for people and for the next run: its config choices."""

import json
from pathlib import Path
from typing import Any

import yaml

from rotctl import files
from rotctl.choices.composing import SELF
from rotctl.choices.config_folders import conf_dir, own_dir
from rotctl.choices.contents import content, usual
from rotctl.choices.listing import choices as choices_of
from rotctl.choices.listing import named_file
from rotctl.log import collect
from rotctl.settings.plain import way
from rotctl.tune.chart import plot, table
from rotctl.tune.choice import Candidate
from rotctl.tune.objective import finished
from rotctl.tune.search import SearchResult
from rotctl.tune.values import final_seeds, put, training_seeds


def write(result: SearchResult, folder: Path) -> list[Path]:
    """Write the best candidate as config choices, and the history as a table and a picture.

    A choice is `folder/GROUP/NAME_tuned.yaml`, for each config group that the search changed.

    Returns:
        The files of the choices.

    Raises:
        InputError: the folder cannot be written.
    """
    written = []
    for group, text in choices(result).items():
        written.append(folder / group / f"{choice_name(result)}.yaml")
        with files.folder(written[-1].parent, linked=False):
            files.replace(written[-1], text.encode())
    files.replace(folder / "history.txt", table(result.trials).encode())
    files.replace(folder / "history.svg", plot(result.trials))
    return written


def choice_name(result: SearchResult) -> str:
    """How the choice is called in every group."""
    return f"{result.search.space.name}_tuned"


def choices(result: SearchResult) -> dict[str, str]:
    """Config group to the text of its choice: complete, the provenance as comments."""
    data = put(result.data, result.candidates[0].values)
    described = "\n".join(f"# {line}".rstrip() for line in provenance(result))
    texts = {}
    for group in _groups(result):
        plain = json.loads(json.dumps(data[group])) | {"name": choice_name(result)}
        if "description" in plain:
            plain["description"] = f"Found by rotctl tune: {result.search.space.title}"
        brought = _brought(_chosen(result, group), group)
        if brought:
            plain = {"defaults": [*({key: name} for key, name in brought.items()), SELF], **plain}
        body = yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100)
        texts[group] = f"{described}\n{body}"
    return texts


def provenance(result: SearchResult) -> list[str]:
    """Where the result comes from, line by line."""
    search, best = result.search, result.candidates[0]
    space, last = search.space, max(trial.generation for trial in result.trials)
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
        f"trials     {len(result.trials)} in {last + 1} generations, "
        f"{space.runs.seeds} runs of {result.data['duration']:g} s each",
        f"seeds      training {seeds[0]} to {seeds[1]}; final choice {final[0]} to {final[-1]}",
        f"taken      {best.name}",
        f"score      {summary(best)}; the start had {summary(result.start)}",
        f"versions   {', '.join(f'{k} {v}' for k, v in source['versions'].items())}",
        f"commit     {source['git_commit']}{dirty}",
    ]


def summary(candidate: Candidate) -> str:
    """Score, survival and success on the final seeds."""
    ended, count = finished(candidate.runs), len(candidate.runs)
    succeeded = sum(run.success for run in candidate.runs)
    return f"{candidate.score:.3f}, {ended:.0%} of {count} runs to the end, {succeeded} a success"


def comparison(result: SearchResult) -> str:
    """The start and the candidates on the final seeds, a line each."""
    written = result.candidates[0]
    lines = [
        f"  {row.name:32} {summary(row)}{'  <- written' if row is written else ''}"
        for row in (result.start, *result.candidates)
    ]
    if wanting := missed(result):
        lines.append(f"{wanting}: search on, or change the space; what is written is to look at")
    return "\n".join(lines)


def missed(result: SearchResult) -> str:
    """Why the result is not worth judging; empty if it is."""
    best, start = result.candidates[0], result.start
    if best.score <= start.score:
        return "none is better than the start"
    if not any(run.success for run in best.runs):
        return "nothing was found that succeeds, by its criteria, from any of these starts"
    return ""


def how_to_judge(result: SearchResult, written: list[Path], folder: Path) -> str:
    """What to type next: the result on the judging seeds."""
    groups = _groups(result)
    kept = [
        text
        for text in (*result.search.space.base, *result.search.overrides)
        if text.lstrip("+~").partition("=")[0].partition(".")[0] not in {*groups, "duration"}
    ]
    chosen = [f"{group}={choice_name(result)}" for group in groups]
    overrides = _shell([*kept, *chosen, "seed=range(0,50)"])
    judged = f"  rotctl sweep {overrides} --out {_shell([folder / 'judged'])}"
    copies = [_copy(file) for file in written]
    return "\n".join(["to judge it, on seeds that no search has seen:", *copies, judged])


def _copy(file: Path) -> str:
    """What copies a choice to where it is found, into a folder that may have to be made."""
    folder = (own_dir() or conf_dir()) / file.parent.name
    made = "" if folder.is_dir() else f"mkdir -p {_shell([folder])} && "
    return f"  {made}cp {_shell([file])} {_shell([folder])}/"


def _chosen(result: SearchResult, group: str) -> str:
    """The choice of a group that a search started from."""
    texts = [*result.search.space.base, *result.search.overrides]
    named = [text.partition("=")[2] for text in texts if text.startswith(f"{group}=")]
    known = [name for name in named if name in choices_of(group)]
    return str(known[-1] if known else usual()[group])


def _brought(name: str, group: str) -> dict[str, str]:
    """What a choice chooses in other groups, and what it builds on does."""
    found: dict[str, str] = {}
    for entry in content(named_file(group, name)).get("defaults", []):
        if isinstance(entry, dict):
            found |= entry
        elif entry != SELF:
            found |= _brought(entry, group)
    return found


def _groups(result: SearchResult) -> list[str]:
    keys = (str(way(parameter.key)[0]) for parameter in result.search.space.parameters)
    return list(dict.fromkeys(keys))


def _shell(words: list[Any]) -> str:
    from shlex import join

    return join(map(str, words)) or "the defaults"
