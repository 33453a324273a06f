"""The rating by ISO 6336 and AGMA 2101: safeties, factors, life."""
