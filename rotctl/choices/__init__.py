"""What can be chosen and overridden: from files and a command line to plain data, unread as yet."""
