"""A rack: equal sectors side by side, with two ends."""
