"""A helical pair on its bearings: modes, force transmissibility, forced response."""
