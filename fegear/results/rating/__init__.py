"""The rating by ISO 6336 and AGMA 2101: safety factors, factors, life."""
