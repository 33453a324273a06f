"""Gears some of whose teeth differ from the others: a crack, another outline."""
