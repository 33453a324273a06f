"""Results of a loaded pair: load sharing, transmission error, root stress, pressure, losses."""
