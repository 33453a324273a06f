"""Finite elements for gear teeth: influence functions of the whole ring at the price of one tooth."""

from fegear.fem.gear import GearInfluence, solve_gear
from fegear.fem.settings import MeshSettings
from fegear.fem.table import StiffnessTable, stiffness_table

__all__ = ["GearInfluence", "MeshSettings", "StiffnessTable", "solve_gear", "stiffness_table"]
