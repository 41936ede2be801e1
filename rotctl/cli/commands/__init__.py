"""The commands, a file for each group: how one is spelled stands beside what it does.

Each imports only what it needs, and where it needs it.
"""
