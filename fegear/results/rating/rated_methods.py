"""Stresses and safeties of both gears of a pair by every method of a rating, side by side."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shown_as
from fegear.formulas.symbols import AGMA_2101, ISO_6336

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.built.rated_pair import PairToRate
    from fegear.formulas.iso6336.conditions import PairRating
    from fegear.formulas.iso6336.rated import Both
    from fegear.formulas.iso6336.safety import Curves, SpectrumRating
    from fegear.geometry.pair import Member
    from fegear.results.rating.rating_data import RatingData


@dataclass(frozen=True)
class Method:
    """Where stresses and safeties come from.

    Parameters
    ----------
    name, ending : str
        Of itself, and what the names of its values end with.
    contact, bending : str
        What its S_H and S_F are.
    estimated : bool
        Whether these have errors.
    """

    name: str
    ending: str
    contact: str
    bending: str
    estimated: bool = False


def _method(name: str, ending: str, flank: str, root: str = "", *, estimated: bool = False) -> Method:
    """By ISO 6336, and what is said of its safeties."""
    s_h, s_f = ISO_6336["S_H"].meaning, ISO_6336["S_F"].meaning
    return Method(name, ending, f"{s_h}{flank}", f"{s_f}{root or flank}", estimated)


@dataclass(frozen=True)
class ByMethod:
    """One gear by one method; NaN where this does not say a number."""

    by: Method
    number: int
    member: Member
    method: str = shown("", "source of the stresses")
    place: float = shown("", "driver, driven")
    contact_stress: float = shown_as(ISO_6336["sigma_H"], default=math.nan)
    contact_safety: float = shown_as(ISO_6336["S_H"], default=math.nan)
    bending_stress: float = shown_as(ISO_6336["sigma_F"], default=math.nan)
    bending_safety: float = shown_as(ISO_6336["S_F"], default=math.nan)
    contact_error: float = shown("", "estimated relative error of S_H", name="S_H_error", default=math.nan)
    bending_error: float = shown("", "estimated relative error of S_F", name="S_F_error", default=math.nan)
    contact_damage: float = shown_as(ISO_6336["damage_H"], default=math.nan)
    bending_damage: float = shown_as(ISO_6336["damage_F"], default=math.nan)
    contact_torque: float = shown_as(ISO_6336["equivalent_torque_H"], default=math.nan)
    bending_torque: float = shown_as(ISO_6336["equivalent_torque_F"], default=math.nan)
    contact_cycles: float = math.nan
    bending_cycles: float = math.nan


def methods(data: RatingData, asked: PairToRate) -> Iterator[tuple[Method, dict[str, Both]]]:
    """Every method that was asked for, ISO 6336 first, and what it says of pinion and wheel."""
    year = asked.conditions.edition
    parts = f", ISO 6336-2:{year}", f", ISO 6336-3:{year}"
    yield _method(f"ISO 6336, edition {year}", "", *parts), _of(data.formula, *_FLANKS, *_ROOTS)
    flanks = _FLANKS if computed_flanks(data) else ()  # of a plane pair nothing of the contact is computed
    if data.by_computed is not None and data.computed is not None:
        off = data.computed
        found = {**_of(data.by_computed, *flanks, *_ROOTS), "bending_error": off.bending_error}
        if flanks:
            found["contact_error"] = off.contact_error, off.contact_error
        said = " with FE load distribution", " with FE root stress"
        yield _method("computed", "_computed", *said, estimated=True), found
    if data.agma is not None:
        of, (first, second) = data.agma, map(data.agma.members.index, asked.conditions.geometry.members)
        pairs = zip((*_FLANKS, *_ROOTS), (of.contact, of.S_H, of.bending, of.S_F), strict=True)
        s_h, s_f = (f"{AGMA_2101[symbol].meaning}, AGMA 2101-D04" for symbol in ("S_H", "S_F"))
        yield Method("AGMA 2101-D04", "_agma", s_h, s_f), {key: (pair[first], pair[second]) for key, pair in pairs}
    if data.spectrum is not None:
        found = _of(data.spectrum, "contact_safety", "bending_safety", "contact_damage", "bending_damage")
        found |= _equivalent_torques(data.curves, asked)
        yield _method("ISO 6336, spectrum", "_spectrum", " under the load spectrum"), found
    if data.spectrum_computed is not None:
        said = " with load spectrum, FE load distribution of all levels", " with load spectrum, FE root stress"
        found = _of(data.spectrum_computed, *flanks[1:], _ROOTS[1])
        yield _method("FE, spectrum", "_spectrum_computed", *said), found


#: Stresses and safeties as every rating calls them.
_FLANKS, _ROOTS = ("contact_stress", "contact_safety"), ("bending_stress", "bending_safety")


def _of(rating: PairRating | SpectrumRating, *quantities: str) -> dict[str, Both]:
    return {one: getattr(rating, one) for one in quantities}


def computed_flanks(data: RatingData) -> bool:
    """Whether a load distribution is computed."""
    return data.computed is not None and data.computed.replacement.K_Hbeta is not None


def _equivalent_torques(curves: Curves, asked: PairToRate) -> dict[str, Both]:
    """Of the driver, with the damage of the spectrum, and over which load cycles."""
    from fegear.formulas.iso6336.part6_spectrum import equivalent_torque, wohler_exponent

    radius = 0.5 * asked.conditions.geometry.diameters[asked.of("driver")]
    torque = np.array([asked.halves * level.tangential * radius for level in asked.levels])
    cycles = [np.array([level.cycles[i] for level in asked.levels]) for i in (0, 1)]
    found: dict[str, Both] = {}
    for part, lines, share in (("contact", curves.contact, 0.5), ("bending", curves.bending, 1.0)):
        one, other = (
            equivalent_torque(torque, n, share * wohler_exponent(line), line.cycles[-2])
            for line, n in zip(lines, cycles, strict=True)
        )
        found[f"{part}_torque"] = one, other
        found[f"{part}_cycles"] = lines[0].cycles[-2], lines[1].cycles[-2]
    return found
