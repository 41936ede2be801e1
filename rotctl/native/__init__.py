"""What is compiled: one library of C, and the door to it."""

from rotctl.native.library import functions, library

__all__ = ["functions", "library"]
