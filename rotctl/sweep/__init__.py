"""Many runs: which (`points`), what is left of them (`plan`), where (`engines`), with what result.

Nothing is imported here: a worker process must set up before numpy is loaded.
"""
