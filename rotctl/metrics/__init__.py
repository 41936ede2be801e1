"""Log to numbers to verdicts."""
