"""Tip reliefs that a shop can grind, searched for: trials, extremes between roll positions, descent, robust choice."""
