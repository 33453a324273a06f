"""Sizing: variants for a requirement, what excluded the others, the Pareto front, and the best verified by FE."""
