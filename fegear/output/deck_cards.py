"""Cards that decks of Abaqus and CalculiX share: the material, and numbers of nodes."""

from __future__ import annotations

from collections.abc import Iterator

from fegear.base.arrays import Index
from fegear.geometry.gear import Gear


def material_cards(gear: Gear) -> list[str]:
    """Cards of the material, in mm, N and MPa, up to the section that is made of it."""
    made_of = gear.material
    return [
        "*MATERIAL, NAME=GEAR",
        "*ELASTIC",
        f"{made_of.young_modulus * 1e-6:.9g}, {made_of.poisson_ratio:.9g}",
        "*DENSITY",
        f"{made_of.density * 1e-12:.9g}",
        "*SOLID SECTION, ELSET=GEAR, MATERIAL=GEAR",
    ]


def number_lines(numbers: Index, per_line: int = 12) -> Iterator[str]:
    """Lines of numbers, separated by commas."""
    for first in range(0, len(numbers), per_line):
        yield ", ".join(map(str, numbers[first : first + per_line]))
