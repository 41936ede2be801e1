"""A log file -> its arrays, checked before anything is read."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from rotctl.errors import LogError
from rotctl.log import untrusted
from rotctl.log.conformity import check_dataset, check_layout
from rotctl.log.digest import content_sha256, simulated
from rotctl.log.outcome import outcome_of
from rotctl.log.scales import labels
from rotctl.log.schema import MODEL_PATH, SCHEMA, names_of
from rotctl.suggestion import meant


def read_attributes(path: str | Path, *, linked: bool) -> dict[str, bool | int | float | str]:
    """The root attributes alone, checked; a tenth of the work of `RunLog.open`.

    Args:
        linked: whether the path may be a symbolic link, see `rotctl.files.opened`.

    Raises:
        LogError: ``<path>: <reason>``; missing, truncated, foreign, of another version or
            incomplete.
    """
    with untrusted.opened(Path(path), linked=linked) as file:
        return untrusted.root_attributes(file)


@dataclass(frozen=True)
class RunLog(Mapping[str, NDArray[Any]]):
    """One checked log: a mapping of names to arrays. The file is opened for each read, never held.

    Attributes:
        path: the file.
        attributes: root attributes, as plain Python values.
        sizes: ``steps``, ``nq``, ``nv``, ``nu``, ``capacity``, ``events`` -> size.
    """

    path: Path
    attributes: Mapping[str, bool | int | float | str]
    sizes: Mapping[str, int]

    @classmethod
    def open(cls, path: str | Path, *, linked: bool = True) -> "RunLog":
        """Opens a log and checks all of it except the data themselves (see ``verify``).

        Args:
            linked: whether the path may be a symbolic link: no for what is found in a folder.

        Raises:
            LogError: ``<path>: <reason>``; missing, truncated, foreign, of another version,
                incomplete, unsafe or misshapen.
        """
        path = Path(path)
        with untrusted.opened(path, linked=linked) as file:
            attributes = untrusted.root_attributes(file)
            datasets = untrusted.datasets(file)
            layout = {name: (d.dtype, d.shape) for name, d in datasets.items()}
            sizes = check_layout(layout, int(attributes["schema_version"]))
            untrusted.require_no_bomb(path.stat().st_size, datasets.values())
            for name, dataset in datasets.items():
                _check_unit(name, dataset)
        return cls(path, attributes, sizes)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Reads one dataset, for example ``log["trajectory/qpos"]``.

        Raises:
            LogError: there is no such dataset, or it is damaged.
        """
        self._require_name(name)
        with untrusted.opened(self.path, linked=True) as file:
            return self._read(file, name)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Reads all datasets, in one go.

        Raises:
            LogError: one is damaged.
        """
        with untrusted.opened(self.path, linked=True) as file:
            return {name: self._read(file, name) for name in self.names}

    def __contains__(self, name: object) -> bool:
        """Whether there is such a dataset; logs of older schema versions have fewer."""
        return name in self.names

    def __iter__(self) -> Iterator[str]:
        """The names of its datasets."""
        return iter(self.names)

    def __len__(self) -> int:
        """How many datasets it has."""
        return len(self.names)

    def get(self, name: str, default: Any = None) -> Any:
        """A dataset, or something else where there is none of that name."""
        return self[name] if name in self else default  # noqa: SIM401 (this is get)

    @property
    def names(self) -> tuple[str, ...]:
        """Its datasets, in the order of the schema."""
        return names_of(int(self.attributes["schema_version"]))

    @property
    def steps(self) -> int:
        """Number of control steps."""
        return self.sizes["steps"]

    @property
    def config_yaml(self) -> str:
        """The full configuration of the run, as YAML."""
        return str(self.attributes["config"])

    @property
    def outcome(self) -> dict[str, Any]:
        """The run's summary row.

        Raises:
            LogError: it is not a JSON object of plain values.
        """
        try:
            return outcome_of(str(self.attributes["outcome"]))
        except LogError as error:
            raise LogError(f"{self.path}: {error}") from None

    @property
    def model_xml(self) -> str:
        """The simulated model, as MJCF.

        Raises:
            LogError: it is damaged.
        """
        return self._text(self[MODEL_PATH].item())

    @property
    def events(self) -> list[tuple[float, str]]:
        """(time [s], text) of every event.

        Raises:
            LogError: they are damaged.
        """
        times, texts = self["events/time"].tolist(), self["events/text"].tolist()
        return [(time, self._text(text)) for time, text in zip(times, texts, strict=True)]

    def units(self, name: str) -> str:
        """Returns the unit of a dataset; ``open`` has checked that the file agrees."""
        self._require_name(name)
        return SCHEMA[name].unit

    def description(self, name: str) -> str:
        """Returns what a dataset holds."""
        self._require_name(name)
        return SCHEMA[name].description

    def verify(self) -> str:
        """Reads everything and compares it with the hash that the writer left.

        Returns:
            SHA-256 of what was simulated, the same for a repetition.

        Raises:
            LogError: the file is damaged.
        """
        with untrusted.opened(self.path, linked=True) as file:
            # Block by block: a log may be larger than the memory.
            datasets = {name: self._checked(file, name) for name in self.names}
            whole = simulated(datasets)
            for axis, along in labels(datasets).items():
                scale = untrusted.scale(file, axis)
                if scale is not None and not _same(scale, along):
                    raise LogError(f"{self.path}: damaged, its axis {axis!r} is labelled otherwise")
        found = content_sha256(whole, self.attributes)
        if found != self.attributes["content_sha256"]:
            raise LogError(f"{self.path}: damaged, its content does not match its SHA-256")
        return whole.hexdigest()

    def _read(self, file: h5py.File, name: str) -> NDArray[Any]:
        found = np.asarray(self._checked(file, name)[()])
        return found.astype(bool) if SCHEMA[name].dtype == "?" else found

    def _checked(self, file: h5py.File, name: str) -> h5py.Dataset:
        dataset = untrusted.dataset(file, *name.split("/"))
        check_dataset(name, dataset.dtype, dataset.shape, self.sizes)
        return dataset

    def _require_name(self, name: str) -> None:
        if name not in self.names:
            raise LogError(
                f"{self.path}: no dataset {name!r}; {meant(name, self.names)}"
                f"valid names: {', '.join(self.names)}"
            )

    def _text(self, encoded: bytes) -> str:
        try:
            return encoded.decode("utf-8")
        except UnicodeDecodeError as error:
            raise LogError(f"{self.path}: damaged, text is not UTF-8") from error


def _same(scale: h5py.Dataset, along: Any) -> bool:
    """Whether a stranger's labels are these; what is of another size is not read."""
    alike = scale.shape == along.shape and scale.dtype == along.dtype
    return alike and bool(np.array_equal(scale[()], along[()]))


def _check_unit(name: str, dataset: h5py.Dataset) -> None:
    """Refuses a dataset that would be misread, say millimetres for metres."""
    unit = untrusted.attribute(dataset, "units") if "units" in dataset.attrs else None
    if unit != SCHEMA[name].unit:
        raise LogError(f"{name} has unit {unit!r:.40}, expected {SCHEMA[name].unit!r}")
