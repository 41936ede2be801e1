"""Many runs read back: the runs below a folder as one table, and what they are to show."""
