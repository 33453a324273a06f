"""Ratings by ISO 6336 of arrays of pairs, hundreds of thousands a second: the numbers of `formulas/iso6336`."""
