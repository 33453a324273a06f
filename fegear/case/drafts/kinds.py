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

#: What gearboxes of several stages are called.
TWO_STAGES, THREE_STAGES = "two-stage-gearbox", "three-stage-gearbox"
#: Stages of each kind of gearbox.
STAGES: Mapping[str, int] = MappingProxyType({"gearbox": 1, TWO_STAGES: 2, THREE_STAGES: 3})

#: Kinds by name.
KINDS: Mapping[str, Kind] = MappingProxyType({
    "gear": Kind("gear: tooth stiffness and root stress, formulas of the standards", ("gear",), _TOOTH),
    "pair": Kind("gear pair under load: load sharing, transmission error, root stress", ("pinion", "wheel"), _RELIEVED),
    "relief": Kind("gear pair: design of profile modification", ("pinion", "wheel"),
                   ("helix_angle", *_LOADED, "lead_error")),
    "helical": Kind("helical pair: load distribution over the face width, transmission error, misalignment",
                    ("pinion", "wheel"), ("helix_angle", *_RELIEVED, "lead_error")),
    "gearbox": Kind("gearbox stage: helical pair on shafts and bearings, misalignment, load distribution, rating",
                    ("pinion", "wheel"), ("helix_angle", *_RELIEVED, "life")),
    "two-stage-gearbox": Kind("gearbox of two helical stages: three shafts, six bearings by designation, rating",
                              ("pinion_1", "wheel_1", "pinion_2", "wheel_2"), ("helix_angle", *_RELIEVED, "life")),
    "three-stage-gearbox": Kind(
        "gearbox of three helical stages: four shafts, eight bearings by designation, rating",
        ("pinion_1", "wheel_1", "pinion_2", "wheel_2", "pinion_3", "wheel_3"), ("helix_angle", *_RELIEVED, "life"),
    ),
    "train": Kind("drive train dynamics: motor, gear pair, driven machine; resonances, dynamic factor",
                  ("pinion", "wheel"), _RELIEVED),
    "planetary": Kind("planetary gear set: planet load sharing, phasing, modes, vibration", ("sun", "planet"),
                      _LOADED),
    "ring": Kind("internal gear: tooth stiffness and root stress", ("ring",),
                 ("pressure_angle", "profile_shift", "face_width")),
    "rack": Kind("rack and pinion under load: transmission error and root stress over the stroke", ("pinion",),
                 (*_TOOTH, "torque", "tip_relief", "relief_length")),
    "study": Kind("root-stress formulas compared with FE for many gears", ("gear",), _TOOTH),
})  # fmt: skip
