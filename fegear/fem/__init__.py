"""Finite elements for gear teeth, plane and solid: influence functions of the whole ring at the cost of one tooth."""
