"""From a case's pair to what ISO 6336 rates: strength, quality, alignment and duty, and what had to be assumed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.built.gear_quality import gear_quality
from fegear.case.built.gear_strength import gear_strength, refuse_plastic
from fegear.case.built.members import gear_name
from fegear.case.built.pair_alignment import pair_alignment
from fegear.case.built.rated_body import gear_body
from fegear.case.built.rated_duty import (
    Level,
    assumed_of_pair,
    in_order,
    load_cycles,
    mates_of,
    refuse_fast,
    spectrum_levels,
)
from fegear.case.built.shafts import on_shafts
from fegear.case.halves import halves_share
from fegear.case.pair import Width
from fegear.case.part import at
from fegear.case.planetary import set_pair
from fegear.case.reading import Scene
from fegear.case.set_pairs import set_of_pair, set_that_shares
from fegear.formulas.iso6336.conditions import Conditions
from fegear.formulas.iso6336.pair_geometry import of_pair
from fegear.formulas.iso6336.rated import Both, Duty
from fegear.geometry.pair import MEMBERS, GearPair, Member

#: nu_40 of ISO VG 220, which is taken where a case names no oil [m^2/s].
USUAL_VISCOSITY = 220e-6


#: R of a root whose tooth is bent alike to either side (ISO 6336-3, annex B).
_BENT = -1.2


#: What ISO 6336 says of internal teeth alone.
_RECALLED_OF_RINGS = (
    "internal gears: c' with 1/z_n2 = 0 and Y_F, Y_S at the 60 degree tangent reproduce two published spur ring "
    "gears; Z_D = 1, Y_B for thin rims and infinite ring mass in K_v are not verified by a published example"
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
    halves : int
        1, or 2 of a double helical pair: all loads are those of one half.
    uneven : bool
        Whether the load sharing of the halves gives K_gamma.
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
    halves: int = 1
    uneven: bool = False

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
    gears = dict.fromkeys((part.driver, part.driven))
    for gear in gears:
        refuse_plastic(scene, gear)
    for gear in gears:
        for key, why, example in (
            (
                "strength",
                "required for rating (allowable stress numbers)",
                'strength = { material = "case-hardened-steel" }',
            ),
            ("face_width", "required for the rating", 'face_width = "20 mm"'),
        ):
            if getattr(scene.case.gear[gear], key) is None:
                raise InputError(f"gear.{gear}.{key}", "(not given)", f"is missing: {why}", f"set {example}")
    if part.normal_load(scene.pairs[name]) is None:
        raise InputError(
            f"pair.{name}.torque", "(not given)", "is missing, and no load is specified", "specify torque or load"
        )
    if part.speed is None:
        rule = "is required for dynamic factor, lubricant film and load cycles"
        raise InputError(f"pair.{name}.speed", "(not given)", rule, 'set speed = "1500 rpm"')


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
        assuming(f"Gear {gear}: C_R is computed for a straight web of the same axial thickness.")
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
        said.append(assuming(f"Pair {name}: oil ISO VG 220 assumed (lubricant)."))
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
        said.append(f"Pair {name}: K_A multiplies every level of the spectrum; use 1 if the levels are actual loads.")
    if levels and (operation.idler is not None or operation.reversed_load):
        said.append(f"Pair {name}: the same load ratio of alternating bending is used for all levels of the spectrum.")
    said += _of_its_set(scene, name)
    said += _of_its_halves(scene, name)
    return PairToRate(
        conditions, pair, load, {key: value for key, value in given.items() if value is not None}, levels,
        (one, other), None if own is None else in_order((own[0], own[1]), first=first), life, part.width_in(pair),
        tuple(dict.fromkeys(said)), name, gears,
        scene.case.effects.misalignment
        and not (part.misalignment is None and part.line_error is None and not on_shafts(scene, name)),
        set_that_shares(scene.case, name) or "", part.halves, halves_share(scene.case, name),
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


def _of_its_halves(scene: Scene, name: str) -> list[str]:
    """How a double helical pair is rated, in words."""
    part = scene.case.pair[name]
    if part.double_helical is None:
        return []
    source = "as specified"
    if halves_share(scene.case, name):
        source = "from its double-helical"
    elif part.operation.mesh_load_factor is None:
        source = "1 (the floating member balances both halves)"
    said = (
        f"Pair {name}: double helical, rated as one half (face width b_B) under half of the load; K_gamma {source}. "
        "Both helices count as helical gears in parallel (ISO 6336-1, not verified against a printed source)."
    )
    return [said]


def _of_its_set(scene: Scene, name: str) -> list[str]:
    """What a rating takes over from the planetary set of a pair, in words."""
    found = set_of_pair(scene.case, name)
    if found is None:
        return []
    part, operation = scene.case.planetary[found], scene.case.pair[name].operation
    told = f"Pair {name} belongs to planetary set {found}"
    if operation.idler is not None:
        told += (
            ": alternating bending of the planet teeth is included (Y_M), contacts per revolution "
            f"{operation.loaded_per_turn}"
        )
    if set_that_shares(scene.case, name):
        told += "; K_gamma from its planet-load-sharing"
    elif operation.mesh_load_factor is None and part.count > 1:
        told += f"; K_gamma = 1, planetary.{found}.stiffness.ring_mesh is not specified"
    said = [f"{told}."]
    if part.ring is not None and not scene.pairs[name].internal and scene.case.gear[part.ring].strength is None:
        said.append(f"Pair {set_pair(found, 'ring')} not rated: gear.{part.ring}.strength is not specified.")
    return said
