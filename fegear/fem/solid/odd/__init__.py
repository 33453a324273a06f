"""Solid gears some of whose teeth differ from the others."""
