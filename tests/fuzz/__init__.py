"""Hostile input, made from good input by chance: every kind of file, every option.

`make fuzz` gives 2,000 of them to the commands, each in a process of its own; see `child` for what
counts as a fault. An input is known by its seed and its number, and can be given again:
`make fuzz FUZZ='--only 0:1234'`.
"""
