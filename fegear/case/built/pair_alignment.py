"""What K_Hbeta of ISO 6336-1 asks of a case: the pinion's shaft, what is done to the flanks, the contact pattern."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.notes import assuming, neglecting
from fegear.case.built.shafts import gearbox_of, on_shafts
from fegear.case.operation import HelixModification
from fegear.case.reading import Scene
from fegear.contact.wide.on_shafts import gaps_of_even_loads
from fegear.formulas.iso1328 import flank_tolerances
from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.geometry.pair import MEMBERS, Member
from fegear.shafts.mesh import straight_slope

if TYPE_CHECKING:
    from fegear.case.relief import LeadPart

#: The class whose helix slope a favourable contact pattern takes off.
_CLASS_5 = 5


def pair_alignment(scene: Scene, name: str, gears: Sequence[str], said: list[str]) -> Alignment:
    """What K_Hbeta by method C asks for; `gears` are pinion and wheel, what had to be assumed is `said`."""
    part = scene.case.pair[name]
    shafts, given = part.shafts, part.operation.face_load_factor
    if given is not None:
        return Alignment(face_load_factor=given)
    stated = shafts.modification if shafts else None
    modification = stated or _modification(scene, gears, said)
    crowning = None if stated else sum((lead.crowning for lead in _leads(scene, gears)), 0.0)
    if shafts is None and on_shafts(scene, name):
        computed = opened_by_shafts(scene, name)
        against = (
            None if stated else slope_against(computed, sum(slope_of_flank(scene, name, member) for member in MEMBERS))
        )
        return Alignment(modification=modification, computed=abs(computed), crowning=crowning, against=against)
    if shafts is None:
        said.append(
            neglecting(
                f"Pair {name}: no shaft data; K_Hbeta of ISO 6336 includes manufacturing misalignment f_ma only "
                "(f_sh = 0)."
            )
        )
        return Alignment(deformation=0.0, modification=modification, crowning=crowning)
    if not stated and "helix" in modification:
        said.append(
            assuming(
                f"Pair {name}: helix slope modification is assumed to compensate the shaft deformation f_sh (B_1 = "
                "0.1, ISO 6336-1, Table 8), whatever its direction and amount; with [shaft] tables both count."
            )
        )
    shaft = None
    if shafts.arrangement and shafts.bearing_span and shafts.diameter:
        shaft = PinionShaft(
            shafts.arrangement, shafts.bearing_span, shafts.offset, shafts.diameter, shafts.power_share
        )  # fmt: skip
    slope_5 = None
    if shafts.contact_pattern == "favourable":
        try:
            slope_5 = max(
                flank_tolerances(_CLASS_5, 2.0 * g.pitch_radius, g.module, g.face_width).rounded.helix_slope
                for g in (scene.gears[gear] for gear in gears)
            )
        except InputError as error:
            rule = f"uses the helix slope tolerance of class 5, which is not defined for {error.key} = {error.value}"
            key, remedy = f"pair.{name}.shafts.contact_pattern", "remove it, or set operation.face_load_factor"
            raise InputError(key, shafts.contact_pattern, rule, remedy) from None
    return Alignment(
        shaft, shafts.deformation, shafts.misalignment, modification, shafts.contact_pattern, slope_5, crowning=crowning
    )  # fmt: skip


def opened_by_shafts(scene: Scene, name: str) -> float:
    """f_sh over F_m/b: straight part of the gap that the shafts open under loads spread evenly over the faces.

    Positive where it opens towards end II.
    """
    pair = scene.pairs[name]
    shafts = gaps_of_even_loads(gearbox_of(scene), name)
    if not shafts.given:
        return 0.0
    tangential = pair.tangential_load(float(shafts.load[-1]))
    slope = float(straight_slope(shafts.height, shafts.gap[-1, 0, :, None])[0])
    return slope * pair.face_width**2 / tangential


def slope_of_flank(scene: Scene, name: str, member: Member) -> float:
    """What the helix slope of one gear of a pair opens over the common face towards end II [m]."""
    gear = scene.pairs[name].gear(member)
    lead = scene.case.gear[getattr(scene.case.pair[name], member)].lead_of(gear.tooth.working_flank)[0]
    if lead is None or not lead.slope or not scene.case.effects.relief:
        return 0.0
    return lead.slope * scene.pairs[name].face_width / gear.face_width


def slope_against(opened: float, slope: float) -> float | None:
    """What a slope towards end II takes off the gap of shafts that open to it; None without a slope [m]."""
    return -math.copysign(slope, opened * slope) if slope else None


def _modification(scene: Scene, gears: Sequence[str], said: list[str]) -> HelixModification:
    """What lead of the gears makes of the flanks, in the rows of the standard's table."""
    leads = _leads(scene, gears)
    if not leads:
        return "none"
    if not scene.case.effects.relief:
        said.append(
            neglecting("Lead modification of the gears ignored in K_Hbeta of ISO 6336 because effects.relief is off.")
        )
        return "none"
    return modification_of(
        crowned=any(lead.crowning for lead in leads), sloped=any(lead.slope for lead in leads),
        end_relief=any(lead.end_relief for lead in leads),
    )  # fmt: skip


def _leads(scene: Scene, gears: Sequence[str]) -> list[LeadPart]:
    """Leads of both gears on their working flanks, where they have one."""
    each = (scene.case.gear[gear].lead_of(scene.gears[gear].tooth.working_flank)[0] for gear in gears)
    return [lead for lead in each if lead is not None]


def modification_of(*, crowned: bool, sloped: bool, end_relief: bool) -> HelixModification:
    """The row of the table for flanks of which at least one is crowned, has a helix slope or relieved ends."""
    if sloped:
        return "helix corrected and crowned" if crowned else "helix corrected"
    if crowned:
        return "crowned for manufacture"
    return "end relief" if end_relief else "none"
