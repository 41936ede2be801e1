"""Logs with other content than a run would give."""

from rotctl.log import SCHEMA, RunLog, write_run
from rotctl.log.schema import MODEL_PATH, WRITER_ATTRIBUTES


def changed(log, folder, arrays=(), **attributes):
    """The same log with other arrays, attributes or `model_xml`."""
    content = {name: log[name] for name in SCHEMA if name != MODEL_PATH} | dict(arrays)
    kept = {k: v for k, v in log.attributes.items() if k not in WRITER_ATTRIBUTES}
    model = attributes.pop("model_xml", log.model_xml)
    write_run(folder / "changed.h5", content, model_xml=model, attributes=kept | attributes)
    return RunLog.open(folder / "changed.h5")
