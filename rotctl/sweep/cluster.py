"""The way to a Dask scheduler that somebody has started, and its workers on other machines."""

import logging
import socket
import time
from importlib.util import find_spec
from urllib.parse import urlsplit

from rotctl.errors import InputError
from rotctl.sweep.dask_engine import DaskEngine

PATIENCE = 4.0  # [s] for a scheduler to answer: with its start a command tells within five
MOMENT = 0.2  # [s] between two tries to reach it
TLS = "distributed.comm.tls, see docs/sweeps.md"
NOT_INSTALLED = "--scheduler needs Dask, which is not installed: pip install 'rotctl[cluster]'"


def connect(address: str) -> DaskEngine:
    """The engine of the scheduler at `address`; TLS files come from Dask's own settings.

    Raises:
        InputError: Dask is not installed, the address is none, or nobody answers there.
    """
    if not address.startswith(("tcp://", "tls://")):
        raise InputError(
            f"--scheduler={address}: must be tcp://HOST:PORT or tls://HOST:PORT, "
            "such as tcp://127.0.0.1:8786"
        )
    if find_spec("distributed") is None:
        raise InputError(NOT_INSTALLED)
    _require_answer(address)  # before Dask is imported, which takes as long again
    from distributed import Client, Security

    security = Security()
    if address.startswith("tls://") and not security.get_connection_args("client")["ssl_context"]:
        raise InputError(f"--scheduler={address}: Dask's settings name no TLS files: {TLS}")
    if address.startswith("tcp://") and security.require_encryption:
        raise InputError(f"--scheduler={address}: Dask's settings ask for encryption: tls://...")
    # A lost worker is no news to the user: its tasks are tried again, or listed at the end. That
    # the scheduler is lost is said below, in one line and not in a traceback.
    for name in ("distributed", "distributed.client", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    client = Client.__new__(Client)
    try:
        Client.__init__(client, address, timeout=PATIENCE, set_as_default=False, security=security)
    except (OSError, ValueError, TypeError, RuntimeError, MemoryError) as error:
        client.status = "closed"  # else it waits to be closed as it goes, and tells in a traceback
        reason = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"--scheduler={address}: no Dask scheduler there: {reason}") from None
    return DaskEngine(client, address)


def _require_answer(address: str) -> None:
    """See that somebody listens there, or soon does: Dask's own client takes its time to give up.

    Raises:
        InputError: nobody does.
    """
    end = time.monotonic() + PATIENCE
    while True:
        try:
            parts = urlsplit(address)
            place = parts.hostname or "", parts.port or 0
            socket.create_connection(place, max(MOMENT, end - time.monotonic())).close()
            return
        except (OSError, ValueError) as error:
            if isinstance(error, ValueError) or time.monotonic() > end - MOMENT:
                reason = getattr(error, "strerror", None) or str(error)
                raise InputError(
                    f"--scheduler={address}: no Dask scheduler there: {reason}"
                ) from None
            time.sleep(MOMENT)
