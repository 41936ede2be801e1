"""The history of a search for people: a table and a picture."""

from collections import defaultdict
from io import BytesIO
from statistics import median

from rotctl.tune.history import Trial


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


def _by_generation(trials: list[Trial]) -> dict[int, list[Trial]]:
    groups: dict[int, list[Trial]] = defaultdict(list)
    for trial in trials:
        groups[trial.generation].append(trial)
    return groups
