"""What can be chosen, and the config that it makes: `list`, `show`."""

import argparse
import os
from collections.abc import Mapping
from pathlib import Path

from rotctl.cli.commands.arguments import (
    IS_ID,
    LOG_NAME,
    OVERRIDES_HELP,
    Commands,
    opened_log,
    run_folder,
)
from rotctl.errors import InputError


def add_list(commands: Commands) -> None:
    """Add `list`."""
    command = commands.add_parser(
        "list",
        help="config groups and their choices",
        description="List the config groups and the choices of each, or those of one group. Choose "
        "with GROUP=CHOICE, as in: rotctl run start=rest",
    )
    command.add_argument("group", nargs="?", metavar="GROUP", help="such as behaviour [all]")
    command.set_defaults(command=list_choices)


def list_choices(arguments: argparse.Namespace) -> int:
    """List config groups and their choices."""
    from rotctl.choices.describing import described, groups, strays
    from rotctl.choices.listing import EXPERIMENTS
    from rotctl.settings.complaints import brief
    from rotctl.suggestion import instead, meant

    titles = {
        "catch": "catch (+catch=NAME)",
        "course": "course (+course=NAME)",
        "finish": "finish (+finish=NAME)",
        "motion": "motion (behaviour.reference.clip=NAME)",
        "tune": "tune (rotctl tune NAME)",
        EXPERIMENTS: "experiments (rotctl sweep +experiment=NAME)",
    }
    listed = groups() | {name: described(name) for name in titles}
    if arguments.group is not None:
        if arguments.group not in listed:
            near = instead(arguments.group, list(listed))
            raise InputError(f"{brief(arguments.group)}: no such group; {near}")
        listed = {arguments.group: listed[arguments.group]}
    for folder, choices in listed.items():
        if choices:
            print(titles.get(folder, folder))
            _print_choices(folder, choices)
    for name, path in strays().items() if arguments.group is None else ():
        near = meant(name, listed)
        print(f"{path}: is of no group, so that nobody reads it{near and '; '}{near.rstrip()}")
    print("\nchoose with GROUP=CHOICE, change a value with KEY=VALUE; see: rotctl show")
    return 0


def _print_choices(folder: str, choices: Mapping[str, str]) -> None:
    from rotctl.choices.config_folders import is_own
    from rotctl.choices.listing import misnamed, named_files

    width = max(map(len, choices))
    places = misnamed(folder) | named_files(folder)
    for choice, description in choices.items():
        mine = f"  [yours: {places[choice]}]" if is_own(places[choice]) else ""
        print(f"  {choice:{width}}  {description}{mine}".rstrip())


def add_show(commands: Commands) -> None:
    """Add `show`."""
    command = commands.add_parser(
        "show",
        help="print the composed config as YAML",
        description="Print the config that a run with these overrides gets, as YAML: every key "
        "there can be overridden, as in: rotctl show controller.pose.damping=40. In their place "
        "a run may be named, by its folder or its id in runs/, to print the config that it had.",
    )
    command.add_argument(
        "overrides", nargs="*", default=[], metavar="KEY=VALUE", help=OVERRIDES_HELP
    )
    command.add_argument("--part", metavar="KEY", help="only what is under it, such as behaviour")
    command.set_defaults(command=show)


def show(arguments: argparse.Namespace) -> int:
    """Print the composed config."""
    from rotctl.config.loading import load, recorded
    from rotctl.settings.writing import part_to_yaml, to_yaml

    run = _only_run(arguments.overrides)
    config = recorded(opened_log(run)) if run else load(arguments.overrides)
    print(part_to_yaml(config, arguments.part) if arguments.part else to_yaml(config), end="")
    return 0


def _only_run(overrides: list[str]) -> Path | None:
    """The run that is named in place of overrides, if one is."""
    from rotctl.choices.override_files import MARK

    if len(overrides) != 1 or "=" in overrides[0] or overrides[0].startswith(MARK):
        return None
    path = run_folder(Path(overrides[0]))
    named = path.suffix == ".h5" or IS_ID.fullmatch(path.name)
    return path if named or os.path.lexists(path / LOG_NAME) else None
