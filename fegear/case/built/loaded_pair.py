"""From a pair's inputs to its engagement: compliance sources, modifications, spacing errors, effects.

What makes a pair of a case impossible to load as the case asks.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.pair_inputs import Flanks, PairInputs, gear_name, pair_inputs, refuse_formulas
from fegear.case.part import at
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.plausible_flanks import refuse_deep_relief, refuse_load, refuse_relief_elsewhere
from fegear.geometry.relief import (
    CombinedRelief,
    Crowning,
    EndRelief,
    Relief,
    crowning,
    normalised_tip_relief,
    root_relief,
    tip_relief,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.case.relief import EndReliefPart
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.pair_compliance import PairCompliance
    from fegear.fem.plane.gear import GearInfluence

    Sources = tuple[GearCompliance, GearCompliance]


def compliance_sources(asked: PairInputs, influences: Mapping[str, GearInfluence]) -> Sources:
    """The sources of driver and driven.

    Parameters
    ----------
    asked : PairInputs
    influences : mapping of str to GearInfluence
        By the gears' names; needed for ``source = "fe"``.
    """
    part, pair = asked.compliance, asked.pair
    try:
        if asked.table is not None:
            from fegear.contact.plane.table_compliance import table_sources

            return table_sources(pair, *asked.table, part.of or "tooth", part.fit or "cubic")
        if part.source != "fe":
            from fegear.contact.plane.closed_form_compliance import closed_form_compliance

            driver, driven = (closed_form_compliance(pair.gear(member), part.source) for member in MEMBERS)
            return driver, driven
    except InputError as error:
        raise at(f"pair.{asked.name}", error) if error.key.startswith("compliance") else error from None
    from fegear.contact.plane.fe_compliance import finite_element_compliance

    solved = {gear: finite_element_compliance(influences[gear]) for gear in dict.fromkeys(asked.gears)}
    first, second = (solved[gear] for gear in asked.gears)
    return first, second


def shifted_sources(asked: PairInputs, sources: Sources) -> tuple[Sources, ...]:
    """The pairs of sources that are off by their estimated errors; none where the sources state none."""
    from fegear.contact.plane.fe_compliance import FiniteElementCompliance
    from fegear.contact.plane.shifted_compliance import neighbours_shifted_by_error, shifted_by_error

    first, second = sources
    if not (isinstance(first, FiniteElementCompliance) and isinstance(second, FiniteElementCompliance)):
        return ()
    own1 = shifted_by_error(first)
    own2 = own1 if second is first else shifted_by_error(second)
    shifted: list[Sources] = [(own1, second), (first, own2)]
    if asked.effects.neighbour_coupling:
        beside1 = neighbours_shifted_by_error(first)
        shifted.append((beside1, beside1 if second is first else neighbours_shifted_by_error(second)))
    return tuple(shifted)


def engagement_at_rest(asked: PairInputs, sources: Sources) -> Engagement:
    """The engagement of a pair without modifications and errors, with the other effects of its case."""
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.pair_compliance import PairCompliance

    effects = asked.effects
    compliance = PairCompliance(asked.pair, *sources, effects.neighbour_coupling, effects.hertz, asked.nominal)
    return Engagement(compliance, corner_contact=effects.corner_contact)


# ---- modifications -----------------------------------------------------------------------------------------------
def _active_ends(pair: GearPair, member: Member) -> tuple[float, float]:
    """Radii of the active profile's ends [m], that toward the root first."""
    a, b = sorted(float(r) for r in pair.radius(np.array([pair.x_start, pair.x_end]), member))
    return (b, a) if pair.gear(member).tooth.internal else (a, b)


def build_relief(pair: GearPair, member: Member, flank: Flanks, delta: float) -> Relief:
    """Modification of one gear of a pair.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    flank : Flanks
    delta : float
        Welbourn's Delta [m], the unit of amount_over_delta.
    """
    part, gear = flank.relief, pair.gear(member)
    if part is None:
        return CombinedRelief()
    low, high = _active_ends(pair, member)
    found: list[EndRelief | Crowning] = []

    def amount(end: EndReliefPart) -> float:
        return end.amount if end.amount is not None else (end.amount_over_delta or 0.0) * delta

    for tip in part.tip:
        if tip.normalised_length is not None:
            found.append(normalised_tip_relief(pair, member, amount(tip), tip.normalised_length, tip.shape))
        else:
            found.append(
                tip_relief(
                    gear,
                    amount(tip),
                    start_roll=tip.start_roll_angle,
                    start_radius=tip.start_radius,
                    length=tip.length,
                    shape=tip.shape,
                    at_radius=tip.at_radius,
                )
            )
    found += [
        root_relief(
            gear,
            amount(root),
            end_radius=root.end_radius or low,
            start_roll=root.start_roll_angle,
            start_radius=root.start_radius,
            length=root.length,
            shape=root.shape,
        )
        for root in part.root
    ]
    found += [
        crowning(gear, crown.amount, crown.start_radius or low, crown.end_radius or high) for crown in part.crowning
    ]
    whole = CombinedRelief((*found, *flank.tables))
    first, last = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
    for one in (*found, *flank.tables):
        refuse_relief_elsewhere(one, first, last)
    refuse_deep_relief(gear, whole, first, last)
    return whole


def spaced(asked: PairInputs, engagement: Engagement) -> Engagement:
    """The engagement with the spacing errors of its gears."""
    driver, driven = asked.flanks
    return replace(engagement, driver_spacing=driver.spacing, driven_spacing=driven.spacing)


def relieved(asked: PairInputs, engagement: Engagement) -> Engagement:
    """The engagement with the reliefs of its gears.

    Raises
    ------
    InputError
        If a relief does not fit its gear; the key is the one of the case file.
    """
    from fegear.design.charts import welbourn_amount

    pair, nominal = engagement.pair, engagement.compliance.nominal_load
    delta = math.nan
    if any(flank.wants_delta for flank in asked.flanks):
        spacing = (engagement.driver_spacing, engagement.driven_spacing)
        largest = max((float(np.abs(e).max()) for e in spacing if e.size), default=0.0)
        try:
            delta = welbourn_amount(engagement, nominal, largest)
        except InputError as error:
            names = {"relief.amount": "relief.tip.amount_over_delta"}
            raise at(f"gear.{asked.gears[0]}", error, names) from None
    built: dict[Member, Relief] = {}
    for member in MEMBERS:
        flank = asked.flank(member)
        try:
            built[member] = build_relief(pair, member, flank, delta)
        except InputError as error:
            raise at(f"gear.{flank.gear}", error) from None
    return replace(engagement, driver_relief=built["driver"], driven_relief=built["driven"])


def build_loaded_pair(asked: PairInputs, at_rest: Engagement, shifted: tuple[Sources, ...] = ()) -> LoadedPair:
    """Make the engagement of a pair with the effects of its case.

    Parameters
    ----------
    asked : PairInputs
    at_rest : Engagement
        See `engagement_at_rest`; under whatever load.
    shifted : tuple of tuple of GearCompliance
        See `shifted_sources`.

    Raises
    ------
    InputError
        If a relief or an error list does not fit its gear; the key is the one of the case file.
    """
    from fegear.contact.plane.loaded_pair import LoadedPair

    effects = asked.effects
    compliance = replace(at_rest.compliance, nominal_load=asked.nominal)
    engagement = replace(at_rest, compliance=compliance)
    if effects.spacing_errors:
        engagement = spaced(asked, engagement)
    if effects.relief:
        engagement = relieved(asked, engagement)
    others = tuple(replace(engagement, compliance=_with(compliance, *pair)) for pair in shifted)
    described = tuple(dict.fromkeys(source.describe() for source in (compliance.driver, compliance.driven)))
    return LoadedPair(engagement, others, asked.loads, asked.nominal, described)


def _with(compliance: PairCompliance, driver: GearCompliance, driven: GearCompliance) -> PairCompliance:
    return replace(compliance, driver=driver, driven=driven)


def check_pair(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded as the case asks, and effects without data or data against an effect."""
    from fegear.contact.plane.meshing import refuse_gaps

    part, effects = scene.case.pair[name], scene.case.effects
    pair, key = scene.pairs[name], f"pair.{name}"
    if part.normal_load(pair) is None:
        raise InputError(f"{key}.load", "(not given)", "is required for load sharing", "specify load, loads or torque")
    refuse_gaps(pair, key, corner_contact=effects.corner_contact)
    try:
        refuse_load(pair, max(part.all_loads(pair)))
    except InputError as error:
        raise at(key, error) from None
    source = part.compliance.source
    refuse_formulas(scene, name)
    if source not in ("fe", "table"):
        _check_closed_forms(scene, name)
    if effects.neighbour_coupling and source != "fe":
        raise InputError(
            "effects.neighbour_coupling", "true", f"is not available with {key}.compliance source = \"{source}\"",
            f"set {key}.compliance.source = \"fe\", or switch the effect off",
        )  # fmt: skip
    if source == "table" and effects.hertz != "none":
        raise InputError(
            "effects.hertz", f'"{effects.hertz}"', f"has no effect: the compliance table of {key} already includes "
                                                   "the contact deformation",
            'set effects.hertz = "none"',
        )  # fmt: skip
    if source == "table" and part.compliance.of != "pair" and pair.driver.base_radius != pair.driven.base_radius:
        raise InputError(
            f"{key}.compliance.of", '"tooth"', "uses one tooth compliance for both gears, but the gears differ",
            'specify the compliance of the tooth pair and set of = "pair"',
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.spacing_errors", "true", "has no effect: no gear of this case has spacing_errors",
            f"specify gear.{part.driver}.spacing_errors, or switch the effect off",
        )  # fmt: skip
    _check_flanks(scene, name)


def _check_closed_forms(scene: Scene, name: str) -> None:
    """Refuse a formula of tooth compliance outside the range of teeth and bodies that it is made for."""
    from fegear.contact.plane.closed_form_compliance import closed_form_compliance

    source = scene.case.pair[name].compliance.source
    for member in MEMBERS:
        try:
            closed_form_compliance(scene.pairs[name].gear(member), source)
        except InputError as error:
            key, gear = f"pair.{name}.compliance.source", gear_name(scene, name, member)
            raise InputError(
                key,
                f'"{source}"',
                f"requires another gear {gear}: {error.key} = {error.value} {error.rule}",
                error.remedy,
            ) from None


def _check_flanks(scene: Scene, name: str) -> None:
    """Read reliefs and spacing errors and refuse what does not fit the teeth, before anything is solved."""
    asked = pair_inputs(scene, name)
    for member in MEMBERS if asked.effects.relief else ():
        flank = asked.flank(member)
        try:
            # What is given in Welbourn's Delta is compared with the tooth when that is known.
            build_relief(asked.pair, member, flank, 0.0)
        except InputError as error:
            raise at(f"gear.{flank.gear}", error) from None


def check_relief(scene: Scene, name: str) -> None:
    """Refuse the effect relief where no gear of the case has any: other pairs may do without."""
    part = scene.case.pair[name]
    if scene.case.effects.relief and not any(gear.relieved for gear in scene.case.gear.values()):
        raise InputError(
            "effects.relief", "true", "has no effect: no gear of this case has a relief",
            f"specify gear.{part.driver}.relief, or switch the effect off",
        )  # fmt: skip
