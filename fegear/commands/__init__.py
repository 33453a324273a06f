"""One module for each command: what it reads from the command line, and what it prints."""
