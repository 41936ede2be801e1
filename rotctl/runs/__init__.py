"""Runs: from a config to a log and a summary row, and back from the log."""
