"""The kinds of cases that can be drafted, and what has to be known for each."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping


class Kind(NamedTuple):
    """A kind of case.

    Attributes
    ----------
    about : str
        What it is for.
    gears : tuple of str
        Names of its gears.
    asks : tuple of str
        Names of the questions that it asks beside the numbers of teeth and the module.
    """

    about: str
    gears: tuple[str, ...]
    asks: tuple[str, ...]


_TOOTH = ("pressure_angle", "profile_shift", "rack", "face_width")
_LOADED = (*_TOOTH, "torque", "speed")

#: Kinds by name.
KINDS: Mapping[str, Kind] = MappingProxyType({
    "gear": Kind("one gear: its tooth's stiffness and root stress, and the standards' formulas", ("gear",), _TOOTH),
    "pair": Kind("a pair under load: load sharing, transmission error, root stress", ("pinion", "wheel"), _LOADED),
    "relief": Kind("a pair whose profile relief is to be designed", ("pinion", "wheel"), _LOADED),
    "helical": Kind("a helical pair and the errors of its assembly", ("pinion", "wheel"),
                    ("pressure_angle", "helix_angle", "profile_shift", "rack", "face_width")),
    "train": Kind("motor, pair and machine in motion: resonances, dynamic factor", ("pinion", "wheel"), _LOADED),
    "study": Kind("root-stress formulas against finite elements over many gears", ("gear",), _TOOTH),
})  # fmt: skip
