"""Cards that decks of Abaqus and CalculiX share: what they call a gear or a rack, the material, numbers of nodes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from fegear.base.arrays import Index
from fegear.fem.plane.rack.whole_rack import held_boundary, middle_tooth
from fegear.geometry.gear import Gear
from fegear.geometry.toothed_rack import Rack


class DeckNames(NamedTuple):
    """What decks call a gear or a rack and its parts.

    Attributes
    ----------
    kind : {"gear", "rack"}
        Name of its elements and material, too.
    fixed : str
        Boundary at which it is held.
    loaded : int
        Number of the loaded tooth in names of sets: 0 of a gear, from 1 of a rack.
    """

    kind: str
    fixed: str
    loaded: int


def deck_names(gear: Gear | Rack) -> DeckNames:
    """Names of a gear or a rack."""
    if isinstance(gear, Rack):
        return DeckNames("rack", held_boundary(gear), middle_tooth(gear) + 1)
    return DeckNames("gear", "bore", 0)


def material_cards(gear: Gear | Rack) -> list[str]:
    """Cards of the material, in mm, N and MPa, up to the section that is made of it."""
    made_of, name = gear.material, deck_names(gear).kind.upper()
    return [
        f"*MATERIAL, NAME={name}",
        "*ELASTIC",
        f"{made_of.young_modulus * 1e-6:.9g}, {made_of.poisson_ratio:.9g}",
        "*DENSITY",
        f"{made_of.density * 1e-12:.9g}",
        f"*SOLID SECTION, ELSET={name}, MATERIAL={name}",
    ]


def number_lines(numbers: Index, per_line: int = 12) -> Iterator[str]:
    """Lines of numbers, separated by commas."""
    for first in range(0, len(numbers), per_line):
        yield ", ".join(map(str, numbers[first : first + per_line]))
