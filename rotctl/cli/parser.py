"""The command line as a whole: which commands there are, and what each of them refuses."""

import argparse
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path, PurePath
from typing import Any, NoReturn

from rotctl import __version__
from rotctl.cli.commands import (
    clips,
    completion,
    configs,
    folders,
    logs,
    pictures,
    runs,
    searches,
    studies,
    sweeps,
)
from rotctl.cli.wording import one_line
from rotctl.errors import bounded
from rotctl.suggestion import instead, meant

EPILOG = """\
examples:
  rotctl run                                      Forward Roll 1, 20 s, into runs/<run id>/
  rotctl run seed=3 duration=5 --filmstrip        another start, a picture of it
  rotctl run behaviour=back_flip duration=6       a flip; rotctl list behaviour has the others
  rotctl run controller.pose.weight=1             another weight
  rotctl sweep 'seed=range(0,50)' --out sweeps/a  fifty starts; the same again resumes
  rotctl judge sweeps/a criteria.stall_time=2     verdicts by other criteria, nothing simulated
  rotctl judge sweeps/a --metric "top=max(com[:,2])"  a column of your own
  rotctl summarise sweeps/a                       success rate with its interval, quartiles
  rotctl report sweeps --out site                 pages on sweeps: claims with verdicts
  rotctl list                                     what can be chosen
  rotctl new behaviour mine --from back_flip      a copy to change, in ./conf
  rotctl ls sweeps/a                              the runs in a folder
  rotctl diff runs/A/run.h5 runs/B/run.h5         configs and figures that differ
  rotctl show behaviour=forward_roll_1            the whole config, with these choices
  rotctl replay runs/<run id>/run.h5              a page that plays it in the browser
  rotctl render runs/<run id>/run.h5 --filmstrip roll.png --video roll.mp4
  rotctl plot runs/<run id>/run.h5 --out roll.pdf
  rotctl inspect runs/<run id>/run.h5             what is in a log
  rotctl export runs/<run id>/run.h5 --to gltf    for Blender, viewers, trackers, simulators
  rotctl verify runs/<run id>/run.h5              run it again: the same bits?
  rotctl import-motion roll.bvh --out roll.yaml   a captured roll as a reference clip
  source <(rotctl completion bash)                the tab key completes commands, choices, keys

exit codes: 0 simulated (a roll that stalls is a result: success false), 1 the physics or
the solver broke down, a run of a sweep could not be run or its scheduler is gone, a log does not
repeat (rotctl verify), or a claim got worse (rotctl report --against), 2 bad input, 130 interrupted
"""

# In the order of the help.
COMMANDS = (
    *(runs.add_run, pictures.add_render, pictures.add_replay, pictures.add_plot, logs.add_export),
    *(
        configs.add_list,
        configs.add_show,
        folders.add_new,
        folders.add_inspect_model,
        folders.add_ls,
        folders.add_diff,
    ),
    *(logs.add_inspect, logs.add_verify, runs.add_bench),
    *(sweeps.add_sweep, studies.add_judge, studies.add_summarise, studies.add_report),
    *(searches.add_tune, clips.add_import, clips.add_author, clips.add_preview),
    completion.add_completion,
)
# They need not wait for its import; `new` does of a start that is the state of a run.
WITHOUT_MUJOCO = ("list", "new", "ls", "diff", "inspect", "completion")
ELSEWHERE = {  # what writes to a file that one names
    "--filmstrip": "; it is drawn beside what is made; rotctl render RUN --filmstrip {} draws a "
    "run's elsewhere",
    "--json": "; it is printed on stdout, so write: --json > {}",
}
NUMBERS = ("seed", "duration")  # keys of a config that other programs have options for
NO_LOG = "an unfinished run leaves no log"


class _Parser(argparse.ArgumentParser):
    """One line an error, and no abbreviations that a later option would break."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """One word for what is not valid, here and in configs."""
        if action.choices is not None and value not in action.choices:
            valid = instead(value, map(str, action.choices))
            raise argparse.ArgumentError(action, f"{value!r}: no such choice; {valid}")

    def options(self) -> list[str]:
        """The options that there are."""
        return [name for action in self._actions for name in action.option_strings]

    def flags(self) -> list[str]:
        """The options that take no value."""
        return [name for one in self._actions if one.nargs == 0 for name in one.option_strings]

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {bounded(one_line(message))}; see {self.prog} --help\n")


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Arguments, where overrides and options may be mixed: argparse takes one block alone."""
    arguments, others = _parser().parse_known_args(argv)
    takes_more = "overrides" in arguments
    more = [*arguments.overrides, *others] if takes_more else others
    _refuse_files_of_flags(arguments.parser, sys.argv[1:] if argv is None else argv, more)
    unknown = [text for text in others if text.startswith("-") or not takes_more]
    if unknown:
        command = arguments.parser
        near = [_instead_of(text, command.options(), takes_more) for text in unknown]
        hint = next((f" ({text})" for text in near if text), "")
        command.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
    if takes_more:
        arguments.overrides = more
    return arguments


def _refuse_files_of_flags(command: _Parser, words: Sequence[str], more: Sequence[str]) -> None:
    """A file after an option that takes none is neither an override nor an argument."""
    flags = command.flags()
    for flag, word in pairwise(words):
        is_file = PurePath(word).suffix and "=" not in word and word[0] not in "-@~+"
        if flag in flags and word in more and is_file:
            elsewhere = ELSEWHERE.get(flag, "").format(word)
            command.error(f"{flag} takes no file, but {word!r} follows it{elsewhere}")


def _instead_of(text: str, options: list[str], takes_overrides: bool) -> str:
    """What an unknown option was probably meant to be; empty if nobody can say."""
    # It reads YAML: who makes no mistake need not wait for it.
    from rotctl.choices.listing import choices

    option, key = text.partition("=")[0], text.lstrip("-").partition("=")[0]
    if takes_overrides and choices(key):
        return f"write {key}=CHOICE"
    if takes_overrides and key in NUMBERS:
        return f"write {key}=NUMBER"
    return meant(option, options).rstrip()


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="rotctl",
        description="Physics-based rotational character control: a simulated human that rolls, "
        "turns over, flips and dives.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"rotctl {__version__}")
    _add_config_dir(parser, None)
    chosen = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for add in COMMANDS:
        add(chosen)
    for name, command in chosen.choices.items():
        _add_config_dir(command, argparse.SUPPRESS)  # before or after the command's name
        interrupted = command.get_default("interrupted") or NO_LOG
        command.set_defaults(parser=command, commands=chosen.choices, interrupted=interrupted)
        command.set_defaults(with_mujoco=name not in WITHOUT_MUJOCO)
    return parser


def _add_config_dir(parser: argparse.ArgumentParser, default: str | None) -> None:
    parser.add_argument(
        "--config-dir",
        type=Path,
        default=default,
        metavar="DIR",
        help="your own behaviours, characters, ... [./conf if it has a rotctl.yaml]",
    )
