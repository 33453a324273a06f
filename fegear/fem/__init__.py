"""Finite elements for gear teeth: influence functions of the whole ring at the cost of one tooth."""
