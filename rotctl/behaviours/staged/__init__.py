"""Staged behaviours: one kind, that goes from stage to stage as the state says."""
