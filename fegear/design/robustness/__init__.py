"""Deviations of gears and housing drawn inside their tolerances, and what they do to a pair."""
