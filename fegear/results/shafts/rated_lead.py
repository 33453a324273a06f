"""Safety factors of a mesh by ISO 6336 with another lead of its driver: K_Hbeta by method C follows its modification.

What a lead does to S_H and S_F is twofold in ISO 6336-1: a helix slope takes most of the shafts' misalignment off, and
crowning half of that from manufacture. A correction without the present crowning may thus lower both.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.case.built.pair_alignment import modification_of, opened_by_shafts, slope_against, slope_of_flank
from fegear.case.built.shafts import on_shafts
from fegear.case.halves import halves_share
from fegear.case.set_pairs import set_that_shares
from fegear.results.rating.rating import RATING, given, rated
from fegear.results.shafts.at_glance import safeties_on_flanks

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.operation import HelixModification
    from fegear.case.reading import Scene


@dataclass(frozen=True)
class RatedLead:
    """A mesh to be rated with another lead of its driver.

    Parameters
    ----------
    asked : PairToRate
        With the present lead.
    crowning : float
        Lead crowning of the driven gear [m].
    sloped : bool
        Whether the driven gear has a helix slope.
    end_relief : bool
        Whether either gear has one.
    stated : HelixModification or None
        What the case says of the flanks in place of their lead.
    slope : float
        What the slope of the driven gear opens over the common face towards end II [m].
    opened : float, optional
        What the shafts open to it, over the load; None where it is not computed.
    """

    asked: PairToRate
    crowning: float
    sloped: bool
    end_relief: bool
    stated: HelixModification | None
    slope: float = 0.0
    opened: float | None = None

    def modification(self, slope: float, crowning: float) -> HelixModification:
        """What this lead of the driver makes of the flanks [m]."""
        if self.stated is not None:
            return self.stated
        return modification_of(
            crowned=bool(self.crowning or crowning), sloped=self.sloped or bool(slope), end_relief=self.end_relief
        )

    def against(self, slope: float) -> float | None:
        """What this slope of the driver, and that of the driven gear, take off the gap of the shafts [m]."""
        pair = self.asked.pair
        own = slope * pair.face_width / pair.driver.face_width
        return None if self.opened is None or self.stated is not None else slope_against(self.opened, own + self.slope)


@dataclass(frozen=True)
class SafetyOfLead:
    """A mesh with one lead of its driver; NaN where it is not rated."""

    pair: str = shown("", "gear pair")
    design: str = shown("", "lead of the driver: present, or as a design of the grinding table")
    slope: float = shown("um", "helix slope modification C_Hbeta: zero at end I, this at end II")
    crowning: float = shown("um", "lead crowning C_beta")
    flanks: float = shown("", "K_Hbeta of the loaded flanks at nominal load", name="K_Hbeta")
    factor: float = shown("", "K_Hbeta of the rating (ISO 6336-1, with manufacturing deviations)",
                          name="K_Hbeta_rated", default=math.nan)  # fmt: skip
    contact: float = shown("", "lower safety factor for pitting of both gears, ISO 6336-2, at the larger K_Hbeta",
                           name="S_H", default=math.nan)  # fmt: skip
    bending: float = shown("", "lower safety factor for tooth breakage of both gears, ISO 6336-3, at the larger "
                           "K_Hbeta", name="S_F", default=math.nan)  # fmt: skip


def present_lead(scene: Scene, pair: str) -> tuple[float, float]:
    """Helix slope and crowning of the driver [m]; a lead that does not count is none that a correction adds to."""
    lead = scene.case.gear[scene.case.pair[pair].driver].lead if scene.case.effects.relief else None
    return (0.0, 0.0) if lead is None else (float(lead.slope), float(lead.crowning))


def rated_lead(scene: Scene, pair: str) -> RatedLead | None:
    """What the rating of a mesh takes; None where it is not rated, or its load is shared with other meshes."""
    from fegear.case.built.rated_pair import pair_to_rate

    if set_that_shares(scene.case, pair) or halves_share(scene.case, pair):
        return None
    try:
        if RATING.check is not None:
            RATING.check(scene, pair)
        asked = pair_to_rate(scene, pair)
    except InputError:
        return None
    part, counts = scene.case.pair[pair], scene.case.effects.relief
    leads = [scene.case.gear[gear].lead if counts else None for gear in (part.driver, part.driven)]
    ends = any(lead is not None and lead.end_relief for lead in leads)
    driven, stated = leads[1], part.shafts.modification if part.shafts else None
    opened = opened_by_shafts(scene, pair) if part.shafts is None and on_shafts(scene, pair) else None
    return RatedLead(
        asked, 0.0 if driven is None else driven.crowning, driven is not None and bool(driven.slope), ends, stated,
        slope_of_flank(scene, pair, "driven"), opened,
    )  # fmt: skip


def rated_with(lead: RatedLead, row: SafetyOfLead) -> SafetyOfLead:
    """The row with the lower safety factors of both gears, under the load spectrum where there is one.

    They contain the larger K_Hbeta, of the rating or of the loaded flanks.
    """
    from fegear.formulas.iso6336.safety import rate_pair, rate_spectrum

    asked = lead.asked
    alignment = replace(
        asked.conditions.alignment, modification=lead.modification(row.slope, row.crowning),
        crowning=None if lead.stated is not None else lead.crowning + row.crowning, against=lead.against(row.slope),
    )  # fmt: skip
    asked = replace(asked, conditions=replace(asked.conditions, alignment=alignment))
    try:
        conditions, own = rated(asked), given(asked)
        found = rate_pair(conditions, own)
        contact, bending = found.contact_safety, found.bending_safety
        if asked.levels:
            levels = [
                (
                    replace(conditions.duty, tangential=level.tangential, speed=level.speed)
                    if level.tangential else None, level.cycles,
                )
                for level in asked.levels
            ]  # fmt: skip
            spectrum = rate_spectrum(conditions, levels, own)
            contact, bending = spectrum.contact_safety, spectrum.bending_safety
    except InputError:
        return row
    factor = found["K_Hbeta"].value
    lower = safeties_on_flanks(min(contact), min(bending), factor, row.flanks)
    return replace(row, factor=factor, contact=lower[0], bending=lower[1])
