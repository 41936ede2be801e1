"""One run, one HDF5 file: what it contains, how it is written and how it is read back.

``TrajectoryBuffer`` collects a run, ``write_run`` makes it a file, ``RunLog`` reads it;
``collect`` says which code and machine it came from.
"""

from rotctl.log.buffer import TrajectoryBuffer
from rotctl.log.provenance import collect
from rotctl.log.reader import RunLog, read_attributes
from rotctl.log.schema import LOG_NAME, SCHEMA, SCHEMA_VERSION, DatasetSpec
from rotctl.log.writer import encode_run, write_log, write_run

__all__ = [
    "LOG_NAME",
    "SCHEMA",
    "SCHEMA_VERSION",
    "DatasetSpec",
    "RunLog",
    "TrajectoryBuffer",
    "collect",
    "encode_run",
    "read_attributes",
    "write_log",
    "write_run",
]
