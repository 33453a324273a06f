"""Gear trains: bodies and meshes, dynamic increments, natural modes, spectra, forces on teeth."""
