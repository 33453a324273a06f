"""Where a pair's root stress comes from, as ``pair.NAME.root_stress`` says: finite elements or a formula."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.case.built.members import gear_name
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.contact.plane.compliance import RootStressInfluence
    from fegear.contact.plane.fe_compliance import SolvedTeeth
    from fegear.contact.plane.formula_root_stress import FormulaRootStress

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
    solved: Mapping[str, SolvedTeeth],
    *,
    tips: bool,
    whole: bool = False,
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
    solved : mapping of str to SolvedTeeth
        Gears solved by finite elements, or from an atlas of such, by name; needed for ``"fe"``.
    tips : bool
        Whether tip corners may touch the flank beyond the path of contact.
    whole : bool
        Whether a formula must hold on all of the flank where loads act.

    Raises
    ------
    RangeError
        If a formula that must does not, under its key in the case.
    """
    from fegear.contact.plane.fe_compliance import finite_element_compliance

    if source == FINITE_ELEMENTS:
        return finite_element_compliance(solved[gear])
    found = _formula(source, pair, member, tips)
    if whole and found.missing:
        raise _does_not_hold(found, source, name, gear)
    return found


def refuse_formulas(scene: Scene, name: str) -> None:
    """Refuse formulas of external teeth as the source of an internal pair's compliance or root stress."""
    part = scene.case.pair[name]
    if not scene.pairs[name].internal:
        return
    ring = part.driver if scene.gears[part.driver].tooth.internal else part.driven
    for key, sources in (("compliance", (part.compliance.source,)), ("root_stress", part.root_stress.source)):
        for source in sources:
            if source not in ("fe", "table"):
                raise InputError(
                    f"pair.{name}.{key}.source", f'"{source}"', f"is valid for external gears only; {ring} is internal",
                    'set source = "fe"',
                )  # fmt: skip


def check_formulas(scene: Scene, name: str, *, tips: bool) -> None:
    """Refuse a pair of which no source knows a root stress: from a few loads over each flank, then from all.

    A formula that does not hold somewhere, or anywhere, leaves blanks where another one gives values.
    """
    refuse_formulas(scene, name)
    sources, pair = scene.case.pair[name].root_stress.source, scene.pairs[name]
    if FINITE_ELEMENTS in sources:
        return
    for member in MEMBERS:
        if any(
            _formula(source, pair, member, tips, *tried).over_length for tried in ((_TRIED,), ()) for source in sources
        ):
            continue
        raise _does_not_hold(_formula(sources[0], pair, member, tips), sources[0], name, gear_name(scene, name, member))


def _formula(source: str, pair: GearPair, member: Member, tips: bool, *points: int) -> FormulaRootStress:
    from fegear.contact.plane.formula_root_stress import formula_root_stress

    own = pair.gear(member)
    low, high = sorted(float(pair.radius(x, member)) for x in (pair.x_start, pair.x_end))
    if tips:
        low, high = own.form_radius, own.involute_tip_radius
    return formula_root_stress(own, source, low, high, *points)


def _does_not_hold(found: FormulaRootStress, source: str, name: str, gear: str) -> RangeError:
    """What a formula lacks, as a refusal of its key."""
    from fegear.formulas.sources import ROOT_STRESS_SOURCES

    others = ", ".join(f'"{other}"' for other in ROOT_STRESS_SOURCES if other != source)
    rule = f"is not valid on the flank: {found.missing[0]} (gear {gear})"
    remedy = f'choose "fe" or another formula ({others})'
    return RangeError(f"pair.{name}.root_stress.source", f'"{source}"', rule, remedy)
