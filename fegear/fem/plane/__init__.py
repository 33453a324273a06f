"""The plane finite elements of a gear: one sector meshed, condensed and closed to the whole ring."""
