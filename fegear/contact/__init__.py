"""Loaded teeth: compliance sources, load sharing, transmission error, spacing errors, root-stress histories."""
