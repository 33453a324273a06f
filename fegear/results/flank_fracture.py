"""Result ``flank-fracture``: exposure of surface-hardened flanks over depth, and the case depth that they need."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.errors import RangeError
from fegear.geometry.pair import MEMBERS
from fegear.results.drawn_flank_fracture import fracture_figures
from fegear.results.flank_fracture_tables import fracture_remarks, fracture_tables, fracture_values

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.formulas.hardened_case import HardenedCase
    from fegear.formulas.iso6336.part4_flank_fracture import Exposure
    from fegear.geometry.pair import Member
    from fegear.models.rated_pair import PairToRate

#: Places from A to E besides the named points, and depths.
_PLACES, _DEPTHS = 61, 241
#: How deep is looked: half the tooth at the pitch circle, in normal modules.
_HALF_TOOTH = np.pi / 4.0
#: Named points lie this far inside of the path's single contact, in base pitches, where sharing jumps.
_INSIDE = 1e-9


@dataclass(frozen=True)
class FlankFractureInputs:
    """What the stage reads.

    Parameters
    ----------
    asked : PairToRate
    cases : (HardenedCase, HardenedCase)
        Of driver and driven.
    materials, qualities : (str, str)
        As `strength` names them, of driver and driven.
    material_factor : float
        K_material.
    said : tuple of str
    """

    asked: PairToRate
    cases: tuple[HardenedCase, HardenedCase]
    materials: tuple[str, str]
    qualities: tuple[str, str]
    material_factor: float
    said: tuple[str, ...] = field(compare=False)


@dataclass(frozen=True)
class GearExposure:
    """One gear below its flank.

    Parameters
    ----------
    depth : ndarray, shape (M,)
        [m].
    hardness, residual : ndarray, shape (M,)
        [HV], [Pa].
    found : Exposure
    most : float
        A_FF,max from the depth of the half-width on.
    most_load : float
        The same without residual stress.
    place, at_depth : float
        Where it is: on the path of contact, and how deep [m].
    crushing, least_agma : float
        Eht_c of ISO 6336-5 and h_e,min of AGMA 2101 [m]; NaN where there is none for the material.
    """

    depth: Array
    hardness: Array
    residual: Array
    found: Exposure
    most: float
    most_load: float
    place: float
    at_depth: float
    crushing: float
    least_agma: float


@dataclass(frozen=True)
class FlankFractureData:
    """What the stage finds.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Places on the path of contact [m].
    points : mapping of str to int
        Named points A to E among these.
    sharing, pressure, half_width, radius : ndarray, shape (N,)
        X_CP, p_dyn,CP [Pa], b_H and relative radius [m].
    gears : mapping of Member to GearExposure
    load : float
        Along the line of action, of the spectrum's largest level where there is one [N].
    """

    x: Array
    points: dict[str, int]
    sharing: Array
    pressure: Array
    half_width: Array
    radius: Array
    gears: dict[Member, GearExposure]
    load: float


def _inputs(scene: Scene, name: str) -> FlankFractureInputs:
    from fegear.models.rated_case import gear_case
    from fegear.models.rated_pair import pair_to_rate

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


def _compute(inputs: FlankFractureInputs, _upstream: Upstream, _work: Work) -> FlankFractureData:
    from fegear.formulas.flank_speeds import flank_speeds
    from fegear.formulas.flash_temperature import reduced_modulus
    from fegear.formulas.iso6336.part4_flank_fracture import half_width
    from fegear.formulas.iso6336.part22_micropitting import load_sharing, pressure
    from fegear.formulas.iso6336.safety import rate_pair
    from fegear.geometry.path_of_contact import path_points
    from fegear.results.rating import given, rated

    asked = inputs.asked
    try:
        conditions = rated(asked)
        level = max(asked.levels, key=lambda one: one.tangential, default=None)
        if level is not None:
            duty = replace(conditions.duty, tangential=level.tangential, speed=level.speed)
            conditions = replace(conditions, duty=duty)
        rating = rate_pair(conditions, given(asked))
    except RangeError as error:
        raise at(f"pair.{asked.name}", error) from None
    pair, duty = asked.pair, conditions.duty
    load = asked.load * duty.tangential / asked.conditions.duty.tangential
    inside = _INSIDE * pair.base_pitch
    shift = {"B": inside, "D": -inside}
    named = {point.letter: point.x + shift.get(point.letter[0], 0.0) for point in path_points(pair)}
    x = np.unique([*np.linspace(pair.x_start, pair.x_end, _PLACES), *named.values()])
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
        x, {letter: int(np.searchsorted(x, place)) for letter, place in named.items()}, sharing, pressed, width,
        speeds.relative_radius, gears, load,
    )  # fmt: skip


def _below(
    inputs: FlankFractureInputs, member: Member, x: Array, pressed: Array, width: Array, stress: float
) -> GearExposure:
    """Exposure of one gear, and the case depths below which its case is crushed."""
    from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, exposure
    from fegear.formulas.iso6336.part5_case_depth import AGMA_CRUSHING, ISO_CRUSHING, crushing_depth

    i, pair = MEMBERS.index(member), inputs.asked.pair
    gear, case = pair.gear(member), inputs.cases[i]
    deepest = _HALF_TOOTH * gear.module
    depth = deepest * np.linspace(0.0, 1.0, _DEPTHS) ** 1.5  # finer where stresses change most
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
        depth, hardness, residual, found, float(counted[place, deep]), float(load.max()), float(x[place]),
        float(depth[deep]), crushing_depth(pair, stress, iso), crushing_depth(pair, stress, hardening),
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _inputs(scene, name)


def _present(data: FlankFractureData, inputs: FlankFractureInputs) -> Outcome:
    return Outcome(
        data, fracture_tables(data, inputs), fracture_values(data, inputs), {"places": len(data.x), "depths": _DEPTHS},
        fracture_remarks(data, inputs), fracture_figures(data, inputs),
    )  # fmt: skip


FLANK_FRACTURE = Stage(
    subjects=lambda scene: tuple(scene.pairs),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(
        Citation("iso-ts-6336-4", "material exposure over the depth below the contact"),
        Citation("johnson", "stresses below a line contact", "Eqs. 4.47 to 4.49"),
        Citation("iso-6336-5", "case depth"),
        Citation("agma-2101", "least effective case depth"),
    ),
    forecast=lambda _scene, _name: Forecast({"places": _PLACES, "depths": _DEPTHS}, 0.05),
)
