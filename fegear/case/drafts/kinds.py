"""The kinds of cases that can be drafted, and what has to be known for each."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple


class Kind(NamedTuple):
    """A kind of case.

    Attributes
    ----------
    about : str
        What it is for.
    gears : tuple of str
        Names of its gears.
    asks : tuple of str
        Names of the questions that it asks besides the numbers of teeth and the module.
    """

    about: str
    gears: tuple[str, ...]
    asks: tuple[str, ...]


_TOOTH = ("pressure_angle", "profile_shift", "rack", "face_width")

_LOADED = (*_TOOTH, "torque", "speed")

_RELIEVED = (*_LOADED, "tip_relief", "relief_length")

#: Kinds by name.
KINDS: Mapping[str, Kind] = MappingProxyType({
    "gear": Kind("one gear: its tooth's stiffness and root stress, and the standards' formulas", ("gear",), _TOOTH),
    "pair": Kind("a pair under load: load sharing, transmission error, root stress", ("pinion", "wheel"), _RELIEVED),
    "relief": Kind("a pair whose profile relief is to be designed", ("pinion", "wheel"), _LOADED),
    "helical": Kind("a helical pair: where its face carries, transmission error, errors of its assembly",
                    ("pinion", "wheel"), ("helix_angle", *_RELIEVED, "lead_error")),
    "train": Kind("motor, pair and machine in motion: resonances, dynamic factor", ("pinion", "wheel"), _RELIEVED),
    "planetary": Kind("a planetary set: load sharing of its planets, phases, modes, vibration", ("sun", "planet"),
                      _LOADED),
    "ring": Kind("a ring gear: stiffness and root stress of its internal teeth", ("ring",),
                 ("pressure_angle", "profile_shift", "face_width")),
    "study": Kind("root-stress formulas against finite elements over many gears", ("gear",), _TOOTH),
})  # fmt: skip
