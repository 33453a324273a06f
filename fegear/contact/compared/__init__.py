"""Closed forms compared with finite elements: at one gear, at a pair, over a population of gears."""
