"""From a case's pair to what ISO 6336 rates: strength, quality, alignment and duty, and what had to be assumed.

What K_Hbeta of ISO 6336-1 asks of a case: the pinion's shaft, what is done to the flanks, the contact pattern.

Rim and web of a gear for a rating: as the case gives them, else the rim that its bore leaves.

How well a gear is made, for a rating by ISO 6336: class or own deviations, roughness, tip relief.

What the material of a gear bears in a rating by ISO 6336: stress numbers by name and quality, or the case's own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from fegear.base.errors import InputError
from fegear.case.built.flank_errors import Deviation, gear_deviations
from fegear.case.built.pair_inputs import gear_name
from fegear.case.built.rated_duty import (
    Level,
    assumed_of_pair,
    in_order,
    load_cycles,
    mates_of,
    refuse_fast,
    spectrum_levels,
)
from fegear.case.built.shafts import gearbox_of, on_shafts
from fegear.case.gear import GearPart
from fegear.case.operation import HelixModification
from fegear.case.pair import Width
from fegear.case.part import at
from fegear.case.planetary import set_of_pair, set_pair, set_that_shares
from fegear.case.reading import Scene
from fegear.contact.wide.on_shafts import gaps_of_even_loads
from fegear.formulas.iso1328 import flank_tolerances
from fegear.formulas.iso6336.conditions import Conditions
from fegear.formulas.iso6336.pair_geometry import Body, of_pair
from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.formulas.iso6336.part1_stiffness import pair_blank_factor
from fegear.formulas.iso6336.part3_root_stress import LEAST_RIM, SOLID_RIM
from fegear.formulas.iso6336.part5_materials import BRINELL, MATERIALS, SOFT_IRON, TOUGH_IRON, allowable, usual_hardness
from fegear.formulas.iso6336.rated import Both, Duty, Quality, Strength
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.shafts.mesh import straight_slope

#: nu_40 of ISO VG 220, which is taken where a case names no oil [m^2/s].
USUAL_VISCOSITY = 220e-6


#: R of a root whose tooth is bent alike to either side (ISO 6336-3, annex B).
_BENT = -1.2


#: What ISO 6336 says of internal teeth alone.
_RECALLED_OF_RINGS = (
    "what ISO 6336 has for internal teeth alone is recalled; q' with 1/z_n2 = 0, Y_F and Y_S at the 60 degree tangent "
    "(6.2 and 7.2 of part 3) give the printed digits of two published spur rings; Z_D = 1, Y_B of thin rims and a held "
    "ring as an infinite mass in K_v had no printed example at hand"
)


@dataclass(frozen=True)
class PairToRate:
    """A pair to be rated.

    Parameters
    ----------
    conditions : Conditions
        Of its nominal load; the pinion is the gear with fewer teeth.
    pair : GearPair
    load : float
        Nominal, along the transverse line of action [N].
    given : mapping of str to float
        K_v, K_Halpha that the case gives, by symbol.
    levels : tuple of Level
        Of the spectrum; empty without one.
    stress_ratio : (float, float)
        R of the roots of pinion and wheel: 0 of pulsating loads, -1.2 of teeth that are bent to either side alike.
    mean_stress : (float, float) or None
        Y_M that the case gives.
    life : float or None
        Of the spectrum [s].
    width : {"plane", "slices", "solid"}
        In which the pair is loaded.
    assumed : tuple of str
        Sentences about what the case does not say.
    name : str
        Of the pair.
    gears : (str, str)
        Names of driver and driven.
    misaligned : bool
        Whether the case misaligns the flanks that are computed.
    shares : str
        Planetary set whose load sharing gives K_gamma; empty where the case gives it, or the pair is of no set.
    """

    conditions: Conditions
    pair: GearPair
    load: float
    given: Mapping[str, float]
    levels: tuple[Level, ...]
    stress_ratio: Both
    mean_stress: Both | None
    life: float | None
    width: Width
    assumed: tuple[str, ...] = field(compare=False)
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)
    misaligned: bool = field(default=False, compare=False)
    shares: str = ""

    def of(self, member: Member) -> int:
        """Place of driver or driven among pinion and wheel."""
        return self.conditions.geometry.members.index(member)


def check_pair_to_rate(scene: Scene, name: str) -> None:
    """Refuse a pair that lacks what no rating can do without.

    Raises
    ------
    InputError
        With the key that is missing.
    """
    part = scene.case.pair[name]
    for gear in dict.fromkeys((part.driver, part.driven)):
        for key, why, example in (
            (
                "strength",
                "a rating needs the allowable stress numbers of the material",
                'strength = { material = "case-hardened-steel" }',
            ),
            ("face_width", "a rating is for a face", 'face_width = "20 mm"'),
        ):
            if getattr(scene.case.gear[gear], key) is None:
                raise InputError(f"gear.{gear}.{key}", "(not given)", f"is missing: {why}", f"write {example}")
    if part.normal_load(scene.pairs[name]) is None:
        raise InputError(f"pair.{name}.torque", "(not given)", "is missing, and load too", "give torque or load")
    if part.speed is None:
        rule = "is missing: dynamic factor, film and load cycles depend on it"
        raise InputError(f"pair.{name}.speed", "(not given)", rule, 'write speed = "1500 rpm"')


def pair_to_rate(scene: Scene, name: str) -> PairToRate:
    """Collect what a case says of a pair to be rated.

    Raises
    ------
    InputError
        If something is missing, or lies outside a standard; under the key of the case.
    """
    check_pair_to_rate(scene, name)
    part, pair = scene.case.pair[name], scene.pairs[name]
    said: list[str] = []
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    driver, driven = (gear_body(scene, gear, said, fixed=_stands_still(scene, name, gear)) for gear in gears)
    said += [
        f"Gear {gear}: C_R takes its inclined web for a straight one of its thickness along the axis."
        for gear in gears
        if (body := scene.gears[gear].body) is not None and body.lean
    ]
    geometry = of_pair(pair, (driver, driven))
    if geometry.internal:
        said.append(f"Pair {name}: {_RECALLED_OF_RINGS}.")
    assumed_of_pair(scene, name, said)
    names = [gears[MEMBERS.index(member)] for member in geometry.members]
    strength = tuple(gear_strength(scene, gear, said) for gear in names)
    quality = tuple(gear_quality(scene, name, gear, said) for gear in names)
    load, operation = part.normal_load(pair) or math.nan, part.operation
    tangential = pair.tangential_load(load)
    speed = (part.speed or math.nan) * pair.driver.teeth / pair.gear(geometry.members[0]).teeth
    if part.lubricant is None:
        said.append(f"Pair {name}: an oil of ISO VG 220 was assumed (lubricant).")
    viscosity = USUAL_VISCOSITY if part.lubricant is None else part.lubricant.viscosity_40
    first = geometry.members[0] == "driver"
    refuse_fast(part, pair, name)
    cycles = in_order(load_cycles(part, pair, said, name), first=first)
    duty = Duty(
        tangential, speed, cycles, viscosity, operation.application_factor, operation.k_gamma,
        meshes=mates_of(operation.loaded_per_turn, first=first),
    )  # fmt: skip
    conditions = Conditions(
        geometry, (strength[0], strength[1]), (quality[0], quality[1]), duty,
        pair_alignment(scene, name, names, said), part.iso_6336.edition or 2019, part.iso_6336.dynamic_method,
        tip_relief_factor=part.iso_6336.tip_relief_factor, required=(operation.safety_contact, operation.safety_root),
        spectrum_line=operation.spectrum_line,
    )  # fmt: skip
    given = {"K_v": operation.dynamic_factor, "K_Halpha": operation.transverse_load_factor}
    levels, life = spectrum_levels(scene, name, tangential, speed, first=first)
    idler = [operation.idler in ("both", member) for member in geometry.members]
    one, other = (_BENT * (1.0 if bent else operation.reversed_load) for bent in idler)
    own = operation.mean_stress_factor
    if levels and operation.application_factor != 1.0:
        said.append(
            f"Pair {name}: application_factor multiplies every level of the spectrum; it is 1 where these are the real "
            "loads."
        )
    if levels and (operation.idler is not None or operation.reversed_load):
        said.append(f"Pair {name}: every level of the spectrum bends the teeth to either side in the same ratio.")
    said += _of_its_set(scene, name)
    return PairToRate(
        conditions, pair, load, {key: value for key, value in given.items() if value is not None}, levels,
        (one, other), None if own is None else in_order((own[0], own[1]), first=first), life, part.width_in(pair),
        tuple(dict.fromkeys(said)), name, gears,
        scene.case.effects.misalignment
        and not (part.misalignment is None and part.line_error is None and not on_shafts(scene, name)),
        set_that_shares(scene.case, name) or "",
    )  # fmt: skip


def check_formulas(scene: Scene, name: str) -> None:
    """Refuse a pair that ISO 6336 does not rate, before anything is computed."""
    from fegear.formulas.iso6336.safety import rate_pair

    asked = pair_to_rate(scene, name)
    try:
        rate_pair(asked.conditions)
    except InputError as error:
        raise at(f"pair.{name}", error) from None


def _stands_still(scene: Scene, name: str, gear: str) -> bool:
    """Whether a gear of a pair is the ring of a planetary set that is held."""
    found = set_of_pair(scene.case, name)
    part = None if found is None else scene.case.planetary[found]
    return part is not None and part.ring == gear and part.fixed == "ring"


def _of_its_set(scene: Scene, name: str) -> list[str]:
    """What a rating takes over from the planetary set of a pair, in words."""
    found = set_of_pair(scene.case, name)
    if found is None:
        return []
    part, operation = scene.case.planetary[found], scene.case.pair[name].operation
    told = f"Pair {name} belongs to planetary set {found}"
    if operation.idler is not None:
        told += f": the planet's teeth count as bent to either side, and contacts as {operation.loaded_per_turn}"
    if set_that_shares(scene.case, name):
        told += "; K_gamma is that of its planet-load-sharing"
    elif operation.mesh_load_factor is None and part.count > 1:
        told += f"; K_gamma counts as 1, for planetary.{found}.stiffness.ring_mesh is not given"
    said = [f"{told}."]
    if part.ring is not None and not scene.pairs[name].internal and scene.case.gear[part.ring].strength is None:
        said.append(f"Pair {set_pair(found, 'ring')} is not rated: gear.{part.ring}.strength is not given.")
    return said


#: The class whose helix slope a favourable contact pattern takes off.
_CLASS_5 = 5


def pair_alignment(scene: Scene, name: str, gears: Sequence[str], said: list[str]) -> Alignment:
    """What K_Hbeta by method C asks for; `gears` are pinion and wheel, what had to be assumed is `said`."""
    part = scene.case.pair[name]
    shafts, given = part.shafts, part.operation.face_load_factor
    if given is not None:
        return Alignment(face_load_factor=given)
    modification = (shafts.modification if shafts else None) or _modification(scene, gears, said)
    if shafts is None and on_shafts(scene, name):
        return Alignment(modification=modification, computed=_of_computed_shafts(scene, name))
    if shafts is None:
        said.append(
            f"Pair {name}: no shafts were given; K_Hbeta of ISO 6336 knows the misalignment from manufacture alone "
            "(f_sh = 0)."
        )
        return Alignment(deformation=0.0, modification=modification)
    shaft = None
    if shafts.arrangement and shafts.bearing_span and shafts.diameter:
        shaft = PinionShaft(
            shafts.arrangement, shafts.bearing_span, shafts.offset, shafts.diameter, shafts.power_share
        )  # fmt: skip
    slope = None
    if shafts.contact_pattern == "favourable":
        try:
            slope = max(
                flank_tolerances(_CLASS_5, 2.0 * g.pitch_radius, g.module, g.face_width).rounded.helix_slope
                for g in (scene.gears[gear] for gear in gears)
            )
        except InputError as error:
            rule = f"takes off the helix slope of class 5, which a gear of {error.key} = {error.value} has none of"
            key, remedy = f"pair.{name}.shafts.contact_pattern", "leave it out, or give face_load_factor (operation)"
            raise InputError(key, shafts.contact_pattern, rule, remedy) from None
    return Alignment(shaft, shafts.deformation, shafts.misalignment, modification, shafts.contact_pattern, slope)


def _of_computed_shafts(scene: Scene, name: str) -> float:
    """f_sh over F_m/b: straight part of the gap that the shafts open under loads spread evenly over the faces."""
    pair = scene.pairs[name]
    shafts = gaps_of_even_loads(gearbox_of(scene), name)
    if not shafts.given:
        return 0.0
    tangential = pair.tangential_load(float(shafts.load[-1]))
    slope = float(straight_slope(shafts.height, shafts.gap[-1, 0, :, None])[0])
    return abs(slope) * pair.face_width**2 / tangential


def _modification(scene: Scene, gears: Sequence[str], said: list[str]) -> HelixModification:
    """What lead of the gears makes of the flanks, in the rows of the standard's table."""
    leads = [lead for gear in gears if (lead := scene.case.gear[gear].lead) is not None]
    if not leads:
        return "none"
    if not scene.case.effects.relief:
        said.append("The gears have a lead modification, but effects.relief is off: K_Hbeta of ISO 6336 has none.")
        return "none"
    crowned, sloped = any(lead.crowning for lead in leads), any(lead.slope for lead in leads)
    if sloped:
        return "helix corrected and crowned" if crowned else "helix corrected"
    if crowned:
        return "crowned for manufacture"
    return "end relief" if any(lead.end_relief for lead in leads) else "none"


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
    rim, bored = part.rim(made.root_radius), part.bore_radius is not None
    body = Body(rim, part.web, bored and part.body is None, fixed)
    if rim is None or part.rim_thickness is not None or part.body is not None:
        return body
    backup = rim / (made.tip_radius - made.root_radius)
    told = f"{rim * 1e3:.4g} mm, {backup:.3g} of the tooth depth"
    if not backup > LEAST_RIM:
        raise InputError(
            f"gear.{gear}.bore_radius", f"{made.bore_radius * 1e3:.6g} mm",
            f"leaves a rim of {told}, and Y_B of ISO 6336-3 holds above {LEAST_RIM:g}",
            "make the bore smaller, or give the rim_thickness of what carries the teeth",
        )  # fmt: skip
    if backup < SOLID_RIM or part.web_thickness is not None:
        said.append(f"Gear {gear}: bore_radius leaves a rim of {told}, which was taken (rim_thickness).")
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


#: What is taken where a case says nothing: Rz of flanks and fillets [m].
USUAL_FLANK, USUAL_ROOT = 4.8e-6, 20e-6


#: Deviations that a rating asks for.
_RATED: tuple[Deviation, ...] = ("base_pitch", "profile_form", "helix_slope")


#: What a gear outside the sizes of ISO 1328-1 has to say, as an example.
_OWN = 'deviations = { base_pitch = "5 um", profile_form = "4 um", helix_slope = "6 um" }'


def gear_quality(scene: Scene, name: str, gear: str, said: list[str]) -> Quality:
    """How well a gear is made; what had to be assumed goes to `said`."""
    part, made = scene.case.gear[gear], scene.gears[gear]
    grade = part.tolerance_class
    if grade is None:
        grade = max(scene.case.pair[name].iso_6336.accuracy_grade, 1)
        rest = "" if part.deviations is None else ", for what its own deviations do not say"
        said.append(
            f"Gear {gear}: tolerance class {grade} was assumed{rest}, accuracy_grade of iso_6336 (tolerance_class)."
        )
    pitch, form, slope = _deviations(part, made, grade, gear)
    rough = part.roughness
    flank, root = (None, None) if rough is None else (rough.flank_height, rough.root_height)
    if flank is None:
        said.append(f"Gear {gear}: Rz = {USUAL_FLANK * 1e6:g} um of the flanks was assumed (roughness).")
    if root is None:
        said.append(f"Gear {gear}: Rz = {USUAL_ROOT * 1e6:g} um of the fillets was assumed (roughness).")
    return Quality(
        grade, pitch, form, slope, flank or USUAL_FLANK, root or USUAL_ROOT, _tip_relief(scene, gear, part, said)
    )  # fmt: skip


def _deviations(part: GearPart, made: Gear, grade: int, gear: str) -> tuple[float, float, float]:
    """f_pb, f_falpha and f_Hbeta [m]: the gear's own, else by class."""
    try:
        found = gear_deviations(part, made, grade, _RATED, rounded=True)
    except InputError as error:
        remedy = f"give gear.{gear}.{_OWN}: a rating needs them, and no class has them for such a gear"
        error = type(error)(error.key, error.value, error.rule, remedy)
        raise at(f"gear.{gear}", error, {"normal_module": "module"} if not part.is_helical else None) from None
    return found["base_pitch"], found["profile_form"], found["helix_slope"]


def _tip_relief(scene: Scene, gear: str, part: GearPart, said: list[str]) -> float:
    """C_a that the case gives [m]; 0 without, and where the effect is off."""
    amounts = [end.amount for end in part.relief.tip if end.amount] if part.relief else []
    if not amounts:
        return 0.0
    if not scene.case.effects.relief:
        said.append(f"Gear {gear} has a relief, but effects.relief is off: its rating has none.")
        return 0.0
    return float(max(amounts))


#: Young's modulus above which a material is no iron: nodular iron has about 175 GPa (ISO 6336-2, table of Z_E) [Pa].
_STIFFEST_IRON = 190e9
#: Young's moduli below which a material is no steel, and neither steel nor iron (grey iron has 66 GPa and more) [Pa].
_SOFTEST_STEEL, _SOFTEST_METAL = 170e9, 60e9


def _refuse_soft(scene: Scene, gear: str, material: str, said: list[str]) -> None:
    """Refuse plastics under the name of a steel, whatever their own stress limits; a soft steel is `said`."""
    modulus = scene.gears[gear].material.young_modulus
    if modulus < _SOFTEST_METAL:
        raise InputError(
            f"gear.{gear}.strength.material", material,
            f"contradicts the Young's modulus of {modulus * 1e-9:.4g} GPa: life, notch and film factors of ISO 6336 "
            f"are valid for steel and iron (above {_SOFTEST_METAL * 1e-9:g} GPa), with own stress limits as well",
            "remove strength from gears of plastics, whose strength is that of VDI 2736; root-stress-history and "
            "load-sharing are valid for any material",
        )  # fmt: skip
    if MATERIALS[material] not in TOUGH_IRON | SOFT_IRON and modulus < _SOFTEST_STEEL:
        said.append(
            f"Gear {gear}: strength names {material}, but its Young's modulus of {modulus * 1e-9:.4g} GPa is below "
            "that of any steel (material)."
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
