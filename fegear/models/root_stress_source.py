"""Where a pair's root stress comes from, as ``pair.NAME.root_stress`` says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.part import at
from fegear.errors import RangeError
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_inputs import gear_name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.contact.compliance import RootStressInfluence
    from fegear.contact.formula_root_stress import FormulaRootStress
    from fegear.fem import GearInfluence
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member

#: Name of the source that is no formula.
FINITE_ELEMENTS = "fe"


#: Loads at which a formula is tried before anything is computed.
_TRIED = 4


def root_stress_source(
    source: str,
    name: str,
    gear: str,
    pair: GearPair,
    member: Member,
    solved: Mapping[str, GearInfluence],
    *,
    tips: bool,
) -> RootStressInfluence:
    """One gear's root stress from finite elements or from a formula.

    Parameters
    ----------
    source : str
        ``"fe"`` or the name of a formula.
    name, gear : str
        Of the pair and of the gear in the case.
    pair : GearPair
    member : {"driver", "driven"}
    solved : mapping of str to GearInfluence
        Gears solved by finite elements, by name; needed for ``"fe"``.
    tips : bool
        Whether tip corners may touch the flank beyond the path of contact.

    Raises
    ------
    RangeError
        If the formula does not hold on the part of the flank where loads act, under its key in the case.
    """
    from fegear.contact import finite_element_compliance

    if source == FINITE_ELEMENTS:
        return finite_element_compliance(solved[gear])
    return _formula(source, name, gear, pair, member, tips)


def check_formulas(scene: Scene, name: str, *, tips: bool) -> None:
    """Refuse a pair's root-stress formulas where they do not hold, from a few loads over each flank."""
    part, pair = scene.case.pair[name], scene.pairs[name]
    for source in part.root_stress.source:
        if source != FINITE_ELEMENTS:
            for member in MEMBERS:
                _formula(source, name, gear_name(scene, name, member), pair, member, tips, _TRIED)


def _formula(
    source: str, name: str, gear: str, pair: GearPair, member: Member, tips: bool, *points: int
) -> FormulaRootStress:
    from fegear.contact.formula_root_stress import formula_root_stress

    own = pair.gear(member)
    low, high = sorted(float(pair.radius(x, member)) for x in (pair.x_start, pair.x_end))
    if tips:
        low, high = own.form_radius, own.involute_tip_radius
    try:
        return formula_root_stress(own, source, low, high, *points)
    except RangeError as error:
        told = RangeError(error.key, error.value, f"{error.rule} (gear {gear})", error.remedy)
        raise at(f"pair.{name}.root_stress", told) from None
