"""Results of helical pairs: tooth contact, contact lines, generation, vibration on bearings."""
