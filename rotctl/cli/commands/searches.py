"""Searches for config values: `tune`."""

import argparse
import sys

from rotctl.bars import bar
from rotctl.cli.commands.arguments import OVERRIDES_HELP, Commands, path_name


def add_tune(commands: Commands) -> None:
    """Add `tune`."""
    command = commands.add_parser(
        "tune",
        help="search for poses or gains over many starts",
        description="Search what conf/tune/NAME.yaml declares, in whole generations, each on "
        "fresh training starts. The same command again goes on where the last one ended.",
    )
    command.add_argument("name", metavar="NAME", help="a space in conf/tune/, or a .yaml file")
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUE", help=OVERRIDES_HELP
    )
    command.add_argument(
        "--out",
        type=path_name,
        required=True,
        metavar="DIR",
        help="holds the search and its result",
    )
    budget = command.add_mutually_exclusive_group()
    budget.add_argument(
        "--trials",
        type=int,
        metavar="N",
        help="candidates in all, in whole generations [the space's]",
    )
    budget.add_argument("--minutes", type=float, metavar="M", help="time for this call instead")
    command.add_argument("--jobs", type=int, metavar="N", help="local processes [one for each CPU]")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, tcp://HOST:PORT, instead")
    command.add_argument("--sampler", choices=("cmaes", "tpe"), help="instead of the space's")
    command.add_argument("--seed", type=int, default=0, metavar="S", help="of the search [0]")
    command.set_defaults(command=tune, interrupted="the same command does what is left")


def tune(arguments: argparse.Namespace) -> int:
    """Search for config values."""
    from contextlib import closing

    from rotctl.sweep.engine_choice import make_engine
    from rotctl.tune import result
    from rotctl.tune.search import Watch, prepare, tune

    search, budget = prepare(
        arguments.name,
        arguments.overrides,
        arguments.seed,
        arguments.sampler,
        arguments.trials,
        arguments.minutes,
    )
    with (
        closing(make_engine(arguments.jobs, arguments.scheduler)) as engine,
        bar(search.space.name, "run") as shown,
    ):
        watch = Watch(lambda text: shown.write(text, file=sys.stderr), shown.update)
        outcome = tune(search, arguments.out, budget, engine, watch)
    written = result.write(outcome, arguments.out)
    print(result.comparison(outcome), *written, sep="\n")
    if not result.missed(outcome):
        print(result.how_to_judge(outcome, written, arguments.out))
    return 0
