"""Finite elements for gear teeth: influence functions of the whole ring at the cost of one tooth."""

from fegear.fem.gear import GearInfluence
from fegear.fem.settings import MeshSettings, settings_at
from fegear.fem.solution import Round, level_for, solve_gear, solve_to_tolerance
from fegear.fem.table import StiffnessTable, stiffness_table

__all__ = [
    "GearInfluence",
    "MeshSettings",
    "Round",
    "StiffnessTable",
    "level_for",
    "settings_at",
    "solve_gear",
    "solve_to_tolerance",
    "stiffness_table",
]
