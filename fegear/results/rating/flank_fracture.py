"""Result ``flank-fracture``: exposure of surface-hardened flanks over depth, and the case depth that they need.

Tables, values and remarks of the result ``flank-fracture``.

Figures of the result ``flank-fracture``: exposure, stress and strength, and hardness over depth, for either gear.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError, InputError, RangeError
from fegear.base.shown import shown
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, column_over, columns_of, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, HARDNESS_FACTOR, PERMISSIBLE, Exposure
from fegear.formulas.iso6336.part5_materials import recommended
from fegear.geometry.pair import MEMBERS, Member
from fegear.results.rating.rating import given, rated
from fegear.results.rating.shared_load import NotRated, external_rated_pairs, needs_shares, with_shares

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.formulas.hardened_case import HardenedCase


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
    alone : bool
        Whether no other pair of the case can be evaluated: then a formula's range ends the run, not a remark.
    """

    asked: PairToRate
    cases: tuple[HardenedCase, HardenedCase]
    materials: tuple[str, str]
    qualities: tuple[str, str]
    material_factor: float
    said: tuple[str, ...] = field(compare=False)
    alone: bool = False


@dataclass(frozen=True)
class GearExposure:
    """One gear below its flank.

    Parameters
    ----------
    depth, hardness, residual : ndarray, shape (M,)
    found : Exposure
    most : float
        A_FF,max from the depth of the half-width on.
    most_load : float
        The same without residual stress.
    place, at_depth : float
        Where it is: on the path of contact, and how deep [m].
    crushing, least_agma : float
        NaN where there is none for the material.
    """

    found: Exposure
    place: float
    depth: Array = shown("mm", "depth y below the flank", label="depth below the flank")
    hardness: Array = shown("", "HV(y), Vickers")
    residual: Array = shown(
        "MPa", "residual stress sigma_RS(y), uniform over profile and face width", name="residual_stress"
    )
    most: float = shown("", f"maximum material exposure (permissible {PERMISSIBLE:g})", name="A_FF")
    most_load: float = shown("", "maximum exposure without residual stress (upper bound)", name="A_FF_load")
    at_depth: float = shown("mm", "depth of the maximum exposure", name="A_FF_depth")
    crushing: float = shown("mm", "Eht_c of ISO 6336-5, minimum against case crushing")
    least_agma: float = shown("mm", "h_e,min of AGMA 2101 with ISO's sigma_H")


@dataclass(frozen=True)
class FlankFractureData:
    """What the stage finds.

    Parameters
    ----------
    x, sharing, pressure, half_width, radius : ndarray, shape (N,)
    points : mapping of str to int
        Named points A to E among the places.
    gears : mapping of Member to GearExposure
    load : float
        Along the line of action, of the spectrum's largest level where there is one [N].
    """

    points: dict[str, int]
    gears: dict[Member, GearExposure]
    load: float
    x: Array = shown("mm", "on the line of action, from the pitch point")
    sharing: Array = shown("", "X_CP, that of ISO/TS 6336-22 without relief", name="load_sharing")
    pressure: Array = shown("MPa", "p_dyn,CP with all load factors", name="hertz_pressure")
    half_width: Array = shown("mm", "b_H of the contact")
    radius: Array = shown("mm", "rho_red,CP in the normal section", name="relative_radius")


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
    from fegear.formulas.flash_temperature import flank_speeds, reduced_modulus
    from fegear.formulas.iso6336.part4_flank_fracture import half_width
    from fegear.formulas.iso6336.part22_micropitting import load_sharing, pressure
    from fegear.formulas.iso6336.safety import rate_pair
    from fegear.geometry.pair import path_points

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
        {letter: int(np.searchsorted(x, place)) for letter, place in named.items()}, gears, load, x, sharing, pressed,
        width, speeds.relative_radius,
    )  # fmt: skip


def _below(
    inputs: FlankFractureInputs, member: Member, x: Array, pressed: Array, width: Array, stress: float
) -> GearExposure:
    """Exposure of one gear, and the case depths below which its case is crushed."""
    from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, exposure
    from fegear.formulas.iso6336.part5_materials import AGMA_CRUSHING, ISO_CRUSHING, crushing_depth

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
        found, float(x[place]), depth, hardness, residual, float(counted[place, deep]), float(load.max()),
        float(depth[deep]), crushing_depth(pair, stress, iso), crushing_depth(pair, stress, hardening),
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _inputs(scene, name)


def _present(data: FlankFractureData | NotRated, inputs: FlankFractureInputs | NotRated) -> Outcome:
    if isinstance(data, NotRated) or isinstance(inputs, NotRated):
        return Outcome(data, remarks=(data.remark,) if isinstance(data, NotRated) else ())
    return Outcome(
        data, fracture_tables(data, inputs), fracture_values(data, inputs), {"places": len(data.x), "depths": _DEPTHS},
        fracture_remarks(data, inputs), fracture_figures(data, inputs),
    )  # fmt: skip


#: Depths in a table by point and depth: every so manyth.
_EVERY = 4


def fracture_tables(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Table, ...]:
    """Pressure and largest exposure over the path; both gears below the points A to E; case depths and their limits."""
    return _path(data, inputs), *_table_below(data, inputs), _depths(data, inputs)


def _path(data: FlankFractureData, inputs: FlankFractureInputs) -> Table:
    name = inputs.asked.name
    columns = [*columns_of(data, "x", "sharing", "radius", "pressure", "half_width")]
    for member in MEMBERS:
        gear = data.gears[member]
        counted = np.where(gear.depth >= data.half_width[:, None], gear.found.exposure, -np.inf)
        columns.append(Column(f"exposure_{member}", counted.max(axis=1), "", f"A_FF, maximum below b_H, {member} gear"))
    return Table(f"flank_fracture_{name}", tuple(columns), f"Flank fracture of pair {name} over the path of contact")


def _table_below(data: FlankFractureData, inputs: FlankFractureInputs) -> Iterator[Table]:
    for member, gear_name in zip(MEMBERS, inputs.asked.gears, strict=True):
        gear = data.gears[member]
        every = slice(0, None, _EVERY)
        columns = [
            *(column_of(gear, key, getattr(gear, key)[every]) for key in ("depth", "hardness", "residual")),
            Column("strength", gear.found.strength[every], "MPa", "tau_per(y)"),
        ]
        for letter, i in data.points.items():
            key = letter.translate(str.maketrans("", "", "_{}"))
            columns += [
                Column(f"load_stress_{key}", gear.found.load_stress[i, every], "MPa", f"tau_eff,L below {letter}"),
                Column(f"stress_{key}", gear.found.stress[i, every], "MPa", f"tau_eff below {letter}"),
                Column(f"exposure_{key}", gear.found.exposure[i, every], "", f"A_FF below {letter}"),
            ]
        title = f"Below the flanks of gear {gear_name} ({member}) of pair {inputs.asked.name}"
        yield Table(f"flank_fracture_{inputs.asked.name}_{member}", tuple(columns), title)


def _depths(data: FlankFractureData, inputs: FlankFractureInputs) -> Table:
    name, pair = inputs.asked.name, inputs.asked.pair
    limits = [recommended(pair.gear(member).module) for member in MEMBERS]
    least, most, largest = (np.array(values) for values in zip(*limits, strict=True))
    gears = [data.gears[member] for member in MEMBERS]
    columns = (
        Column("gear", np.array(inputs.asked.gears), "", "driver, driven"),
        Column("case_depth", np.array([case.case_depth for case in inputs.cases]), "mm", "CHD at 550 HV (case)"),
        Column("usual_from", least, "mm", "usual minimum, 0.15 m_n"),
        Column("usual_to", most, "mm", "usual maximum, 0.25 m_n"),
        Column("largest", largest, "mm", "upper limit: 0.4 m_n, at most 6 mm"),
        column_over(gears, "crushing"),
        column_over(gears, "least_agma"),
    )
    return Table(f"case_depth_{name}", columns, f"Case depths of pair {name} and limits", printed=True)


def fracture_values(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Value, ...]:
    """Largest exposure of either gear with its place, its safety, and case depth with what it needs."""
    found = []
    for member, case in zip(MEMBERS, inputs.cases, strict=True):
        key, gear = f"{inputs.asked.name}.{member}", data.gears[member]
        found += [
            value_of(gear, "most", key),
            Value(f"{key}.S_FF", 1.0 / gear.most, "", None, f"safety factor, 1/A_FF (minimum {1.0 / PERMISSIBLE:g})"),
            value_of(gear, "most_load", key),
            value_of(gear, "at_depth", key),
            Value(f"{key}.case_depth", case.case_depth, "mm", None, "at 550 HV (case)"),
            Value(f"{key}.case_depth_crushing", gear.crushing, "mm", None, "minimum against case crushing, ISO 6336-5"),
            Value(f"{key}.case_depth_agma", gear.least_agma, "mm", None, "minimum of AGMA 2101, with sigma_H of ISO"),
        ]  # fmt: skip
    return tuple(value for value in found if math.isfinite(value.si))


def fracture_remarks(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[str, ...]:
    """What falls short, then what is assumed and what is not verified against the standard."""
    name, told = inputs.asked.name, []
    for i, (member, gear) in enumerate(zip(MEMBERS, inputs.asked.gears, strict=True)):
        found, case = data.gears[member], inputs.cases[i]
        if found.most > PERMISSIBLE:
            told.append(
                f"Pair {name}: A_FF = {found.most:.4g} of gear {gear} ({member}) at a depth of "
                f"{found.at_depth * 1e3:.3g} mm is above the permissible {PERMISSIBLE:g}."
            )
        largest = recommended(inputs.asked.pair.gear(member).module)[2]
        needed = float(np.nanmax([found.crushing, found.least_agma, 0.0]))
        if case.case_depth < needed:
            told.append(
                f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm is below the {needed * 1e3:.3g} mm "
                "required against case crushing."
            )
        if case.case_depth > largest:
            told.append(
                f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm exceeds {largest * 1e3:.3g} mm (0.4 "
                "m_n, at most 6 mm)."
            )
        if inputs.materials[i] != "case-hardened-steel":
            told.append(
                f"Gear {gear}: ISO/TS 6336-4 covers case-carburized steel only; the exposure for "
                f"{inputs.materials[i]} is an extrapolation."
            )
        for what, measured, rule in (
            ("hardness over depth", case.measured, "hardness_profile"),
            ("residual stress", case.residual, "residual_stress"),
        ):
            if measured is None:
                told.append(f"Gear {gear}: {what} by Lang, not verified against a printed source (strength.{rule}).")
    if inputs.asked.levels:
        told.append(
            f"Pair {name}: exposure and case depths are for the maximum level of the load spectrum, "
            f"{data.load / inputs.asked.load:.4g} times the load."
        )
    told += inputs.said
    told.append(
        f"Pair {name}: structure, symbols and scope of A_FF (case-carburized external gears) are those that printed "
        f"sources give of ISO/TS 6336-4. Not verified against a source: K_tau,per = {HARDNESS_FACTOR * 1e-6:g} MPa "
        f"per HV, c_1 = {CALIBRATION:g}, permissible A_FF = {PERMISSIBLE:g}, and that A_FF counts from the "
        f"half-width on; K_material = {inputs.material_factor:g} (flank_fracture_material_factor of iso_6336). "
        "tau_eff is the mean shear over all planes below a Hertzian contact without friction, instead of the "
        "standard's fitted formulas. "
        "Residual stress reduces the exposure in the case; A_FF_load excludes it."
    )
    told.append(
        f"Pair {name}: limits of the case depth are not verified against a printed source: 0.15 to 0.25 and 0.4 m_n, "
        "U_H of ISO 6336-5 (66,000 N/mm^2 of MQ and ME, 44,000 of ML) and of AGMA 2101 (44,000 carburized, 30,000 "
        "induction-hardened)."
    )
    return tuple(dict.fromkeys(told))


_MPA = 1e-6


def fracture_figures(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[Figure, ...]:
    """One figure a gear."""
    return tuple(_figure(member, data, inputs) for member in MEMBERS)


def _figure(member: Member, data: FlankFractureData, inputs: FlankFractureInputs) -> Figure:
    name, i, gear = inputs.asked.name, MEMBERS.index(member), data.gears[member]
    depth, case = gear.depth * 1e3, inputs.cases[i]
    abscissa = Axis("depth below the flank", "mm", zero=True)
    marks = (Mark("x", case.case_depth * 1e3, "CHD"),) if case.case_depth == case.case_depth else ()
    worst = int(abs(data.x - gear.place).argmin())
    exposures = [
        Curve(depth, gear.found.exposure[k], f"at {letter}", f"series:{n}", markers=False)
        for n, (letter, k) in enumerate(data.points.items())
    ]
    stresses = [
        Curve(depth, gear.found.load_stress[worst] * _MPA, "load only", "series:1", dash="dash", markers=False),
        Curve(depth, gear.found.stress[worst] * _MPA, "with residual stress", "series:0", markers=False),
        Curve(depth, gear.found.strength * _MPA, "strength", "ink", markers=False),
    ]
    hardness = [Curve(depth, gear.hardness, "hardness", "ink", markers=False)]
    caption = (
        f"Gear {inputs.asked.gears[i]} ({member}) of pair {name}: material exposure A_FF over depth below points A "
        f"to E (permissible {PERMISSIBLE:g}); equivalent shear stress at the maximum exposure, "
        f"{gear.place * 1e3:.3g} mm from the pitch point, with local strength; hardness."
    )
    return Figure(
        f"flank_fracture_{name}_{member}", f"Flank fracture of gear {inputs.asked.gears[i]}", caption,
        (
            Panel(abscissa, Axis("material exposure A_FF", zero=True), tuple(exposures),
                  (*marks, Mark("y", PERMISSIBLE, f"{PERMISSIBLE:g}"), Mark("x", gear.at_depth * 1e3, "largest"))),
            Panel(abscissa, Axis("shear stress", "MPa", zero=True), tuple(stresses), marks),
            Panel(abscissa, Axis("hardness HV"), tuple(hardness), marks),
        ),
    )  # fmt: skip


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
    forecast=lambda _scene, _name: Forecast({"places": _PLACES, "depths": _DEPTHS}, 0.05),
    why_external="ISO/TS 6336-4 applies to external gears",
)
