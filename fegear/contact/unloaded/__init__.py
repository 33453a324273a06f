"""Tooth contact analysis of helical pairs, aligned and misaligned."""
