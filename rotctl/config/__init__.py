"""Configs: what determines a run, checked as a whole."""
