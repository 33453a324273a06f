"""Gear trains in motion: dynamic increments, spectra, tooth forces, and motion with contact loss."""
