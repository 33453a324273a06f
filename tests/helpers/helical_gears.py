"""Helical gears for tests, by the numbers that TM-107451 gives: no profile shift, an addendum of one module."""

import math

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack


def helical_gear(teeth, module, pressure_angle, helix_angle, face_width, hand, tip_radius=math.nan, **more) -> Gear:
    """A gear of the basic rack 1 / 1.25 / 0.25 (less where it does not fit) with a bore of half its root radius."""
    room = BasicRack(1.0, 1.25, 0.0, pressure_angle).full_fillet_radius
    rack = BasicRack(1.0, 1.25, min(0.25, 0.999999 * room), pressure_angle)
    tooth = Tooth(teeth, rack, tip_radius=tip_radius / module, helix_angle=helix_angle, **more)
    return Gear(tooth, module, 0.5 * tooth.root_radius * module, face_width, hand=hand)
