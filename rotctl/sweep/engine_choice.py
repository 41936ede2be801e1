"""Which engine a command line asks for."""

from rotctl.errors import InputError
from rotctl.sweep.cluster import connect
from rotctl.sweep.engines import Engine
from rotctl.sweep.local import LocalEngine


def make_engine(jobs: int | None, scheduler: str | None) -> Engine:
    """Local processes, or the workers of a Dask scheduler.

    Args:
        jobs: number of local processes; None: one for each CPU that this process may use.
        scheduler: address of a Dask scheduler, such as `tcp://127.0.0.1:8786`; None: local.

    Raises:
        InputError: a bad number or address, Dask is not installed, or nobody answers there.
    """
    if scheduler is None:
        return LocalEngine(jobs)
    if jobs is not None:
        raise InputError(
            f"--jobs={jobs}: is for local processes; with --scheduler, start as many workers"
        )
    return connect(scheduler)
