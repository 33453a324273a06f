"""ISO 6336, load capacity of spur and helical gears: a file for each part of the standard and what it finds."""
