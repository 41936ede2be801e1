"""Where the configs lie, and what can be chosen; needs nothing but YAML, so it is quick."""

from pathlib import Path

import yaml

from rotctl.errors import InputError


def conf_dir() -> Path:
    """The folder of configs: inside an installed package, else beside it in a checkout.

    Raises:
        InputError: there is none.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "conf", package.parent / "conf"):
        if (folder / "config.yaml").is_file():
            return folder
    raise InputError(f"no conf/config.yaml in {package} or beside it; reinstall rotctl")


def groups() -> dict[str, dict[str, str]]:
    """Config groups to their choices to a line of description each, sorted."""
    found: dict[str, dict[str, str]] = {}
    for path in sorted(conf_dir().glob("*/*.yaml")):
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        found.setdefault(path.parent.name, {})[path.stem] = str(data.get("description", ""))
    return found
