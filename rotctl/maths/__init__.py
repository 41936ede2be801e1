"""Rotations and linear algebra, to the same bits on every machine."""
