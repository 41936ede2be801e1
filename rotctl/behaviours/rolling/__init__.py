"""Rolls: one kind of behaviour, that goes by the phase of a turn."""
