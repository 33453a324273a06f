"""What a rating assumes where a case says nothing, and what of a pair lies outside ISO 6336, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.geometry.pair import MEMBERS
from fegear.models.assumed import bore_remarks

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def assumed_of_pair(scene: Scene, name: str, said: list[str]) -> None:
    """Name what was assumed of a pair and its gears; sentences go to `said`."""
    part, pair = scene.case.pair[name], scene.pairs[name]
    operation = part.operation
    if "application_factor" not in operation.model_fields_set and not operation.spectrum:
        said.append(f"Pair {name}: K_A = 1 was assumed (operation.application_factor).")
    for gear in dict.fromkeys((part.driver, part.driven)):
        _assumed_of_gear(scene, gear, said)
    for member, gear in zip(MEMBERS, (part.driver, part.driven), strict=True):
        made = pair.gear(member)
        if made.tooth.undercut and not made.tooth.rack.residual_undercut:
            said.append(
                f"Gear {gear}: its root is undercut up to {2e3 * made.form_radius:.5g} mm of diameter; ISO 6336 is for "
                "gears without undercut, and of its factors the contact ratio alone counts it (profile_shift)."
            )
    if pair.normal_backlash < 0.0:
        said.append(
            f"Pair {name}: without allowance the teeth jam by {-pair.normal_backlash * 1e6:.2g} um along the line of "
            "action, as gears at rounded profile shifts do; it is rated without backlash."
        )


def _assumed_of_gear(scene: Scene, gear: str, said: list[str]) -> None:
    part, made = scene.case.gear[gear], scene.gears[gear]
    found = []
    if part.rack.profile is None and None in (part.rack.addendum, part.rack.dedendum, part.rack.tip_radius):
        found.append(("the rack ISO 53 C for what is not given", "rack"))
    if "young_modulus" not in part.material.model_fields_set:
        found.append((f"E = {made.material.young_modulus * 1e-9:.4g} GPa", "material.young_modulus"))
    strength = part.strength
    own = strength is not None and strength.contact and (strength.bending or strength.bending_allowable)
    if strength is not None and not own and "quality" not in strength.model_fields_set:
        found.append((f"quality {strength.quality}", "strength.quality"))
    if found:
        what, keys = (", ".join(one) for one in zip(*found, strict=True))
        said.append(f"Gear {gear}: {what} was assumed ({keys}).")
    said += bore_remarks(scene, gear)
