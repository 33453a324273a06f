"""From a case's pair to what ANSI/AGMA 2101 rates, in the words of ISO 6336 that the case is written in."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.formulas.agma.agma2101 import (
    HARD_CASES,
    RECALLED_ROOTS,
    AllowableStress,
    Service,
    Treatment,
    allowable_stress,
)
from fegear.formulas.agma.agma2101_factors import Mounting
from fegear.formulas.iso6336.part5_materials import BRINELL, HRC_30

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.case.strength import StrengthPart

#: Treatments of AGMA 2101 that materials of ISO 6336-5 are.
_TREATMENTS: dict[str, Treatment] = {
    "through-hardened-carbon-steel": "through-hardened",
    "through-hardened-alloy-steel": "through-hardened",
    "case-hardened-steel": "carburized",
    "induction-hardened-steel": "induction-hardened",
    "nitrided-nitriding-steel": "nitrided-nitralloy",
    "nitrided-through-hardening-steel": "nitrided-4140",
}
#: Quality grades of ISO 6336-5 in those of AGMA 2101, and the highest that each treatment has.
_GRADES = {"ML": 1, "MQ": 2, "ME": 3}
_HIGHEST = {
    "through-hardened": 2,
    "carburized": 3,
    "induction-hardened": 2,
    "nitrided-4140": 2,
    "nitrided-nitralloy": 2,
}
#: Transmission accuracy levels that its K_v knows, and the most load cycles of its curves.
_LEVELS, _LONGEST = (6, 12), 1e10
#: R_z of a flank over its R_a.
_RZ_PER_RA = 6.0
#: Reliabilities between which no printed Y_Z was at hand.
_ABOVE_MEDIAN, _USUAL_TABLE = 0.5, 0.9


@dataclass(frozen=True)
class AgmaInputs:
    """What `fegear.formulas.agma.agma2101.rate` takes; pairs are those of pinion and wheel."""

    service: Service
    allowed: tuple[AllowableStress, AllowableStress]


def agma_inputs(scene: Scene, asked: PairToRate) -> tuple[AgmaInputs | None, tuple[str, ...]]:
    """What AGMA 2101 is asked for a pair, or None; and sentences about what was assumed, or why there is nothing."""
    part, geometry, duty = scene.case.pair[asked.name], asked.conditions.geometry, asked.conditions.duty
    if geometry.internal:
        return None, (f"Pair {asked.name}: AGMA 2101 not evaluated: I and J are defined for external gears only.",)
    said: list[str] = []
    allowed = []
    for i, member in enumerate(geometry.members):
        gear = asked.gears[0] if member == "driver" else asked.gears[1]
        strength = scene.case.gear[gear].strength
        if strength is None:
            return None, ()
        try:
            found = _allowed(strength, gear, said)
        except InputError as error:
            return None, (f"Pair {asked.name}: AGMA 2101 not evaluated: gear {gear}: {error}",)
        if found is None:
            why = (
                "user-defined stress limits are those of ISO 6336 (set agma_contact and agma_bending)"
                if strength.material in _TREATMENTS
                else "material not included"
            )
            return None, (f"Pair {asked.name}: AGMA 2101 not evaluated: {why} (gear {gear}, {strength.material}).",)
        allowed.append(found.reversed_bending if asked.stress_ratio[i] < 0.0 else found)
    if allowed[1].treatment == "through-hardened" and allowed[0].treatment in HARD_CASES:
        said.append(
            assuming(
                f"Pair {asked.name}: Z_W of AGMA 2101 (through-hardened driven gear, surface-hardened pinion) is "
                "not verified against a printed source."
            )
        )
    if _ABOVE_MEDIAN < scene.case.rating.reliability < _USUAL_TABLE:
        said.append(
            assuming(
                f"Pair {asked.name}: Y_Z of AGMA 2101 for reliabilities between 0.5 and 0.9 is not verified "
                "against a printed source."
            )
        )
    shafts, grade = part.shafts, max(one.grade for one in asked.conditions.quality)
    level = min(max(grade, _LEVELS[0]), _LEVELS[1])
    offset = shafts.offset / shafts.bearing_span if shafts and shafts.bearing_span else 0.0
    said.append(
        assuming(
            f"Pair {asked.name}: AGMA 2101 assumes accuracy level A_v = {level}, an enclosed commercial gear unit and "
            f"reliability {scene.case.rating.reliability:g}; K_o is K_A K_gamma."
        )
    )
    backup = [math.inf if g.rim_thickness is None else g.rim_thickness / g.depth for g in geometry.gears]
    pitch_radius = asked.pair.driver.base_radius / math.cos(asked.pair.working_pressure_angle)
    service = Service(
        tangential=asked.load * asked.pair.driver.base_radius / pitch_radius,
        speed=duty.speed * pitch_radius * geometry.gears[0].teeth / asked.pair.driver.teeth,
        cycles=(min(duty.cycles[0], _LONGEST), min(duty.cycles[1], _LONGEST)),
        accuracy=level,
        overload=duty.application_factor * duty.mesh_load_factor,
        mounting=Mounting(crowned="crowned" in asked.conditions.alignment.modification, offset_ratio=offset),
        reliability=scene.case.rating.reliability,
        backup_ratio=(backup[0], backup[1]),
        pinion_roughness=asked.conditions.quality[0].flank_roughness / _RZ_PER_RA,
        dynamic=part.operation.dynamic_factor,
        load_distribution=part.operation.face_load_factor,
    )
    return AgmaInputs(service, (allowed[0], allowed[1])), tuple(said)


def _allowed(strength: StrengthPart, gear: str, said: list[str]) -> AllowableStress | None:
    """Stress numbers of AGMA 2101; None where it has none for the material."""
    of_iso = (strength.contact, strength.bending, strength.bending_allowable)
    own = (strength.agma_contact, strength.agma_bending)
    treatment = _TREATMENTS.get(strength.material)
    if treatment is None or (None in own and any(one is not None for one in of_iso)):
        return None
    grade = min(_GRADES[strength.quality], _HIGHEST[treatment])
    if grade != _GRADES[strength.quality]:
        said.append(
            assuming(f"Gear {gear}: AGMA 2101 defines no grade 3 for {treatment} steel; grade {grade} is used.")
        )
    if treatment == "through-hardened":
        hardness = strength.hardness
        if hardness is None:
            from fegear.formulas.iso6336.part5_materials import usual_hardness

            hardness = usual_hardness(strength.material, strength.quality)
    else:
        hardness = strength.core_hardness or HRC_30
        if strength.core_hardness is None:
            said.append(
                assuming(
                    f"Gear {gear}: core hardness {HRC_30 * BRINELL:.0f} HBW assumed for AGMA 2101 (core_hardness)."
                )
            )
    found = allowable_stress(treatment, 1 if grade == 1 else 2 if grade == 2 else 3, hardness * BRINELL)
    if treatment in RECALLED_ROOTS and strength.agma_bending is None:
        said.append(
            assuming(
                f"Gear {gear}: sigma_FP = {found.bending * 1e-6:.4g} MPa ({treatment} steel) is not verified against a "
                "printed source; compare it with table 4 of ANSI/AGMA 2101-D04 and set agma_bending."
            )
        )
    return replace(found, contact=own[0] or found.contact, bending=own[1] or found.bending)
