"""Result ``flank-fracture``: exposure of surface-hardened flanks over depth, and the case depth that they need."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError, InputError, RangeError
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION
from fegear.geometry.pair import MEMBERS, Member
from fegear.results.rating.rating import given, rated
from fegear.results.rating.shared_load import NotRated, external_rated_pairs, needs_shares, with_shares

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene


from fegear.results.rating.flank_fracture_data import (
    DEPTHS,
    PLACES,
    FlankFractureData,
    FlankFractureInputs,
    GearExposure,
)
from fegear.results.rating.flank_fracture_sheet import FRACTURE_SHEET

#: How deep is looked: half the tooth at the pitch circle, in normal modules.
_HALF_TOOTH = np.pi / 4.0


#: Named points lie this far inside of the path's single contact, in base pitches, where sharing jumps.
_INSIDE = 1e-9


def _inputs(scene: Scene, name: str) -> FlankFractureInputs | NotRated:
    """What the stage reads; of a pair that has no hard cases among others that have, the remark that says so."""
    others = [_described(scene, other) for other in external_rated_pairs(scene) if other != name]
    alone = not any(isinstance(other, FlankFractureInputs) for other in others)
    found = _described(scene, name)
    if isinstance(found, FlankFractureInputs):
        return replace(found, alone=alone)
    if alone:
        raise found
    return _not_rated(name, found)


def _not_rated(name: str, error: FegearError) -> NotRated:
    return NotRated(f"Flank fracture of pair {name} not evaluated: {error}")


def _described(scene: Scene, name: str) -> FlankFractureInputs | InputError:
    try:
        return _of_pair(scene, name)
    except InputError as error:
        return error


def _of_pair(scene: Scene, name: str) -> FlankFractureInputs:
    from fegear.case.built.rated_case import gear_case
    from fegear.case.built.rated_pair import pair_to_rate

    said: list[str] = []
    asked = pair_to_rate(scene, name)
    one, other = (gear_case(scene, gear, said) for gear in asked.gears)
    parts = [scene.case.gear[gear].strength for gear in asked.gears]
    materials = tuple("" if part is None else part.material for part in parts)
    qualities = tuple("MQ" if part is None else part.quality for part in parts)
    return FlankFractureInputs(
        asked, (one, other), (materials[0], materials[1]), (qualities[0], qualities[1]),
        scene.case.pair[name].iso_6336.flank_fracture_material_factor, tuple(dict.fromkeys((*asked.assumed, *said))),
    )  # fmt: skip


def _compute(inputs: FlankFractureInputs | NotRated, upstream: Upstream, _work: Work) -> FlankFractureData | NotRated:
    if isinstance(inputs, NotRated):
        return inputs
    try:
        return _below_flanks(inputs, upstream)
    except RangeError as error:  # a formula's own words, under the name of the pair
        named = at(f"pair.{inputs.asked.name}", error)
        if inputs.alone:
            raise named from None
        return _not_rated(inputs.asked.name, named)


def _below_flanks(inputs: FlankFractureInputs, upstream: Upstream) -> FlankFractureData:
    from fegear.formulas.flank_speeds import flank_speeds
    from fegear.formulas.flash_temperature import reduced_modulus
    from fegear.formulas.iso6336.part4_flank_fracture import half_width
    from fegear.formulas.iso6336.part22_micropitting import load_sharing, pressure
    from fegear.formulas.iso6336.safety import rate_pair
    from fegear.geometry.path_of_contact import path_points

    asked = with_shares(inputs.asked, upstream)
    conditions = rated(asked)
    level = max(asked.levels, key=lambda one: one.tangential, default=None)
    if level is not None:
        duty = replace(conditions.duty, tangential=level.tangential, speed=level.speed)
        conditions = replace(conditions, duty=duty)
    rating = rate_pair(conditions, given(asked))
    pair, duty = asked.pair, conditions.duty
    load = asked.load * duty.tangential / asked.conditions.duty.tangential
    inside = _INSIDE * pair.base_pitch
    shift = {"B": inside, "D": -inside}
    named = {point.letter: point.x + shift.get(point.letter[0], 0.0) for point in path_points(pair)}
    x = np.unique([*np.linspace(pair.x_start, pair.x_end, PLACES), *named.values()])
    factors = duty.application_factor * duty.mesh_load_factor
    for symbol in ("K_v", "K_Hbeta", "K_Halpha"):
        factors *= max(rating[symbol].values)
    grade = max(one.grade for one in asked.conditions.quality)
    sharing, speeds = load_sharing(pair, x, grade), flank_speeds(pair, x, 1.0)
    one, other = pair.driver.material, pair.driven.material
    modulus = reduced_modulus((one.young_modulus, other.young_modulus), (one.poisson_ratio, other.poisson_ratio))
    pressed = pressure(speeds, sharing * factors * load / pair.face_width, modulus)
    width = half_width(pressed, speeds.relative_radius, modulus)
    stress = [rating.contact_stress[asked.of(member)] for member in MEMBERS]
    gears = {member: _below(inputs, member, x, pressed, width, stress[i]) for i, member in enumerate(MEMBERS)}
    return FlankFractureData(
        {letter: int(np.searchsorted(x, place)) for letter, place in named.items()}, gears, load, x, sharing, pressed,
        width, speeds.relative_radius,
    )  # fmt: skip


def _below(
    inputs: FlankFractureInputs, member: Member, x: Array, pressed: Array, width: Array, stress: float
) -> GearExposure:
    """Exposure of one gear, and the case depths below which its case is crushed."""
    from fegear.formulas.iso6336.part4_flank_fracture import exposure
    from fegear.formulas.iso6336.part5_materials import AGMA_CRUSHING, ISO_CRUSHING, crushing_depth

    i, pair = MEMBERS.index(member), inputs.asked.pair
    gear, case = pair.gear(member), inputs.cases[i]
    deepest = _HALF_TOOTH * gear.module
    depth = deepest * np.linspace(0.0, 1.0, DEPTHS) ** 1.5  # finer where stresses change most
    hardness, residual = case.hardness(depth), case.residual_stress(depth)
    found = exposure(depth, pressed, width, hardness, residual, gear.material.poisson_ratio, inputs.material_factor)
    deep_enough = depth >= width[:, None]
    counted = np.where(deep_enough, found.exposure, -np.inf)
    load = np.where(deep_enough, found.load_stress / found.strength + CALIBRATION, -np.inf)
    place, deep = np.unravel_index(int(np.argmax(counted)), counted.shape)
    treatment = {"case-hardened-steel": "carburized", "induction-hardened-steel": "induction-hardened"}
    hardening = AGMA_CRUSHING.get(treatment.get(inputs.materials[i], ""), np.nan)
    iso = ISO_CRUSHING[inputs.qualities[i]] if inputs.materials[i] == "case-hardened-steel" else np.nan
    return GearExposure(
        found, depth, hardness, residual, counted.max(axis=1), float(x[place]), float(counted[place, deep]),
        float(load.max()), float(depth[deep]), crushing_depth(pair, stress, iso),
        crushing_depth(pair, stress, hardening),
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _inputs(scene, name)


def _present(data: FlankFractureData | NotRated, inputs: FlankFractureInputs | NotRated) -> Outcome:
    if isinstance(data, NotRated) or isinstance(inputs, NotRated):
        return Outcome(data, remarks=(data.remark,) if isinstance(data, NotRated) else ())
    return FRACTURE_SHEET.present(data, inputs)


FLANK_FRACTURE = Stage(
    subjects=external_rated_pairs,
    needs=needs_shares,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(
        Citation("iso-ts-6336-4", "material exposure over the depth below the contact"),
        Citation("johnson", "stresses below a line contact", "Eqs. 4.47 to 4.49"),
        Citation("iso-6336-5", "case depth"),
        Citation("agma-2101", "minimum effective case depth"),
    ),
    forecast=lambda _scene, _name: Forecast({"places": PLACES, "depths": DEPTHS}, 0.05),
    why_external="ISO/TS 6336-4 applies to external gears",
)
