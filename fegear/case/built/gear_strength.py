"""What the material of a gear bears in a rating by ISO 6336: stress numbers by name and quality, or the case's own."""

from __future__ import annotations

import math

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.formulas.iso6336.part5_materials import BRINELL, MATERIALS, SOFT_IRON, TOUGH_IRON, allowable, usual_hardness
from fegear.formulas.iso6336.rated import Strength

#: Young's modulus above which a material is no iron: nodular iron has about 175 GPa (ISO 6336-2, table of Z_E) [Pa].
_STIFFEST_IRON = 190e9

#: Young's moduli below which a material is no steel, and neither steel nor iron (grey iron has 66 GPa and more) [Pa].
_SOFTEST_STEEL, _SOFTEST_METAL = 170e9, 60e9


def refuse_plastic(scene: Scene, gear: str) -> None:
    """Refuse to rate a gear that is neither steel nor iron and has no strength: no stress number would help it."""
    modulus = scene.gears[gear].material.young_modulus
    if modulus < _SOFTEST_METAL and scene.case.gear[gear].strength is None:
        raise InputError(
            f"gear.{gear}.material", f"{modulus * 1e-9:.4g} GPa",
            "is neither steel nor iron: ISO 6336 and AGMA do not rate plastic gears (VDI 2736 applies)",
            "remove rating from results; root-stress-history and load-sharing are valid for any material",
        )  # fmt: skip


def _refuse_soft(scene: Scene, gear: str, material: str, said: list[str]) -> None:
    """Refuse plastics under the name of a steel, whatever their own stress limits; a soft steel is `said`."""
    modulus = scene.gears[gear].material.young_modulus
    if modulus < _SOFTEST_METAL:
        raise InputError(
            f"gear.{gear}.strength.material", material,
            f"contradicts the Young's modulus of {modulus * 1e-9:.4g} GPa: life, notch and film factors of ISO 6336 "
            f"are valid for steel and iron (above {_SOFTEST_METAL * 1e-9:g} GPa), also with user-defined stress "
            "limits",
            "remove strength from plastic gears (VDI 2736 applies); root-stress-history and load-sharing are valid "
            "for any material",
        )  # fmt: skip
    if MATERIALS[material] not in TOUGH_IRON | SOFT_IRON and modulus < _SOFTEST_STEEL:
        said.append(
            f"Gear {gear}: strength.material is {material}, but the Young's modulus of {modulus * 1e-9:.4g} GPa is "
            "below that of any steel (material)."
        )


def gear_strength(scene: Scene, gear: str, said: list[str]) -> Strength:
    """What a gear's material bears; what had to be assumed goes to `said`."""
    part = scene.case.gear[gear].strength
    if part is None:
        raise InputError(f"gear.{gear}.strength", "(not given)", "is missing")
    _refuse_soft(scene, gear, part.material, said)
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
            said.append(assuming(f"Gear {gear}: hardness {hardness:.4g} HV assumed (middle of the range)."))
        modulus = scene.gears[gear].material.young_modulus
        if MATERIALS[part.material] in TOUGH_IRON | SOFT_IRON and modulus > _STIFFEST_IRON:
            said.append(
                f"Gear {gear}: strength.material is {part.material}, but the Young's modulus of {modulus * 1e-9:.4g} "
                "GPa is that of steel (material); cast irons have 110 to 180 GPa, which lowers the contact stress."
            )
        return Strength(
            MATERIALS[part.material], found["contact"], found["bending"], BRINELL * hardness,
            part.yield_strength or math.nan, part.tensile_strength or math.nan, part.pitting_allowed,
            (part.long_life, part.long_life),
        )  # fmt: skip
    except InputError as error:
        raise at(f"gear.{gear}.strength", error) from None
