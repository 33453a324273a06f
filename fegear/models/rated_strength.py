"""What the material of a gear bears in a rating by ISO 6336: stress numbers by name and quality, or the case's own."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.case.part import at
from fegear.errors import InputError
from fegear.formulas.iso6336.groups import SOFT_IRON, TOUGH_IRON
from fegear.formulas.iso6336.part5_materials import BRINELL, MATERIALS, allowable, usual_hardness
from fegear.formulas.iso6336.rated import Strength

if TYPE_CHECKING:
    from fegear.case.reading import Scene

#: Young's modulus above which a material is no iron: nodular iron has about 175 GPa (ISO 6336-2, table of Z_E) [Pa].
_STIFFEST_IRON = 190e9


def gear_strength(scene: Scene, gear: str, said: list[str]) -> Strength:
    """What a gear's material bears; what had to be assumed goes to `said`."""
    part = scene.case.gear[gear].strength
    if part is None:
        raise InputError(f"gear.{gear}.strength", "(not given)", "is missing")
    found: dict[str, float] = {}
    own = part.bending if part.bending_allowable is None else 0.5 * part.bending_allowable
    try:
        for stress, given in (("contact", part.contact), ("bending", own)):
            if given is not None:
                found[stress] = given
                continue
            law = allowable(
                part.material, "contact" if stress == "contact" else "bending", part.quality, part.hardness,
                core_hardness=part.core_hardness, jominy_12=part.jominy_12,
            )  # fmt: skip
            found[stress] = law.stress
            said += [f"Gear {gear}: {one}." for one in law.remark.split("; ") if one]
        hardness = usual_hardness(part.material, part.quality) if part.hardness is None else part.hardness
        if part.hardness is None and len(found) == 2:  # of own numbers no law has said it; Z_W asks for it
            said.append(f"Gear {gear}: hardness {hardness:.4g} HV was assumed, the middle of the range.")
        modulus = scene.gears[gear].material.young_modulus
        if MATERIALS[part.material] in TOUGH_IRON | SOFT_IRON and modulus > _STIFFEST_IRON:
            said.append(
                f"Gear {gear}: strength names {part.material}, but its Young's modulus of {modulus * 1e-9:.4g} GPa is "
                "that of steel (material); irons have 110 to 180 GPa, with which the contact stress is lower."
            )
        return Strength(
            MATERIALS[part.material], found["contact"], found["bending"], BRINELL * hardness,
            part.yield_strength or math.nan, part.tensile_strength or math.nan, part.pitting_allowed,
            (part.long_life, part.long_life),
        )  # fmt: skip
    except InputError as error:
        raise at(f"gear.{gear}.strength", error) from None
