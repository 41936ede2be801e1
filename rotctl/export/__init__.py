"""A logged run in the formats of other programs; nothing is simulated again.

``export`` writes one of ``FORMATS``. The model in a log may be a stranger's: it is loaded as for
pictures, by `rotctl.report.stored_model`.
"""

from rotctl.export.formats import FORMATS, export

__all__ = ["FORMATS", "export"]
