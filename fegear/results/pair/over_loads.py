"""Loads of a pair as rows of the tables for every load."""

from __future__ import annotations

from fegear.contact.error_over_pitch import ErrorOverPitch

#: What declares the column of loads of a table for every load.
OVER_LOADS = (ErrorOverPitch, "total_load")
