"""Exact gear geometry: rack, generated tooth, gear and pair, spur and helical."""
