"""Metrics of one's own: expressions over a log."""
