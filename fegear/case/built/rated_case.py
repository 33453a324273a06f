"""The hardened case of a gear's flanks, as a case file says it, for flank fracture and case depth."""

from __future__ import annotations

from fegear.base.errors import InputError, RangeError
from fegear.base.notes import assuming
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.formulas.hardened_case import HardenedCase, Profile, depth_of
from fegear.formulas.iso6336.part5_materials import usual_hardness

#: Materials whose hardness falls from the surface to the core.
_SURFACE_HARDENED = ("case-hardened", "induction-hardened", "nitrided", "nitrocarburized")


def gear_case(scene: Scene, gear: str, said: list[str]) -> HardenedCase:
    """Hardness and residual stress below a gear's flanks; what had to be assumed goes to `said`.

    Raises
    ------
    InputError
        If the gear is not surface-hardened, or neither its case depth nor its profile is given.
    """
    key, part = f"gear.{gear}.strength", scene.case.gear[gear].strength
    if part is None or not part.material.startswith(_SURFACE_HARDENED):
        given = "(not given)" if part is None else f'"{part.material}"'
        raise InputError(
            f"{key}.material" if part else key, given, "has no hardened case: flank fracture applies to "
                                                       "surface-hardened teeth",
            'set material = "case-hardened-steel"',
        )  # fmt: skip
    profile = part.hardness_profile
    measured: Profile | None = None if profile is None else (tuple(profile.depth), tuple(profile.hardness))
    own = part.residual_stress
    residual: Profile | None = None if own is None else (tuple(own.depth), tuple(own.stress))
    if measured is None and part.case_depth is None:
        raise InputError(
            f"{key}.case_depth", "(not given)", "is required for flank fracture",
            'set case_depth = "0.8 mm", or hardness_profile',
        )  # fmt: skip
    if measured is not None:
        found = depth_of(measured) if part.case_depth is None else part.case_depth
        return HardenedCase(measured[1][0], part.core_hardness or measured[1][-1], found, measured, residual)
    if part.core_hardness is None:
        raise InputError(
            f"{key}.core_hardness", "(not given)", "is required: core hardness below the case",
            'set core_hardness = "32 HRC"',
        )  # fmt: skip
    surface = usual_hardness(part.material, part.quality) if part.hardness is None else part.hardness
    if part.hardness is None:
        said.append(assuming(f"Gear {gear}: hardness {surface:.4g} HV assumed (middle of the range)."))
    case = HardenedCase(surface, part.core_hardness, part.case_depth or 0.0, None, residual)
    try:
        case.hardness(0.0)
    except RangeError as error:
        raise at(key, error, {"core hardness": "core_hardness"}) from None
    return case
