"""Atlases: compliance and root stress of a whole family of gears, interpolated from a few solved ones."""
