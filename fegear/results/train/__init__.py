"""Results of a gear train: modes, forces, spectra, dynamic factor, motion."""
