"""Case files: a schema for each table, what is checked in it, and the objects that it describes."""
