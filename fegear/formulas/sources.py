"""The closed-form compliance sources by the names that case files use, and what one tooth pair gives way by them.

The pair's deflection along the line of action is the sum of both teeth, both foundations and both contact approaches,
the contact's half-width being Hertz's. One tooth pair on its own: no neighbours, no load sharing.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError, RangeError
from fegear.formulas import hertz
from fegear.formulas.outcome import ComplianceSource
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair

#: Modules of the sources by their names.
_HOMES = {
    "cornell": "cornell", "weber-banaschek": "weber_banaschek", "potential-energy": "potential_energy",
    "potential-energy-simplified": "potential_energy_simplified",
}  # fmt: skip


class _Sources(Mapping[str, ComplianceSource]):
    """All sources by name, each loaded when it is asked for: a plan needs one of them."""

    def __getitem__(self, name: str) -> ComplianceSource:
        found: ComplianceSource = import_module(f"fegear.formulas.{_HOMES[name]}").SOURCE
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(_HOMES)

    def __len__(self) -> int:
        return len(_HOMES)


SOURCES: Mapping[str, ComplianceSource] = _Sources()


def source(name: str) -> ComplianceSource:
    """Return the compliance source called `name`; an unknown name is refused with the nearest known one."""
    if name not in SOURCES:
        near = difflib.get_close_matches(name, SOURCES, 1)
        raise InputError(
            "compliance.source",
            f'"{name}"',
            f"is not one of {', '.join(SOURCES)}",
            f'did you mean "{near[0]}"?' if near else "",
        )
    return SOURCES[name]


def refuse_gear(name: str, gear: Gear) -> None:
    """Refuse a gear outside the range of teeth and bodies that a source is made for, by both ends of its involute.

    Raises
    ------
    InputError
        Of the source.
    """
    source(name).tooth(gear, np.array([gear.form_radius, gear.involute_tip_radius]))


@dataclass(frozen=True, slots=True)
class PairFormulaCompliance(ReadOnlyArrays):
    """Deflection of one tooth pair over contact positions, shape (N,), per unit face width.

    Parameters
    ----------
    x : ndarray
        Distance from the pitch point along the line of action [m], positive toward the driver's tip.
    line_load : ndarray
        w [N/m].
    driver, driven : ndarray
        Tooth and foundation of each gear per unit line load [m^2/N].
    contact : ndarray
        Contact approach of both bodies divided by the load [m^2/N] (secant; it depends on the load).
    half_width : ndarray
        Hertzian half-width [m].
    """

    x: Array
    line_load: Array
    driver: Array
    driven: Array
    contact: Array
    half_width: Array

    @property
    def total(self) -> Array:
        """Deflection of the pair per unit line load [m^2/N]."""
        return self.driver + self.driven + self.contact

    @property
    def stiffness(self) -> Array:
        """Secant stiffness of the pair per unit face width [Pa]; 1e9 Pa is 1 N/(mm um)."""
        return 1.0 / self.total


def pair_compliance(
    source: ComplianceSource, pair: GearPair, x: ArrayLike, line_load: ArrayLike
) -> PairFormulaCompliance:
    """Compliance of one tooth pair at contact positions x [m] under `line_load` > 0 [N/m] along the line of action.

    Raises
    ------
    RangeError
        If a position is off a flank, a load is not positive, or the source's range does not cover a gear.
    """
    position, w = np.broadcast_arrays(np.atleast_1d(np.asarray(x, dtype=float)), np.asarray(line_load, dtype=float))
    a, b = pair.driver, pair.driven
    radii = pair.radius(position, "driver"), pair.radius(position, "driven")
    curvature = hertz.relative_curvature(
        pair.flank_curvature_radius(position, "driver"), pair.flank_curvature_radius(position, "driven")
    )
    if not np.all(w > 0.0):
        raise RangeError("line load", f"{np.min(w):.6g} N/m", "must be positive")
    modulus = 1.0 / (1.0 / a.plane_modulus + 1.0 / b.plane_modulus)
    half_width = hertz.line_contact(w, curvature, modulus).half_width
    contact = (source.contact(a, radii[0], w, half_width) + source.contact(b, radii[1], w, half_width)) / w
    driver, driven = (np.array(source.tooth(g, r).total) for g, r in zip((a, b), radii, strict=True))
    return PairFormulaCompliance(position.copy(), w.copy(), driver, driven, contact, half_width)
