"""AGMA 908 and ANSI/AGMA 2101: geometry factors, stresses, allowable stress numbers."""
