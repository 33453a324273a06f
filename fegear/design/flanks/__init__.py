"""Relief of loaded flanks in two dimensions: exact topography, what can be ground, and how each holds up."""
