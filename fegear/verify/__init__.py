"""What fegear's numbers are compared with, and `fegear verify`, which repeats the comparisons."""
