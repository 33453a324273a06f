"""Loaded pairs, plane (2D): compliance, load sharing, transmission error, root stress over the path of contact."""
