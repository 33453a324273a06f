"""The parts of a case file, one file per part."""
