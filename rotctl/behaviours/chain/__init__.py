"""Chains: one kind of behaviour, made of others that follow each other."""
