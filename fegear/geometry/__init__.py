"""Exact gear geometry: rack, generated tooth, gear and pair, spur and helical alike."""

from fegear.geometry.gear import Gear, Material
from fegear.geometry.interference import Interference, interference
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth

__all__ = ["BasicRack", "Gear", "GearPair", "Interference", "Material", "Tooth", "interference"]
