"""The report on many runs: a static folder of pages, pictures, replays and tables."""
