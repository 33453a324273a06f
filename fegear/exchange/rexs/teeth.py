"""Gears of a REXS model as ``[gear.NAME]``: sizes, tools, flanks, materials.

Signs: a positive helix angle is right-handed and a profile shift thickens the tooth (ISO 21771), as in the case.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, inline, number, quantity, text
from fegear.exchange.rexs.modifications import End, modification_keys

if TYPE_CHECKING:
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.said import Said

#: Types of flanks in REXS 1.0 to 1.1 and later.
FLANKS = ("flank_geometry", "cylindrical_gear_flank")
_TOOLS = ("rack_shaped_tool", "cutter_wheel_tool")

#: What ``heat_treated_material_type_iso_6336`` says, in the words of a case (ISO 6336-5).
MATERIALS = {
    "black_malleable_cast_iron": "malleable-iron",
    "case_hardened_wrought_steel": "case-hardened-steel",
    "flame_or_induction_hardened_steel": "induction-hardened-steel",
    "grey_cast_iron": "grey-iron",
    "nitrided_steel": "nitrided-nitriding-steel",
    "nitrided_through_hardened_steel": "nitrided-through-hardening-steel",
    "nitrocaburized_wrought_steel": "nitrocarburized-steel",
    "nodular_cast_iron_ferritic_structure": "ferritic-nodular-iron",
    "nodular_cast_iron_perlitic_or_bainitic_structure": "nodular-iron",
    "normalized_cast_steel": "normalized-cast-steel",
    "normalized_wrought_low_carbon_steel": "normalized-steel",
    "through_hardened_cast_steel": "through-hardened-cast-alloy-steel",
    "through_hardened_wrought_steel": "through-hardened-alloy-steel",
}
#: Steels by their designation (EN 10084, EN ISO 683-2), where no kind of treatment is said.
_BY_NAME = (
    (r"\d+ *(Cr ?Ni ?Mo|Mn ?Cr|Mo ?Cr|Cr ?Mo ?4?S?5|Ni ?Cr)|8620|9310", "case-hardened-steel", r"^(1\d|20|21)"),
    (r"(34|36|41|42|50) ?Cr ?(Ni)? ?Mo|(30|34) ?Cr ?Ni ?Mo|4140|4340", "through-hardened-alloy-steel", ""),
    (r"\bC ?(35|40|45|50|60)E?\b", "through-hardened-carbon-steel", ""),
)
#: Rim of a ring gear of which nothing is said [modules].
_RIM = 3.5
#: Root circle over the reference circle where rims are measured, and the thinnest rim [modules].
_RING_DEDENDUM, _LEAST_RING_RIM = 1.25, 0.5
#: Its addendum, likewise [modules].
_RING_ADDENDUM = 0.85
#: Helix angles of two gears in mesh are equal to so much [rad].
_ONE_ANGLE = 1e-6
#: A surface harder than this is a hardened case [HV].
_CASE = 550.0


def gear_keys(
    said: Said, gear: Component, shift: float | None, bore: float | None, far: End | None = None
) -> tuple[Key, ...]:
    """The keys of a gear.

    Parameters
    ----------
    said : Said
    gear : Component
    shift : float or None
        Profile shift coefficient where the model leaves it to the centre distance.
    bore : float or None
        Radius of the shaft below the gear, or outer radius of that which a ring sits in [m].
    far : {"I", "II"}, optional
        End of its face that is not the datum face; without it not known.

    Raises
    ------
    InputError
        If a size is missing, or what is said of both flanks differs.
    """
    ring = gear.type == "ring_gear"
    teeth = abs(teeth_of(said, gear))
    helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    module = module_of(said, gear)
    flank = flank_of(said, gear)
    pressure = said.number(flank, "angle", "normal_pressure_angle") if flank else None
    keys = [Key("internal", "true", "type ring_gear")] if ring else []
    keys += [
        Key("teeth", str(teeth), "number_of_teeth"),
        Key("normal_module" if helix else "module", quantity(module, "mm"), "normal_module"),
        Key(
            "pressure_angle", quantity(pressure if pressure is not None else math.radians(20.0), "deg"),
            "normal_pressure_angle" if pressure is not None else "assumed: none given",
        ),
    ]  # fmt: skip
    if helix:
        keys.append(Key("helix_angle", quantity(abs(helix), "deg"), "helix_angle_reference_diameter"))
        keys.append(Key("hand", text("right" if helix > 0.0 else "left"), "its sign: positive is right-handed"))
    given = profile_shift(said, gear)
    if given is not None:
        keys.append(Key("profile_shift", number(given), "addendum_modification_coefficient"))
    elif shift is not None:
        keys.append(Key("profile_shift", number(shift), "assumed: zero backlash at the centre distance"))
    keys += _cut(said, gear, flank, module, teeth, given if given is not None else shift or 0.0, helix)
    keys += _sizes(said, gear, flank, bore, ring)
    keys += modification_keys(said, gear, flank, far)
    return (*keys, *_quality(said, gear), *material_keys(said, gear))


def teeth_of(said: Said, gear: Component) -> int:
    """Number of teeth, below zero for every ring gear: programs write it with either sign.

    Raises
    ------
    InputError
        If it is no whole number, zero, or below zero on a gear that is no ring.
    """
    teeth = said.whole(gear, "number_of_teeth")
    if gear.type == "ring_gear" and teeth:
        return -abs(teeth)
    if teeth <= 0:
        raise InputError(
            "number_of_teeth", teeth, f"is not a valid number of teeth of {gear.said}",
            "correct it (negative for ring gears only)",
        )  # fmt: skip
    return teeth


def module_of(said: Said, gear: Component) -> float:
    """Normal module [m], from the transverse one where that is given alone."""
    normal = said.number(gear, "length", "normal_module")
    transverse = said.number(gear, "length", "transverse_module") if normal is None else None
    if transverse is not None:
        helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
        normal = transverse * math.cos(helix)
    if normal is None:
        normal = said.needed(gear, "length", "normal_module")
    if not normal > 0.0:
        raise InputError(
            "normal_module", f"{normal * 1e3:g} mm", f"of {gear.said} must be positive", "correct the value"
        )
    return normal


def refuse_equal_hands(said: Said, stages: list[Stage]) -> None:
    """Refuse stages whose helices cannot mesh: those of an external pair are of opposite hands and of one angle."""
    for stage in stages:
        one, two = (said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0 for gear in stage.gears)
        if not stage.internal and abs(one + two) > _ONE_ANGLE:
            raise InputError(
                "helix_angle_reference_diameter", " and ".join(f"{math.degrees(b):.9g} deg" for b in (one, two)),
                f"cannot mesh in {stage.component.said}: helix angles must be equal and of opposite hand",
                "correct a sign or an angle",
            )  # fmt: skip


def flank_of(said: Said, gear: Component) -> Component | None:
    """The left flank, which the right one must equal in what a case knows of them."""
    left, right = (said.linked(gear, "gear", "flank", side, *FLANKS) for side in ("left", "right"))
    for name in ("addendum_modification_coefficient", "normal_pressure_angle"):
        values = [said.number(one, _KIND[name], name) for one in (*left[:1], *right[:1])]
        if None not in values and max(values, default=0.0) - min(values, default=0.0) > 1e-9:  # type: ignore[operator,type-var]  # numbers, as just asked
            raise InputError(
                name, " and ".join(f"{one:.6g}" for one in values), f"differs between the flanks of {gear.said}",
                "only symmetric teeth are supported: use the same value for both flanks",
            )  # fmt: skip
    return (*left, *right, None)[0]


_KIND = {"addendum_modification_coefficient": "number", "normal_pressure_angle": "angle"}


def profile_shift(said: Said, gear: Component) -> float | None:
    """Profile shift coefficient of the nominal tooth; None where nothing is said."""
    flank = flank_of(said, gear)
    for one in (flank, gear):
        if one is None:
            continue
        x = said.number(one, "number", "addendum_modification_coefficient")
        if x is not None:
            return x
        length = said.number(one, "length", "addendum_modification")
        if length is not None:
            return length / module_of(said, gear)
    return None


def _tool(said: Said, gear: Component, flank: Component | None) -> Component | None:
    """The first tool: that which makes the fillet."""
    found = said.linked(gear, "origin", "reference", "referenced", *_TOOLS)
    if flank is not None:
        found += said.linked(flank, "workpiece", "manufacturing_step", "tool", *_TOOLS)
    if len({one.id for one in found}) > 1:
        said.notes.append(f"{gear.said}: first of {len(found)} tools used for the fillet; others ignored.")
    return found[0] if found else None


def _in_modules(said: Said, one: Component, module: float, factor: str, length: str) -> float | None:
    value = said.number(one, "number", factor)
    absolute = said.number(one, "length", length) if value is None else None
    return value if absolute is None else absolute / module


def _cut(
    said: Said, gear: Component, flank: Component | None, module: float, teeth: int, shift: float, helix: float
) -> list[Key]:
    """Rack or cutter."""
    tool = _tool(said, gear, flank)
    if gear.type == "ring_gear":
        return [_cutter(said, tool, module, teeth)]
    tip = said.number(gear, "length", "root_diameter")
    if tool is None or tool.type == "cutter_wheel_tool":
        if tip is not None:
            dedendum = 0.5 * (module * teeth / math.cos(helix) - tip) / module + shift
            return [Key("rack", inline(dedendum=number(dedendum)), "root_diameter; tip radius of ISO 53 C assumed")]
        edge = said.number(flank, "length", "tool_edge_radius") if flank else None
        if edge is not None:
            return [
                Key("rack", inline(profile='"A"', tip_radius=number(edge / module)), "tool_edge_radius; else ISO 53 A")
            ]
        said.notes.append(f"{gear.said}: tool not specified; basic rack ISO 53 A assumed.")
        return [Key("rack", text("ISO 53 A"), "assumed: no tool and no root_diameter specified")]
    root = _in_modules(said, tool, module, "addendum_coefficient_reference_profile", "addendum_reference_profile")
    radius = _in_modules(said, tool, module, "tip_radius_factor", "tip_radius")
    extra = _in_modules(said, tool, module, "protuberance_amount_factor", "protuberance_amount")
    angle = said.number(tool, "angle", "protuberance_angle") if extra else None
    stock = said.number(flank, "length", "grinding_allowance") if flank else None
    keys = {
        "dedendum": None if root is None else number(root),
        "tip_radius": None if radius is None else number(radius),
        "protuberance": number(extra) if extra else None,
        "grinding_allowance": number(stock / module) if stock and extra else None,
        "protuberance_angle": quantity(angle, "deg") if angle else None,
    }
    missing = [key for key in ("dedendum", "tip_radius") if keys[key] is None]
    also = f"; {', '.join(missing)} of ISO 53 C assumed" if missing else ""
    return [Key("rack", inline(**keys), f"{tool.said}: addendum and tip_radius of the tool{also}")]


def _cutter(said: Said, tool: Component | None, module: float, teeth: int) -> Key:
    """The pinion cutter of a ring."""
    if tool is None or tool.type != "cutter_wheel_tool":
        count = max(min(25, teeth - 12), 8)
        return Key(
            "cutter",
            inline(teeth=str(count), addendum="1.25", tip_radius="0.2"),
            "assumed: no cutter_wheel_tool specified",
        )
    height = _in_modules(said, tool, module, "addendum_coefficient_reference_profile", "addendum_reference_profile")
    radius = _in_modules(said, tool, module, "tip_radius_factor", "tip_radius")
    shift = said.number(tool, "number", "addendum_modification_coefficient")
    made = inline(
        teeth=str(said.whole(tool, "number_of_teeth")),
        profile_shift=None if shift is None else number(shift),
        addendum=number(1.25 if height is None else height),
        tip_radius=number(0.2 if radius is None else radius),
    )
    return Key("cutter", made, tool.said)


def _sizes(said: Said, gear: Component, flank: Component | None, bore: float | None, ring: bool) -> list[Key]:
    """Tip, chamfer, bore and face width."""
    keys = []
    tip = said.number(gear, "length", "tip_diameter")
    pitch = module_of(said, gear) * abs(teeth_of(said, gear))
    if tip is not None and abs(tip) > 0.5 * pitch:
        keys.append(Key("tip_diameter", quantity(abs(tip), "mm"), "tip_diameter"))
    elif tip is not None:
        said.used.discard((gear.id, "tip_diameter"))
        said.notes.append(f"{gear.said}: tip_diameter {tip * 1e3:g} mm is not plausible and is ignored.")
    chamfer = said.number(flank, "length", "tooth_tip_chamfer") if flank else None
    if chamfer:
        keys.append(Key("tip_chamfer", quantity(chamfer, "mm"), "tooth_tip_chamfer"))
    inner = said.number(gear, "length", "inner_diameter")
    if not ring and inner:
        keys.append(Key("bore_radius", quantity(0.5 * inner, "mm"), "half inner_diameter"))
    elif not ring and bore:
        keys.append(Key("bore_radius", quantity(bore, "mm"), "assumed: radius of its shaft, or planet bore"))
    if ring and tip is None:
        # Teeth as high as the rack's would often reach into the planet's fillet.
        helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
        assumed = pitch / math.cos(helix) - 2.0 * ((profile_shift(said, gear) or 0.0) + _RING_ADDENDUM) * module_of(
            said, gear
        )
        keys.append(Key("tip_diameter", quantity(assumed, "mm"), f"assumed: addendum of {_RING_ADDENDUM:g} modules"))
    if ring:
        keys.append(_outside(said, gear, bore))
    keys.append(Key("face_width", quantity(said.needed(gear, "length", "face_width"), "mm"), "face_width"))
    return keys


def _outside(said: Said, gear: Component, around: float | None) -> Key:
    """Where a ring is held: its own outer diameter, else that of the shaft that it is one with, else an assumed rim."""
    module, helix = module_of(said, gear), said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    root = 0.5 * module * abs(teeth_of(said, gear)) / math.cos(helix) + _RING_DEDENDUM * module
    own = said.number(gear, "length", "outer_diameter")
    radius, where = (0.5 * own, "half outer_diameter") if own else (around, "outside of its shaft section")
    if radius is not None and radius > root + _LEAST_RING_RIM * module:
        return Key("outer_radius", quantity(radius, "mm"), where)
    if radius is not None:
        said.notes.append(f"{gear.said}: an outer radius of {radius * 1e3:.4g} mm leaves no rim; ignored.")
    return Key("rim_thickness", quantity(_RIM * module, "mm"), f"assumed: {_RIM:g} modules, fixed at the outside")


def _quality(said: Said, gear: Component) -> list[Key]:
    """Tolerance class and roughness."""
    accuracy = said.number(gear, "number", "tolerance_class_according_to_iso_1328_2013")
    keys = []
    if accuracy is not None:
        keys.append(Key("tolerance_class", number(accuracy), "tolerance_class_according_to_iso_1328_2013"))
    else:
        keys.append(Key("tolerance_class", "6", "assumed: no ISO 1328 class specified"))
    sizes = {
        "flank": ("arithmetic_average_roughness_flank",),
        "root": ("arithmetic_average_roughness_root",),
        "flank_rz": ("averaged_peak_to_valley_height_flank",),
        "root_rz": ("averaged_peak_to_valley_height_root",),
    }
    found = {key: said.number(gear, "length", *names) for key, names in sizes.items()}
    given = {key: quantity(value, "um") for key, value in found.items() if value}
    assumed = [
        f"{rz} assumed"
        for ra, rz, value in (("flank", "flank_rz", 4e-6), ("root", "root_rz", 16e-6))
        if ra not in given and rz not in given and given.setdefault(rz, quantity(value, "um"))
    ]
    keys.append(Key("roughness", inline(**given), ", ".join(assumed) or "roughness attributes of the gear"))
    return keys


def material_keys(said: Said, gear: Component) -> list[Key]:
    """``material`` and ``strength`` of a gear."""
    found = said.linked(gear, "origin", "reference", "referenced", "material")
    if not found:
        said.notes.append(f"{gear.said}: material not specified; case-hardened steel, quality MQ, assumed.")
        return [
            Key("material", inline(young_modulus='"206 GPa"'), "assumed: no material specified"),
            Key("strength", inline(material='"case-hardened-steel"', quality='"MQ"'), "assumed: no material specified"),
        ]
    one = found[0]
    keys = {**elasticity(said, one)}
    designation = said.word(one, "material_designation") or one.name
    hardness = _hardness(said, one, "surface")
    kind, why = _kind(said, one, designation, hardness)
    core = _hardness(said, one, "core")
    contact = said.number(
        one, "stress", "allowable_stress_number_contact_iso_6336_2016", "allowable_stress_number_contact_iso_6336_2003",
        "endurance_limit_flank",
    )  # fmt: skip
    bending = said.number(
        one, "stress", "nominal_stress_number_tooth_root_iso_6336_2016",
        "nominal_stress_number_tooth_root_iso_6336_2003", "endurance_limit_root",
    )  # fmt: skip
    limit = said.number(one, "stress", "yield_strength")
    cased = kind.startswith(("case", "induction", "nitr"))
    strength = inline(
        material=text(kind),
        quality='"MQ"',
        hardness=None if hardness is None else text(f"{hardness[0]:g} {hardness[1]}"),
        core_hardness=text(f"{core[0]:g} {core[1]}") if core and cased else None,
        contact=quantity(contact, "MPa") if contact else None,
        bending=quantity(bending, "MPa") if bending else None,
        yield_strength=quantity(limit, "MPa") if limit and not cased else None,
    )
    return [
        Key("material", inline(**keys), f"{one.said} {designation}"),
        Key("strength", strength, f"{why}; quality assumed"),
    ]


def elasticity(said: Said, one: Component) -> dict[str, str]:
    """Keys of ``material``."""
    names = (("young_modulus", "stress", "GPa", "elastic_modulus"), ("density", "density", "kg/m^3", "density"))
    keys = {}
    for key, kind, unit, name in names:
        value = said.number(one, kind, name)
        if value:
            keys[key] = quantity(value, unit)
    ratio = said.number(one, "number", "poisson_ratio")
    return keys if ratio is None else {**keys, "poisson_ratio": number(ratio)}


def _hardness(said: Said, one: Component, where: str) -> tuple[float, str] | None:
    for unit, name in (("HV", "vickers"), ("HRC", "rockwell"), ("HBW", "brinell")):
        value = said.number(one, f"hardness {unit}", f"{where}_hardness_{name}")
        if value:
            return value, unit
    return None


def _kind(said: Said, one: Component, designation: str, hardness: tuple[float, str] | None) -> tuple[str, str]:
    """Kind of material of ISO 6336-5, and why."""
    names = ("heat_treated_material_type_iso_6336_2019", "heat_treated_material_type_iso_6336_2006")
    told = said.word(one, *names)
    if told in MATERIALS:
        return MATERIALS[told], "heat_treated_material_type_iso_6336"
    for pattern, kind, begins in _BY_NAME:
        match = re.search(pattern, designation, re.IGNORECASE)
        if match and re.match(begins or ".", match[0]):
            return kind, "type assumed from the designation"
    soft = hardness is not None and hardness[0] < (_CASE if hardness[1] != "HRC" else 52.0)
    kind = "through-hardened-alloy-steel" if soft else "case-hardened-steel"
    said.notes.append(f"{one.said} {designation}: material type of ISO 6336-5 not specified; {kind} assumed.")
    return kind, "type assumed"
