"""How the commands are spelled: arguments, options and their help."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from rotctl import __version__, clip_commands, commands
from rotctl.wording import one_line

EPILOG = """\
examples:
  rotctl run                                      Forward Roll 1, 20 s, into runs/<run id>/
  rotctl run seed=3 duration=5 --filmstrip        another start, a picture of it
  rotctl run controller.pose.weight=0.5
  rotctl sweep 'seed=range(0,50)' --out sweeps/a  fifty starts; the same again resumes
  rotctl summarise sweeps/a                       success rate with its interval, quartiles
  rotctl report sweeps --out site                 pages on sweeps: claims with verdicts
  rotctl list                                     what can be chosen
  rotctl show behaviour=forward_roll_1            the whole config, with these choices
  rotctl replay runs/<run id>/run.h5              a page that plays it in the browser
  rotctl render runs/<run id>/run.h5 --filmstrip roll.png --video roll.mp4
  rotctl plot runs/<run id>/run.h5 --out roll.pdf
  rotctl inspect runs/<run id>/run.h5             what is in a log
  rotctl verify runs/<run id>/run.h5              run it again: the same bits?
  rotctl import-motion roll.bvh --out roll.yaml   a captured roll as a reference clip

exit codes: 0 simulated (a roll that stalls is a result: success false), 1 the physics or
the solver broke down, a run of a sweep could not be run, a log does not repeat (rotctl verify),
or a claim got worse (rotctl report --against), 2 bad input, 130 interrupted
"""
OVERRIDES_HELP = "config overrides in Hydra's syntax, such as seed=3 (see rotctl list and show)"


class _Parser(argparse.ArgumentParser):
    """One line an error, and no abbreviations that a later option would break."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {one_line(message)}; see {self.prog} --help\n")


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Arguments, where overrides and options may be mixed: argparse takes one block alone."""
    arguments, others = _parser().parse_known_args(argv)
    takes_more = "overrides" in arguments
    unknown = [text for text in others if text.startswith("-") or not takes_more]
    if unknown:
        arguments.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    if takes_more:
        arguments.overrides = [*arguments.overrides, *others]
    return arguments


def _folder(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)


def _seconds(text: str) -> tuple[float, float]:
    start, _, end = text.partition(":")
    try:
        return float(start), float(end)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: valid: START:END in seconds") from None


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="rotctl",
        description="Physics-based rotational character control: a simulated human that rolls.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"rotctl {__version__}")
    chosen = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    run = chosen.add_parser(
        "run",
        help="simulate one run and log it",
        description="Simulate one run into OUT/<run id>/run.h5 and summary.json. The run id is "
        "a hash of the config: a run that is already there is reported, not redone.",
    )
    run.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    run.add_argument(
        "--out", type=_folder, default=Path("runs"), help="folder for runs [%(default)s]"
    )
    run.add_argument(
        "--again",
        type=Path,
        metavar="RUN.h5",
        help="the config of that log, instead of KEY=VALUE (rotctl verify compares, too)",
    )
    run.add_argument("--json", action="store_true", help="print the summary row as JSON on stdout")
    run.add_argument("--quiet", action="store_true", help="no progress, no notices")
    run.add_argument("--force", action="store_true", help="redo a run that is already there")
    run.add_argument("--filmstrip", action="store_true", help="also draw filmstrip.png beside it")
    run.set_defaults(command=commands.run)

    render = chosen.add_parser(
        "render",
        help="draw pictures of a logged run",
        description="Draw a run from its log alone; nothing is simulated again.",
    )
    render.add_argument("log", type=Path, metavar="RUN.h5")
    render.add_argument(
        "--filmstrip",
        type=Path,
        metavar="OUT.png",
        help="side view that follows the character, frame beside frame",
    )
    render.add_argument(
        "--video",
        type=Path,
        metavar="OUT.mp4",
        help="the same view as a film, 30 frames/s; needs ffmpeg (pip install 'rotctl[video]')",
    )
    render.add_argument(
        "--frames", type=int, default=12, help="number of frames of the filmstrip [%(default)s]"
    )
    _add_window(render)
    render.set_defaults(command=commands.render)

    replay = chosen.add_parser(
        "replay",
        help="make a page that plays a logged run in the browser",
        description="Write one HTML file that works offline: the run in 3D with its contact "
        "forces, beside its plots. Nothing is simulated again.",
    )
    replay.add_argument("log", type=Path, metavar="RUN.h5")
    replay.add_argument(
        "--html", type=Path, metavar="OUT.html", help="where to write it [replay.html by the log]"
    )
    replay.add_argument(
        "--compare", type=Path, metavar="OTHER.h5", help="another run, laid over as a ghost"
    )
    replay.set_defaults(command=commands.replay)

    plot = chosen.add_parser(
        "plot",
        help="plot a logged run on one page",
        description="Plot rotation, momentum rates, blend, torques, contacts and solver of a run "
        "on one page, from its log alone.",
    )
    plot.add_argument("log", type=Path, metavar="RUN.h5")
    plot.add_argument(
        "--out",
        type=Path,
        metavar="OUT.png|.svg|.pdf",
        help="where to write it [plot.png by the log]",
    )
    _add_window(plot)
    plot.set_defaults(command=commands.plot)

    listing = chosen.add_parser(
        "list",
        help="config groups and their choices",
        description="List the config groups and the choices of each. Choose with GROUP=CHOICE, "
        "as in: rotctl run start=rest",
    )
    listing.set_defaults(command=commands.list_choices)

    show = chosen.add_parser(
        "show",
        help="print the composed config as YAML",
        description="Print the config that a run with these overrides gets, as YAML: every key "
        "there can be overridden, as in: rotctl show controller.pose.damping=40",
    )
    show.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    show.set_defaults(command=commands.show)

    inspect = chosen.add_parser(
        "inspect",
        help="what is inside a log, and is it whole",
        description="List a log's datasets with units, its outcome and provenance, and verify "
        "its checksums.",
    )
    inspect.add_argument("log", type=Path, metavar="RUN.h5")
    inspect.set_defaults(command=commands.inspect)

    verify = chosen.add_parser(
        "verify",
        help="repeat a logged run: does it come out the same, to the last bit",
        description="Simulate the config of a log once more and compare every dataset bit by bit. "
        "Prints 'same bits', or the first step and datasets that part, whether control or physics "
        "went another way there, and what of code, versions, processor and C library is not what "
        "it was. Writes nothing. Exit code 0: the same; 1: not; 2: no log, or none that can be "
        "run. docs/reproducibility.md says where the same bits can be expected.",
    )
    verify.add_argument("log", type=Path, metavar="RUN.h5")
    verify.add_argument("--json", action="store_true", help="print it as JSON on stdout")
    verify.set_defaults(command=commands.verify)

    bench = chosen.add_parser(
        "bench",
        help="where the time goes",
        description="Measure where the time goes: a control step, whole processes, solvers, "
        "contacts and hinges, sweeps. Takes some minutes.",
    )
    bench.add_argument("--repeats", type=int, default=5, help="median over this many [%(default)s]")
    bench.add_argument("--plot", type=Path, metavar="OUT.svg", help="plot cost against contacts")
    bench.set_defaults(command=commands.bench)

    sweep = chosen.add_parser(
        "sweep",
        help="simulate many runs, and go on where it ended",
        description="Simulate every point of a grid into DIR/<run id>/run.h5, in Hydra's sweep "
        "syntax: a=x,y  'seed=range(0,100)'  'start=glob(*)'  or +experiment=NAME. Runs that are "
        "there are not redone, so that the same command goes on where it was cut off.",
    )
    sweep.add_argument("overrides", nargs="*", metavar="KEY=VALUES", help=OVERRIDES_HELP)
    sweep.add_argument("--out", type=_folder, required=True, metavar="DIR", help="folder of runs")
    sweep.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    sweep.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    sweep.add_argument(
        "--retries", type=int, default=2, help="for a run whose worker died [%(default)s]"
    )
    sweep.add_argument("--dry-run", action="store_true", help="only say what there is to do")
    sweep.add_argument("--strict", action="store_true", help="redo what other code has made")
    sweep.add_argument("--quiet", action="store_true", help="no progress, no notices")
    sweep.set_defaults(command=commands.sweep)

    summarise = chosen.add_parser(
        "summarise",
        help="tables of many runs",
        description="Tabulate all runs below DIR, one row a run, into summary.csv (and "
        "summary.parquet, if pyarrow is there), and print success rates with 95 %% intervals and "
        "the quartiles of the metrics by group, also in groups.csv.",
    )
    summarise.add_argument("folder", type=Path, metavar="DIR")
    summarise.add_argument(
        "--by", metavar="KEY,KEY", help="columns to group by [the overridden keys but the seed]"
    )
    summarise.add_argument(
        "--mixed", action="store_true", help="average over runs of different code all the same"
    )
    summarise.set_defaults(command=commands.summarise)

    report = chosen.add_parser(
        "report",
        help="pages on many runs: claims with verdicts, pictures, replays",
        description="Make a static folder of pages out of the runs below DIR, a sweep or several: "
        "the claims of their experiments with verdicts, pictures and replays of the median and "
        "the worst run of each row, charts, and where it all comes from. Also claims.csv, "
        "junit.xml and summary.md. Nothing is simulated again.",
    )
    report.add_argument("folder", type=Path, metavar="DIR")
    report.add_argument(
        "--out", type=_folder, default=Path("site"), help="folder for the pages [%(default)s]"
    )
    report.add_argument(
        "--against",
        type=Path,
        metavar="OLD",
        help="an earlier report: print which verdicts changed, exit 1 if one got worse",
    )
    report.set_defaults(command=commands.report)

    tune = chosen.add_parser(
        "tune",
        help="search for poses or gains over many starts",
        description="Search what conf/tune/NAME.yaml declares, in whole generations, each on "
        "fresh training starts. The same command again goes on where the last one ended.",
    )
    tune.add_argument("name", metavar="NAME", help="a space in conf/tune/, or a .yaml file")
    tune.add_argument("overrides", nargs="*", metavar="KEY=VALUE", help=OVERRIDES_HELP)
    tune.add_argument(
        "--out", type=_folder, required=True, metavar="DIR", help="holds the search and its result"
    )
    budget = tune.add_mutually_exclusive_group()
    budget.add_argument("--trials", type=int, metavar="N", help="candidates in all [the space's]")
    budget.add_argument("--minutes", type=float, metavar="M", help="time for this call instead")
    tune.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    tune.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    tune.add_argument("--sampler", choices=("cmaes", "tpe"), help="instead of the space's")
    tune.add_argument("--seed", type=int, default=0, metavar="S", help="of the search [0]")
    tune.set_defaults(command=commands.tune)

    importing = chosen.add_parser(
        "import-motion",
        help="make a reference clip of captured motion",
        description="Read a captured roll (BVH, ASF/AMC or DeepMimic), put it on one of our "
        "characters, cut out one cycle and write it as a clip over the phase of the roll. Says "
        "how well each segment follows, how fast the body turns and how well the loop closes.",
    )
    importing.add_argument("file", type=Path, metavar="FILE", help=".bvh, .amc, .txt or .json")
    importing.add_argument(
        "--cycle",
        type=_seconds,
        metavar="START:END",
        help="of the roll [s] [the one that closes best]",
    )
    importing.add_argument(
        "--skeleton", type=Path, metavar="FILE.asf", help="of an .amc [the .asf of its name]"
    )
    importing.add_argument("--rate", type=float, metavar="HZ", help="frame rate [the file's]")
    importing.add_argument(
        "--symmetric", action="store_true", help="the mean of the roll and its mirror image"
    )
    importing.add_argument("--licence", default="", metavar="TEXT", help="the source's terms")
    importing.set_defaults(command=clip_commands.import_motion)

    authoring = chosen.add_parser(
        "author-motion",
        help="make a reference clip of key poses",
        description="Make a clip of the key poses of one cycle, as in conf/motion/keys/: smooth "
        "between them, its phase linear in how far the body has turned.",
    )
    authoring.add_argument("file", type=Path, metavar="KEYS.yaml")
    authoring.set_defaults(command=clip_commands.author_motion)

    for command in (importing, authoring):
        command.add_argument(
            "--out", type=_folder, required=True, metavar="CLIP.yaml", help="the clip"
        )
        command.add_argument(
            "--filmstrip", action="store_true", help="also draw CLIP.png beside it"
        )

    preview = chosen.add_parser(
        "preview-motion",
        help="draw a reference clip",
        description="Draw one cycle of a clip as it rolls over the ground; nothing is simulated.",
    )
    preview.add_argument("clip", metavar="CLIP", help="a name in conf/motion/, or a .yaml file")
    preview.add_argument("--out", type=Path, required=True, metavar="OUT.png")
    preview.add_argument(
        "--frames", type=int, default=12, help="number of frames of the filmstrip [%(default)s]"
    )
    preview.set_defaults(command=clip_commands.preview_motion)

    for command in (importing, authoring, preview):
        command.add_argument(
            "--character", default="adult", metavar="NAME", help="whose joints [%(default)s]"
        )

    for command in chosen.choices.values():
        command.set_defaults(parser=command, interrupted="an unfinished run leaves no log")
    for command in (importing, authoring):
        command.set_defaults(interrupted="an unfinished clip is not written")
    verify.set_defaults(interrupted="nothing was compared")
    for command in (render, replay, plot, preview, report):
        command.set_defaults(interrupted="an unfinished picture is not written")
    for command in (sweep, tune):
        command.set_defaults(interrupted="the same command does what is left")
    return parser


def _add_window(command: argparse.ArgumentParser) -> None:
    command.add_argument("--from", type=float, metavar="S", dest="start", help="first time [s]")
    command.add_argument("--to", type=float, metavar="S", dest="end", help="last time [s]")
