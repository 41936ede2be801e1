"""What can be chosen and overridden: files and words of a command line to plain, unchecked data."""
