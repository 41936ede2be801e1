"""Files are read only if they are plain ones, and replaced whole or not at all.

What lies in a folder that came from somebody else may be a pipe that never ends, or a link
that leads out of the folder. So whatever a command finds there by itself is no link, while a
path that the user names may be one.
"""

from rotctl.files.folders import folder
from rotctl.files.reading import opened, read, text
from rotctl.files.replacement import encoded, replace, replacing, require_ending, sync

__all__ = [
    "encoded",
    "folder",
    "opened",
    "read",
    "replace",
    "replacing",
    "require_ending",
    "sync",
    "text",
]
