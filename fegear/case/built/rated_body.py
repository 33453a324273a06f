"""Rim and web of a gear for a rating: as the case gives them, else the rim that its bore leaves."""

from __future__ import annotations

import math

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.reading import Scene
from fegear.formulas.iso6336.pair_geometry import Body
from fegear.formulas.iso6336.part1_stiffness import pair_blank_factor
from fegear.formulas.iso6336.part3_root_stress import LEAST_RIM, SOLID_RIM


def gear_body(scene: Scene, gear: str, said: list[str], *, fixed: bool = False) -> Body:
    """Rim and web of a gear, whether it stands still; what of them the bore gives goes to `said`.

    Raises
    ------
    InputError
        If the bore leaves a rim so thin that ISO 6336-3 has no Y_B of it.
    """
    part, made = scene.case.gear[gear], scene.gears[gear]
    if made.tooth.internal:
        return Body(made.bore_radius - made.root_radius, part.web_thickness, fixed=fixed)
    rim, bored = part.rim(made.root_radius), part.bore is not None
    body = Body(rim, part.web, bored and part.body is None, fixed)
    if rim is None or part.rim_thickness is not None or part.body is not None:
        return body
    from fegear.case.built.teeth_in_shafts import cut_into

    hole = cut_into(scene, gear)
    if hole is not None:  # the material goes on below the bore, down to the hole of the shaft
        rim = made.root_radius - hole if hole > 0.0 else None
        body = Body(rim, part.web, bored=False, fixed=fixed)
    if rim is None:
        return body
    backup = rim / (made.tip_radius - made.root_radius)
    source = "bore_radius" if hole is None else "the hole of its shaft"
    told = f"{rim * 1e3:.4g} mm, {backup:.3g} of the tooth depth"
    if not backup > LEAST_RIM and hole is not None:
        raise InputError(
            f"gear.{gear}.rim_thickness", "not specified",
            f"the hole of its shaft leaves a rim of {told}; Y_B of ISO 6336-3 requires more than {LEAST_RIM:g}",
            "reduce sections.inner of the shaft, or specify rim_thickness",
        )  # fmt: skip
    if not backup > LEAST_RIM:
        raise InputError(
            f"gear.{gear}.bore_radius", f"{made.bore_radius * 1e3:.6g} mm",
            f"leaves a rim of {told}; Y_B of ISO 6336-3 requires more than {LEAST_RIM:g}",
            "reduce bore_radius, or specify the rim_thickness below the teeth",
        )  # fmt: skip
    if backup < SOLID_RIM or part.web_thickness is not None:
        said.append(assuming(f"Gear {gear}: rim thickness {told} from {source} used (rim_thickness)."))
    return body


def blank_factor(scene: Scene, name: str) -> float:
    """C_R of a pair, the mean of both gears."""
    part, module = scene.case.pair[name], scene.pairs[name].driver.module
    found = []
    for gear in (part.driver, part.driven):
        body = gear_body(scene, gear, [])
        rim = math.inf if body.rim_thickness is None else body.rim_thickness / module
        found.append((body.web_ratio(scene.gears[gear].face_width), rim))
    return pair_blank_factor(found)
