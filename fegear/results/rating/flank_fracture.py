"""Result ``flank-fracture``: exposure of surface-hardened flanks over depth, and the case depth that they need."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError, InputError, RangeError
from fegear.base.notes import assuming, failing, neglecting
from fegear.base.shown import shown, shows
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.items import Mark
from fegear.engine.outcome import Outcome
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.formulas.iso6336.part4_flank_fracture import CALIBRATION, HARDNESS_FACTOR, PERMISSIBLE, Exposure
from fegear.formulas.iso6336.part5_materials import recommended
from fegear.geometry.pair import MEMBERS, Member
from fegear.results.rating.rating import given, rated
from fegear.results.rating.shared_load import NotRated, external_rated_pairs, needs_shares, with_shares

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.rated_pair import PairToRate
    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
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
class Below:
    """A gear over depth below one place of the path, shape (M,)."""

    letter: str
    depth: Array = shown("mm", "depth y below the flank", label="depth below the flank")
    load_stress: Array = shown("MPa", "tau_eff,L", label="shear stress")
    stress: Array = shown("MPa", "tau_eff")
    exposure: Array = shown("", "A_FF", label="material exposure A_FF")
    strength: Array = shown("MPa", "tau_per(y)")
    hardness: Array = shown("", "HV(y), Vickers", label="hardness HV")
    residual: Array = shown(
        "MPa", "residual stress sigma_RS(y), uniform over profile and face width", name="residual_stress"
    )

    @property
    def key(self) -> str:
        """Its letter as names of columns have it."""
        return self.letter.translate(str.maketrans("", "", "_{}"))

    def every(self, step: int) -> Below:
        """It at every so manyth depth."""
        arrays = [one.name for one in fields(self) if one.name != "letter"]
        return replace(self, **{name: getattr(self, name)[::step] for name in arrays})


@dataclass(frozen=True)
class GearExposure:
    """One gear below its flank.

    Parameters
    ----------
    found : Exposure
    depth, hardness, residual : ndarray, shape (M,)
    over_path : ndarray, shape (N,)
        Largest A_FF below each place, from the depth of the half-width on.
    most : float
        Largest of these.
    most_load : float
        The same without residual stress.
    place, at_depth : float
        Where it is: on the path of contact, and how deep [m].
    crushing, least_agma : float
        NaN where there is none for the material.
    """

    found: Exposure
    depth: Array
    hardness: Array
    residual: Array
    over_path: Array = shown("", "A_FF, maximum below b_H", name="exposure")
    place: float = shown("mm", "position of the maximum exposure on the line of action, from the pitch point")
    most: float = shown("", f"maximum material exposure (permissible {PERMISSIBLE:g})", name="A_FF")
    most_load: float = shown("", "maximum exposure without residual stress (upper bound)", name="A_FF_load")
    at_depth: float = shown("mm", "depth of the maximum exposure", name="A_FF_depth")
    crushing: float = shown("mm", "Eht_c of ISO 6336-5, minimum against case crushing")
    least_agma: float = shown("mm", "h_e,min of AGMA 2101 with ISO's sigma_H")

    @property
    @shows("", f"safety factor, 1/A_FF (minimum {1.0 / PERMISSIBLE:g})", name="S_FF")
    def safety(self) -> float:
        """Against flank fracture."""
        return 1.0 / self.most

    def below(self, k: int, letter: str = "") -> Below:
        """It below the k-th place of the path, under the letter of that place."""
        stress, load, exposure = (one[k] for one in (self.found.stress, self.found.load_stress, self.found.exposure))
        return Below(letter, self.depth, load, stress, exposure, self.found.strength, self.hardness, self.residual)


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
    from fegear.formulas.flank_speeds import flank_speeds
    from fegear.formulas.flash_temperature import reduced_modulus
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
        found, depth, hardness, residual, counted.max(axis=1), float(x[place]), float(counted[place, deep]),
        float(load.max()), float(depth[deep]), crushing_depth(pair, stress, iso),
        crushing_depth(pair, stress, hardening),
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _inputs(scene, name)


def fracture_remarks(data: FlankFractureData, inputs: FlankFractureInputs) -> tuple[str, ...]:
    """What falls short, then what is assumed and what is not verified against the standard."""
    name = inputs.asked.name
    told: list[str] = []
    for i, (member, gear) in enumerate(zip(MEMBERS, inputs.asked.gears, strict=True)):
        found, case = data.gears[member], inputs.cases[i]
        if found.most > PERMISSIBLE:
            told.append(
                failing(
                    f"Pair {name}: A_FF = {found.most:.4g} of gear {gear} ({member}) at a depth of "
                    f"{found.at_depth * 1e3:.3g} mm is above the permissible {PERMISSIBLE:g}."
                )
            )
        largest = recommended(inputs.asked.pair.gear(member).module)[2]
        needed = float(np.nanmax([found.crushing, found.least_agma, 0.0]))
        if case.case_depth < needed:
            told.append(
                failing(
                    f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm is below the {needed * 1e3:.3g} mm "
                    "required against case crushing."
                )
            )
        if case.case_depth > largest:
            told.append(
                failing(
                    f"Gear {gear}: the case depth of {case.case_depth * 1e3:.3g} mm exceeds {largest * 1e3:.3g} mm "
                    "(0.4 m_n, at most 6 mm)."
                )
            )
        if inputs.materials[i] != "case-hardened-steel":
            covers = "ISO/TS 6336-4 covers case-carburized steel only"
            told.append(assuming(f"Gear {gear}: {covers}; the exposure for {inputs.materials[i]} is an extrapolation."))
        for what, measured, rule in (
            ("hardness over depth", case.measured, "hardness_profile"),
            ("residual stress", case.residual, "residual_stress"),
        ):
            if measured is None:
                told.append(
                    assuming(f"Gear {gear}: {what} by Lang, not verified against a printed source (strength.{rule}).")
                )
    if inputs.asked.levels:
        told.append(
            neglecting(
                f"Pair {name}: exposure and case depths are for the maximum level of the load spectrum, "
                f"{data.load / inputs.asked.load:.4g} times the load."
            )
        )
    told += inputs.said
    told.append(
        assuming(
            f"Pair {name}: structure, symbols and scope of A_FF (case-carburized external gears) are those that "
            f"printed sources give of ISO/TS 6336-4. Not verified against a source: K_tau,per = "
            f"{HARDNESS_FACTOR * 1e-6:g} MPa per HV, c_1 = {CALIBRATION:g}, "
            f"permissible A_FF = {PERMISSIBLE:g}, and that A_FF counts from the "
            f"half-width on; K_material = {inputs.material_factor:g} (flank_fracture_material_factor of iso_6336). "
            "tau_eff is the mean shear over all planes below a Hertzian contact without friction, instead of the "
            "standard's fitted formulas. "
            "Residual stress reduces the exposure in the case; A_FF_load excludes it."
        )
    )
    limits = assuming(
        f"Pair {name}: limits of the case depth are not verified against a printed source: 0.15 to 0.25 and 0.4 "
        "m_n, U_H of ISO 6336-5 (66,000 N/mm^2 of MQ and ME, 44,000 of ML) and of AGMA 2101 (44,000 carburized, "
        "30,000 induction-hardened)."
    )
    return tuple(dict.fromkeys((*told, limits)))


def _present(data: FlankFractureData | NotRated, inputs: FlankFractureInputs | NotRated) -> Outcome:
    if isinstance(data, NotRated) or isinstance(inputs, NotRated):
        return Outcome(data, remarks=(data.remark,) if isinstance(data, NotRated) else ())
    return _SHEET.present(data, inputs)


@dataclass(frozen=True)
class Flank:
    """A gear of the pair as it is shown: its exposure over depth below A to E and where it is largest, and its case."""

    found: GearExposure
    points: tuple[Below, ...]
    worst: Below
    gear: str = shown("", "driver, driven", table="depths")
    case_depth: float = shown("mm", "CHD at 550 HV (case)", table="depths")
    usual_from: float = shown("mm", "usual minimum, 0.15 m_n", table="depths")
    usual_to: float = shown("mm", "usual maximum, 0.25 m_n", table="depths")
    largest: float = shown("mm", "upper limit: 0.4 m_n, at most 6 mm", table="depths")

    @property
    def rows(self) -> list[Below]:
        """Depths of the points that stand in a table."""
        return [one.every(_EVERY) for one in self.points]


def _flanks(seen: Seen) -> dict[Member, Flank]:
    data, inputs, gears = seen.data, seen.asked, {}
    for member, gear, case in zip(MEMBERS, inputs.asked.gears, inputs.cases, strict=True):
        found = data.gears[member]
        points = tuple(found.below(k, letter) for letter, k in data.points.items())
        worst = found.below(int(abs(data.x - found.place).argmin()))
        limits = recommended(inputs.asked.pair.gear(member).module)
        gears[member] = Flank(found, points, worst, gear, case.case_depth, *limits)
    return gears


def _case(seen: Seen) -> tuple[Mark, ...]:
    depth = seen.one.case_depth
    return (Mark("x", depth * 1e3, "CHD"),) if depth == depth else ()


def _limits(seen: Seen) -> tuple[Mark, ...]:
    largest = Mark("x", seen.one.found.at_depth * 1e3, "largest")
    return *_case(seen), Mark("y", PERMISSIBLE, f"{PERMISSIBLE:g}"), largest


def _value(quantity: str, of: str = "found", name: str = "", meaning: str = "") -> Number:
    return Number(quantity, of=of, owner="{name}.{key}", name=name, meaning=meaning, finite=True)


#: Depths in a table by point and depth: every so manyth.
_EVERY = 4
_PLAIN = {"markers": False}
_SHEET = Sheet(
    name=lambda inputs: inputs.asked.name,
    tables=(
        Rows(
            "flank_fracture_{name}", "Flank fracture of pair {name} over the path of contact",
            (
                "x", "sharing", "radius", "pressure", "half_width",
                Cell("over_path", each="gears", name="exposure_{key}", further=", {key} gear"),
            ),
        ),
        Rows(
            "flank_fracture_{name}_{key}", "Below the flanks of gear {one.gear} ({key}) of pair {name}",
            (
                "depth", "hardness", "residual", "strength",
                Each("rows", *(
                    Cell(one, name=f"{one}_{{one.key}}", further=" below {one.letter}")
                    for one in ("load_stress", "stress", "exposure")
                )),
            ),
            of=lambda seen: seen.one.rows[0], each=_flanks,
        ),
        Rows(
            "case_depth_{name}", "Case depths of pair {name} and limits",
            (Every("depths"), "found.crushing", "found.least_agma"),
            of=lambda seen: list(_flanks(seen).values()), printed=True,
        ),
    ),
    values=(
        Each(
            _flanks,
            _value("most"),
            _value("safety"),
            _value("most_load"),
            _value("at_depth"),
            _value("case_depth", of="", meaning="at 550 HV (case)"),
            _value("crushing", name="case_depth_crushing", meaning="minimum against case crushing, ISO 6336-5"),
            _value("least_agma", name="case_depth_agma", meaning="minimum of AGMA 2101, with sigma_H of ISO"),
        ),
    ),
    figures=(
        Chart(
            "flank_fracture_{name}_{key}", "Flank fracture of gear {one.gear}",
            f"Gear {{one.gear}} ({{key}}) of pair {{name}}: material exposure A_FF over depth below points A to E "
            f"(permissible {PERMISSIBLE:g}); equivalent shear stress at the maximum exposure, {{one.found.place:.3g}} "
            "from the pitch point, with local strength; hardness.",
            (
                Over(
                    "depth",
                    (Line("exposure", each=Family("points", "at {one.letter}", most=None), look=_PLAIN),),
                    options={"zero": True}, x_options={"zero": True}, marks=_limits,
                ),
                Over(
                    "depth",
                    (
                        Line("load_stress", "load only", "series:1", look={"dash": "dash", **_PLAIN}),
                        Line("stress", "with residual stress", "series:0", look=_PLAIN),
                        Line("strength", "strength", "ink", look=_PLAIN),
                    ),
                    options={"zero": True}, x_options={"zero": True}, marks=_case,
                ),
                Over(
                    "depth", (Line("hardness", "hardness", "ink", look=_PLAIN),), x_options={"zero": True}, marks=_case
                ),
            ),
            of="worst", each=_flanks,
        ),
    ),
    remarks=(lambda seen: fracture_remarks(seen.data, seen.asked),),
    settings={"places": "x.size", "depths": lambda _seen: _DEPTHS},
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
