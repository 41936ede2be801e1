"""Which formats there are, and one log to one file of them."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rotctl import files
from rotctl.export.bvh import bvh
from rotctl.export.gltf import glb
from rotctl.export.mjcf import mjcf
from rotctl.export.movement import movement
from rotctl.export.tables import csv, npz
from rotctl.log import RunLog
from rotctl.report import stored_model


@dataclass(frozen=True)
class Format:
    """How a log is written for others.

    Attributes:
        ending: of the file.
        made: log to the file's content.
    """

    ending: str
    made: Callable[[RunLog], bytes]


def _mjcf(log: RunLog) -> bytes:
    stored_model.load(log)  # so that what is read of it is what MuJoCo takes
    return mjcf(log.model_xml).encode()


FORMATS = {
    "bvh": Format(".bvh", lambda log: bvh(movement(log))),
    "csv": Format(".csv", lambda log: csv(movement(log))),
    "npz": Format(".npz", lambda log: npz(movement(log))),
    "gltf": Format(".glb", lambda log: glb(movement(log))),
    "mjcf": Format(".xml", _mjcf),
}


def export(log: RunLog, to: str, out: Path | None) -> Path:
    """Write a log in a format; returns where it is, beside the log unless told.

    Raises:
        LogError: the log is damaged, or its model is not safe to load.
        InputError: the name has another ending, or it cannot be written.
    """
    chosen = FORMATS[to]
    path = out or log.path.with_suffix(chosen.ending)
    files.require_ending(path, chosen.ending)
    files.replace(path, chosen.made(log))
    return path
