"""Criteria: what each kind of them measures of a log, and its verdict."""
