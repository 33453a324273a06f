"""Loaded pairs of plane teeth: compliance, load sharing, transmission error, root stress over the path of contact."""
