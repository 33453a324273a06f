"""Gears of a case as components of REXS: teeth, tools, flanks with modifications, materials."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.exchange.rexs.teeth import MATERIALS
from fegear.geometry.gear import USUAL_RING_RIM
from fegear.geometry.internal_tooth import InternalTooth

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.case.gear import GearPart
    from fegear.case.gear_material import MaterialPart
    from fegear.case.part import Part as CasePart
    from fegear.case.reading import Scene
    from fegear.case.relief import EndReliefPart
    from fegear.exchange.rexs.written import Part, Written
    from fegear.geometry.gear import Gear


#: Keys of a gear and of its tables that are written, or have no meaning outside fegear.
_GEAR = frozenset(
    {
        "teeth", "module", "diametral_pitch", "normal_module", "normal_diametral_pitch", "pressure_angle", "rack",
        "profile_shift", "tip_diameter", "tip_chamfer", "bore_radius", "bore_diameter", "internal", "cutter",
        "face_width", "material",
        "ball_diameter", "plane", "strength", "tooth_mesh", "tooth_mesh_fillet", "relief", "lead", "roughness",
        "tolerance_class", "helix_angle", "hand", "circular_pitch", "normal_circular_pitch", "transverse_module",
        "transverse_pressure_angle", "profile_shift_sign", "tooth_thickness", "span", "span_teeth", "over_balls",
        "over_pins", "chordal_thickness", "chordal_height",
    }
)  # fmt: skip
_STRENGTH = frozenset({"material", "steel", "hardness", "core_hardness", "contact", "bending", "yield_strength"})
_RELIEF = frozenset({"tip", "root", "crowning"})
_LEAD = frozenset({"crowning", "slope", "end_relief"})
#: What a rim is where nothing is said of it [modules]; so much of a module is round-off.
_ROUNDED = 1e-9


def left_out(written: Written, where: str, part: CasePart, known: Iterable[str]) -> None:
    """Remark on the keys of a table that are given and have no attribute here."""
    lost = sorted(key for key in part.model_fields_set.difference(known) if getattr(part, key) not in (None, [], {}))
    if lost:
        written.remarks.append(f"{where}: {', '.join(lost)} not written to REXS.")


def write_gear(written: Written, scene: Scene, name: str) -> Part:
    """A gear with its flanks, tool and material.

    Parameters
    ----------
    written : Written
    scene : Scene
    name : str
    """
    gear, part = scene.gears[name], scene.case.gear[name]
    rim = 0.0 if part.rim_thickness is None else part.rim_thickness / gear.module
    outer = part.outer_radius
    if part.internal and outer is None and rim and abs(rim - USUAL_RING_RIM) > _ROUNDED:
        outer = gear.root_radius + rim * gear.module
    usual = {"rim_thickness", "outer_radius"} if part.internal else set()
    left_out(written, f"Gear {name}", part, _GEAR | usual)
    made = written.part("ring_gear" if part.internal else "cylindrical_gear", name)
    sign = -1.0 if part.hand == "left" else 1.0
    made.say(
        "length", normal_module=gear.module, face_width=gear.face_width, inner_diameter=_twice(part.bore),
        outer_diameter=_twice(outer),        tip_diameter=_tip(gear, part),
    )  # fmt: skip
    made.say("number", number_of_teeth=float(part.teeth))
    made.say("angle", helix_angle_reference_diameter=sign * gear.tooth.helix_angle if part.has_helix else None)
    if part.tolerance_class is not None:
        made.word(tolerance_class_according_to_iso_1328_2013=str(part.tolerance_class))
    if (rough := part.roughness) is not None:
        made.say(
            "small length", arithmetic_average_roughness_flank=rough.flank,
            arithmetic_average_roughness_root=rough.root, averaged_peak_to_valley_height_flank=rough.flank_rz,
            averaged_peak_to_valley_height_root=rough.root_rz,
        )  # fmt: skip
    flanks = [_flank(written, gear, part, f"{name}, {side}") for side in ("left", "right")]
    written.relate("flank", gear=made, left=flanks[0], right=flanks[1])
    _tool(written, gear, part, flanks)
    if gear.shaped:
        written.remarks.append(f"Gear {name}: fillet not written to REXS (tool only).")
    _modifications(written, name, part, flanks)
    _material(written, name, part, made)
    return made


def _twice(radius: float | None) -> float | None:
    return None if radius is None else 2.0 * radius


def _tip(gear: Gear, part: GearPart) -> float | None:
    """Tip diameter where it is given, or not that of an addendum of one module."""
    if part.tip_diameter is not None or part.internal:
        return 2.0 * gear.tip_radius
    addendum = part.rack.build(part.pressure_angle, gear.module).addendum
    return None if abs(addendum - 1.0) < _ROUNDED else 2.0 * gear.tip_radius


def _flank(written: Written, gear: Gear, part: GearPart, name: str) -> Part:
    made = written.part("cylindrical_gear_flank", name)
    stock = part.rack.grinding_allowance * gear.module
    made.say("angle", normal_pressure_angle=part.pressure_angle)
    made.say("number", addendum_modification_coefficient=part.x)
    return made.say("length", tooth_tip_chamfer=part.tip_chamfer or None, grinding_allowance=stock or None)


def _tool(written: Written, gear: Gear, part: GearPart, flanks: list[Part]) -> None:
    if part.cutter is not None and isinstance(gear.tooth, InternalTooth):
        cutter = gear.tooth.cutter
        made = written.part("cutter_wheel_tool").say(
            "number", number_of_teeth=float(cutter.teeth), addendum_modification_coefficient=cutter.profile_shift,
            addendum_coefficient_reference_profile=cutter.addendum, tip_radius_factor=cutter.tip_radius,
        )  # fmt: skip
        if part.cutter.root_diameter is not None:
            written.remarks.append(f"Gear {flanks[0].name}: cutter.root_diameter not written to REXS.")
    else:
        rack = part.rack.build(part.pressure_angle, gear.module)
        made = written.part("rack_shaped_tool").say(
            "number", addendum_coefficient_reference_profile=rack.dedendum, tip_radius_factor=rack.tip_radius,
            dedendum_coefficient_reference_profile=rack.addendum, protuberance_amount_factor=rack.protuberance or None,
        )  # fmt: skip
        made.say("angle", protuberance_angle=rack.protuberance_angle if rack.protuberance else None)
    made.say("length", normal_module=gear.module).say("angle", normal_pressure_angle=part.pressure_angle)
    settings = written.part("cylindrical_gear_manufacturing_settings")
    for flank in flanks:
        written.relate("manufacturing_step", 1, workpiece=flank, tool=made, manufacturing_settings=settings)


def _modifications(written: Written, name: str, part: GearPart, flanks: list[Part]) -> None:
    """Reliefs and crowns that REXS has components for."""
    made: list[Part] = []
    if (relief := part.relief) is not None:
        left_out(written, f"Gear {name}, relief", relief, _RELIEF)
        for end, parts in (("tip", relief.tip), ("root", relief.root)):
            made += [found for one in parts if (found := _end_relief(written, name, end, one)) is not None]
        for crown in relief.crowning:
            left_out(written, f"Gear {name}, relief.crowning", crown, {"amount"})
            made.append(
                written.part("profile_crowning").say(
                    "length", profile_crowning_at_tip=crown.amount, profile_crowning_at_root=crown.amount
                )
            )
    if (lead := part.lead) is not None:
        left_out(written, f"Gear {name}, lead", lead, _LEAD)
        if lead.crowning:
            made.append(
                written.part("helix_crowning").say(
                    "length", helix_crowning_amount_datum_face=lead.crowning,
                    helix_crowning_amount_non_datum_face=lead.crowning,
                )
            )  # fmt: skip
        if lead.slope:
            made.append(written.part("helix_slope").say("length", helix_slope=lead.slope))
        for relieved in lead.end_relief:
            for end, face in (("I", "datum_face"), ("II", "non_datum_face")):
                if relieved.end in (end, "both"):
                    relief_there = {
                        f"end_relief_depth_{face}": relieved.amount, f"end_relief_length_{face}": relieved.length,
                    }  # fmt: skip
                    found = written.part(f"end_relief_{face}").say("length", **relief_there)
                    made.append(found.word(shape_of_relief=relieved.shape))
    for one in made:
        for flank in flanks:
            written.relate("reference", origin=flank, referenced=one)


def _end_relief(written: Written, name: str, end: str, relief: EndReliefPart) -> Part | None:
    known = {"amount", "start_radius", "length", "shape"}
    if relief.amount is None or (relief.start_radius is None and relief.length is None):
        written.remarks.append(
            f"Gear {name}, relief.{end}: not written to REXS, which requires an amount, and start_radius or length."
        )
        return None
    left_out(written, f"Gear {name}, relief.{end}", relief, known)
    made = written.part(f"{end}_relief").say("length", **{f"{end}_relief_depth": relief.amount})
    made.say("length", **{f"{end}_relief_datum_diameter": _twice(relief.start_radius)})
    made.say("length", **{f"{end}_relief_datum_length": relief.length})
    return made.word(shape_of_relief=relief.shape)


def write_elasticity(made: Part, material: MaterialPart) -> Part:
    """Young's modulus, density and Poisson's ratio of a material, where a case gives them."""
    given = material.model_fields_set
    made.say("stress", elastic_modulus=material.young_modulus if "young_modulus" in given else None)
    made.say("density", density=material.density if "density" in given else None)
    return made.say("number", poisson_ratio=material.poisson_ratio if "poisson_ratio" in given else None)


def _material(written: Written, name: str, part: GearPart, gear: Part) -> None:
    strength = part.strength
    if strength is None and not part.material.model_fields_set:
        return
    made = write_elasticity(written.part("material", f"{name}, material"), part.material)
    written.relate("reference", origin=gear, referenced=made)
    if strength is None:
        return
    left_out(
        written, f"Gear {name}, strength", strength, _STRENGTH | (set() if strength.quality != "MQ" else {"quality"})
    )
    kind = next((rexs for rexs, case in MATERIALS.items() if case == strength.material), None)
    if kind is None:
        written.remarks.append(f"Gear {name}: material type {strength.material} is not defined in REXS.")
    made.word(heat_treated_material_type_iso_6336_2019=kind)
    made.say("hardness", surface_hardness_vickers=strength.hardness, core_hardness_vickers=strength.core_hardness)
    made.say(
        "stress",
        allowable_stress_number_contact_iso_6336_2016=_or_none(strength.contact),
        nominal_stress_number_tooth_root_iso_6336_2016=_or_none(strength.bending),
        yield_strength=_or_none(strength.yield_strength),
    )


def _or_none(value: float | None) -> float | None:
    return None if value is None or math.isnan(value) else value
