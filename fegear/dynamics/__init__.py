"""Gear trains in motion: dynamic increments, spectra, tooth forces, and motion with loss of contact."""
