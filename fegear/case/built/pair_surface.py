"""From a case to the flanks of a pair: oil, roughness, load factors, speed and friction law."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.notes import assuming
from fegear.case.built.train import train_inputs
from fegear.dynamics.train.train_spec import build_train, speed_ratio
from fegear.geometry.pair import MEMBERS, GearPair

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.pair import PairPart
    from fegear.case.reading import Scene
    from fegear.case.surface import LubricantPart
    from fegear.contact.surface import FrictionLaw
    from fegear.formulas.flank_speeds import FlankSpeeds
    from fegear.formulas.friction import Surface
    from fegear.formulas.iso6336.rated import Both, LoadFactors, RatedSurface
    from fegear.formulas.lubricant import Oil

#: Tolerance class of flanks whose class the case does not give, and their roughness [m].
_CLASS = 6
#: c' and c_gamma of steel gears where the series of ISO 6336-1 does not hold [Pa].
_USUAL_STIFFNESS = (14e9, 20e9)


@dataclass(frozen=True)
class OilTests:
    """What the oil stands in tests.

    Parameters
    ----------
    scuffing_stage : int or None
        FZG A/8.3/90.
    scuffing_temperature : float or None
        [degC], in place of the test.
    micropitting_stage : int or None
        FVA 54/7.
    micropitting_temperature : float
        [degC].
    permissible_film : float or None
        lambda_GFP, in place of the test.
    material_factor : float
        W_W of both flanks' steels.
    """

    scuffing_stage: int | None = None
    scuffing_temperature: float | None = None
    micropitting_stage: int | None = None
    micropitting_temperature: float = 90.0
    permissible_film: float | None = None
    material_factor: float = 1.0


@dataclass(frozen=True)
class PairFriction:
    """Friction law of a pair with all that it needs.

    Parameters
    ----------
    law : str
        As a case names it.
    coefficient : float
        Of the law constant.
    viscosity : float
        Dynamic, of Benedict and Kelley's law [Pa s].
    local : bool
        Whether mean laws are taken at every point.
    surface : Surface or None
        Oil and roughness, of mean laws.
    """

    law: str
    coefficient: float = math.nan
    viscosity: float = math.nan
    local: bool = False
    surface: Surface | None = None

    def of(self, pair: GearPair, speed: float, load: float) -> FrictionLaw:
        """Coefficient as a function of speeds and line loads.

        Parameters
        ----------
        pair : GearPair
        speed : float
            Of the driver [rad/s].
        load : float
            F_bt, with the factors that count [N].
        """
        from fegear.dynamics.train.friction_law import benedict_kelley, buckingham
        from fegear.formulas.flank_speeds import flank_speeds
        from fegear.formulas.friction import MEAN_LAWS, law_load, mean_friction

        if self.law == "buckingham":
            return lambda at, w: np.broadcast_to(buckingham(at.sliding), np.shape(w)) * 1.0
        if self.law == "benedict-kelley":
            return lambda at, w: benedict_kelley(w, self.viscosity, at.sliding, at.sum)
        if self.law == "constant":
            return lambda _at, w: np.full(np.shape(w), self.coefficient)
        (name,) = (law for law in MEAN_LAWS if law == self.law)
        surface = self.surface
        if surface is None:
            raise InputError("friction.law", f'"{self.law}"', "requires lubricant and roughness")
        tilt = math.cos(pair.driver.base_helix_angle) if name == "iso-6336-20" else 1.0

        def local(at: FlankSpeeds, w: Array) -> Array:
            radius = np.broadcast_to(at.relative_radius * tilt, np.shape(w))
            return mean_friction(name, surface, law_load(name, pair, w), np.broadcast_to(at.sum, np.shape(w)), radius)

        if self.local:
            return local
        mean = float(local(flank_speeds(pair, 0.0, speed), np.asarray(load / pair.face_width)))
        return lambda _at, w: np.full(np.shape(w), mean)


@dataclass(frozen=True)
class PairSurface:
    """All that the flanks of a pair are rated by.

    Parameters
    ----------
    rated : RatedSurface
    tests : OilTests
    friction : PairFriction or None
        As the case gives it.
    remarks : tuple of str
    """

    rated: RatedSurface
    tests: OilTests
    friction: PairFriction | None
    remarks: tuple[str, ...] = field(default=(), compare=False)


def pair_speed(scene: Scene, name: str) -> float:
    """Speed of a pair's driver [rad/s]: its own, else that of the train at the one speed of the case; NaN without."""
    speed = scene.case.pair[name].speed
    if speed is not None:
        return speed
    train = scene.case.train
    if train is None or not scene.case.dynamics.one_speed > 0.0:
        return math.nan
    meshes = [mesh for mesh in train.mesh if train.pair_of(mesh) == name]
    if not meshes:
        return math.nan
    spec = train_inputs(scene).spec
    built = build_train(spec)
    first = scene.case.dynamics.one_speed / speed_ratio(spec, built)
    frequency = float(built.mesh_frequencies(first)[built.mesh_index(meshes[0])])
    return 2.0 * math.pi * frequency / scene.pairs[name].driver.teeth


def check_speed(scene: Scene, name: str, result: str) -> None:
    """Refuse a pair that stands still, or whose speed is not known."""
    if not pair_speed(scene, name) > 0.0:
        raise InputError(
            f"pair.{name}.speed", "(not given)", f"is required for {result} (sliding velocity)",
            'set the driver speed: speed = "1500 rpm"',
        )  # fmt: skip


def mean_roughness(scene: Scene, part: PairPart) -> float | None:
    """Ra, arithmetic mean of both flanks [m]; None where a gear gives none."""
    found = []
    for gear in (part.driver, part.driven):
        roughness = scene.case.gear[gear].roughness
        if roughness is None or roughness.flank_ra is None:
            return None
        found.append(roughness.flank_ra)
    return sum(found) / 2.0


def surface_of(scene: Scene, name: str, wanted_by: str) -> Surface:
    """Oil and roughness of a pair, or a refusal that says which of them is missing."""
    from fegear.formulas.friction import Surface

    part = scene.case.pair[name]
    if part.lubricant is None:
        raise InputError(
            f"pair.{name}.lubricant", "(not given)", f"is required for {wanted_by}",
            'set lubricant = { viscosity_40 = "220 mm^2/s", temperature = "60 degC" }',
        )  # fmt: skip
    roughness = mean_roughness(scene, part)
    if roughness is None:
        missing = next(
            gear for gear in (part.driver, part.driven)
            if (one := scene.case.gear[gear].roughness) is None or one.flank_ra is None
        )  # fmt: skip
        raise InputError(
            f"gear.{missing}.roughness", "(not given)", f"is required for {wanted_by}",
            'set roughness = { flank = "0.4 um" }',
        )  # fmt: skip
    return Surface(oil_of(part.lubricant), part.lubricant.temperature, roughness)


def oil_of(part: LubricantPart) -> Oil:
    """The oil of a case."""
    from fegear.formulas.lubricant import Oil

    hot = math.nan if part.viscosity_100 is None else part.viscosity_100
    return Oil(part.viscosity_40, hot, part.density_15, part.kind)


def pair_friction(scene: Scene, name: str, wanted_by: str) -> PairFriction:
    """Friction law of a pair: as given, else Schlenk's with the oil of the case."""
    part = scene.case.pair[name]
    law = "schlenk" if part.friction is None else part.friction.name
    if law == "constant":
        return PairFriction(law, float(part.friction.coefficient or 0.0) if part.friction else math.nan)
    if law == "buckingham":
        return PairFriction(law)
    given = None if part.friction is None else part.friction.viscosity
    if law == "benedict-kelley":
        if given is None and part.lubricant is None:
            raise InputError(
                f"pair.{name}.friction.viscosity", "(not given)", f"is required by law = \"{law}\"",
                "specify it, or a lubricant",
            )  # fmt: skip
        if given is None and part.lubricant is not None:
            given = float(oil_of(part.lubricant).dynamic(part.lubricant.temperature))
        return PairFriction(law, viscosity=given or math.nan)
    wants = f'{wanted_by} with the friction law "{law}"; or give friction = {{ coefficient = 0.05 }}'
    local = part.friction is not None and part.friction.local
    return PairFriction(law, local=local, surface=surface_of(scene, name, wants))


def load_factors(scene: Scene, name: str) -> tuple[LoadFactors, tuple[str, ...]]:
    """K_A K_gamma, K_v, K_Hbeta and K_Halpha.

    As `operation` gives them, else by ISO 6336-1 where both gears have a `strength`, on which running in depends; else
    1, with a remark.
    """
    from fegear.formulas.iso6336.rated import LoadFactors

    part = scene.case.pair[name]
    given = part.operation
    found = {
        "K_v": given.dynamic_factor, "K_Hbeta": given.face_load_factor, "K_Halpha": given.transverse_load_factor
    }  # fmt: skip
    missing = [key for key, value in found.items() if value is None]
    remarks: tuple[str, ...] = ()
    if missing and all(scene.case.gear[gear].strength is not None for gear in (part.driver, part.driven)):
        by_standard, remarks = _by_iso_6336(scene, name, missing)
        found |= by_standard
        missing = [key for key in missing if key not in by_standard]
    if missing:
        names = ", ".join(missing)
        told = assuming(
            f"Pair {name}: {names} = 1 for scuffing and micropitting. Specify strength of both gears (ISO 6336-1) or "
            "operation.dynamic_factor, face_load_factor, transverse_load_factor."
        )
        remarks = (*remarks, told)
    dynamic, face, transverse = (value or 1.0 for value in found.values())
    return LoadFactors(given.applied_factor, dynamic, face, transverse), remarks


def _by_iso_6336(scene: Scene, name: str, wanted: list[str]) -> tuple[dict[str, float], tuple[str, ...]]:
    """Load factors of ISO 6336-1, as a rating has them, and what they assume; none outside its range."""
    from fegear.case.built.rated_pair import pair_to_rate
    from fegear.formulas.iso6336.conditions import Replacement
    from fegear.formulas.iso6336.safety import rate_pair

    if scene.case.pair[name].speed is None:  # that of a train is not known to a rating
        return {}, ()
    asked = pair_to_rate(scene, name)
    own = Replacement(K_v=asked.given.get("K_v"), K_Halpha=asked.given.get("K_Halpha"))
    try:
        rating = rate_pair(asked.conditions, own)
    except RangeError as error:
        return {}, (f"Pair {name}: no load factors of ISO 6336-1: {error}",)
    return {key: max(rating[key].values) for key in wanted}, tuple(one for one in asked.assumed if "shafts" in one)


def pair_surface(scene: Scene, name: str, tip_relief: tuple[float, float] = (0.0, 0.0)) -> PairSurface:
    """Collect what a case says of a pair's flanks.

    Parameters
    ----------
    scene : Scene
    name : str
    tip_relief : (float, float)
        C_a of driver and driven gear [m].

    Raises
    ------
    InputError
        If oil, roughness, speed or load are missing.
    """
    from fegear.case.built.rated_body import blank_factor
    from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
    from fegear.formulas.iso6336.rated import STRUCTURE_FACTOR, SUPPLY_FACTOR, RatedSurface

    part, pair = scene.case.pair[name], scene.pairs[name]
    check_speed(scene, name, "flank-surface")
    surface = surface_of(scene, name, "flank-surface")
    oil = part.lubricant
    if oil is None:  # surface_of refuses that
        raise InputError(f"pair.{name}.lubricant", "(not given)", "is required for flank-surface")
    load = part.normal_load(pair)
    if load is None:
        raise InputError(f"pair.{name}.load", "(not given)", "is required for flank-surface", "specify load or torque")
    factors, remarks = load_factors(scene, name)
    gears = [scene.case.gear[gear] for gear in (part.driver, part.driven)]
    classes = [gear.tolerance_class for gear in gears]
    told = list(remarks)
    if None in classes:
        told.append(assuming(f"Pair {name}: flank tolerance class {_CLASS} assumed (tolerance_class)."))
    if any(gear.flank_treatment is None for gear in gears):
        told.append(assuming(f"Pair {name}: X_W = 1 (through-hardened flanks) assumed (flank_treatment)."))
    if oil.viscosity_100 is None:
        told.append(assuming(f"Pair {name}: viscosity_100 assumed for a mineral oil of viscosity index 95."))
    single, mesh = _USUAL_STIFFNESS
    try:
        applied = factors.application * pair.specific_load(load)
        stiffness = pair_stiffness(pair, specific_load=applied, blank=blank_factor(scene, name))
        single, mesh = stiffness.single, stiffness.mesh_alpha
    except RangeError as error:
        told.append(
            assuming(
                f"Pair {name}: c' = 14 and c_gamma = 20 N/(mm um) assumed, outside the range of ISO 6336-1: {error}"
            )
        )
    relief = _with_running_in(scene, name, tip_relief, told)
    rated = RatedSurface(
        pair, pair_speed(scene, name), load, factors, surface, SUPPLY_FACTOR[oil.supply],
        min(STRUCTURE_FACTOR[gear.flank_treatment or "through-hardened"] for gear in gears), relief,
        single, mesh, max(one or _CLASS for one in classes),
    )  # fmt: skip
    tests = OilTests(
        oil.scuffing_load_stage, oil.scuffing_temperature, oil.micropitting_load_stage, oil.micropitting_temperature,
        oil.permissible_film, _material_factor(scene, name, told),
    )  # fmt: skip
    friction = None if part.friction is None else pair_friction(scene, name, "flank-surface")
    return PairSurface(rated, tests, friction, tuple(told))


def _with_running_in(scene: Scene, name: str, relief: Both, told: list[str]) -> Both:
    """C_a of driver and driven: by design, else what running in leaves, which depends on both materials."""
    from fegear.case.built.gear_strength import gear_strength
    from fegear.formulas.iso6336.part1_dynamic import running_in_relief

    part = scene.case.pair[name]
    gears = (part.driver, part.driven)
    if all(relief):
        return relief
    if any(scene.case.gear[gear].strength is None for gear in gears):
        told.append(
            assuming(f"Pair {name}: C_a = 0 for tips without relief (running-in not included, strength not specified).")
        )
        return relief
    one, other = (gear_strength(scene, gear, []).contact for gear in gears)
    worn = running_in_relief((one, other))
    return relief[0] or worn, relief[1] or worn


def _material_factor(scene: Scene, name: str, told: list[str]) -> float:
    """W_W of a pair, the mean of both steels; 1, on the safe side, of those that are not known."""
    from fegear.formulas.iso6336.part22_micropitting import MATERIAL_FACTOR, RECALLED_MATERIALS

    part = scene.case.pair[name]
    given = part.iso_6336.micropitting_material_factor
    if given is not None or part.lubricant is None or part.lubricant.micropitting_load_stage is None:
        return given or 1.0
    steels = {gear: _flank_steel(scene, gear) for gear in dict.fromkeys((part.driver, part.driven))}
    for gear, steel in steels.items():
        if steel not in MATERIAL_FACTOR:
            told.append(
                assuming(
                    f"Gear {gear}: W_W = 1 of carburized flanks assumed for micropitting, conservative "
                    "(flank_treatment, strength, or micropitting_material_factor of iso_6336)."
                )
            )
        elif steel in RECALLED_MATERIALS:
            told.append(
                assuming(
                    f"Gear {gear}: W_W = {MATERIAL_FACTOR[steel]:g} for {steel} flanks is not verified against a "
                    "printed source (iso_6336.micropitting_material_factor)."
                )
            )
    one, other = (MATERIAL_FACTOR.get(steels[gear], 1.0) for gear in (part.driver, part.driven))
    return 0.5 * (one + other)


def _flank_steel(scene: Scene, gear: str) -> str:
    """What a flank is made of, in the words of W_W: as treated, else by its strength; empty where nothing says it."""
    from fegear.formulas.iso6336.part22_micropitting import MATERIAL_FACTOR

    part = scene.case.gear[gear]
    if part.flank_treatment in MATERIAL_FACTOR:
        return str(part.flank_treatment)
    material = "" if part.strength is None else part.strength.material
    for start, steel in (
        ("case-hardened", "case-carburized"), ("induction", "induction-hardened"), ("nitr", "nitrided"),
        ("through-hardened", "through-hardened"), ("normalized", "through-hardened"),
    ):  # fmt: skip
        if material.startswith(start):
            return steel
    return ""


def tip_reliefs(scene: Scene, name: str) -> tuple[float, float]:
    """C_a, removal at the end of the involute of driver and driven gear [m]; 0 where relief is off or in Delta."""
    from fegear.case.built.gear_flanks import gear_flanks
    from fegear.case.built.members import gear_name

    if not scene.case.effects.relief:
        return (0.0, 0.0)
    found = []
    pair = scene.pairs[name]
    for member in MEMBERS:
        flank = gear_flanks(scene, gear_name(scene, name, member))
        if flank.relief is None or flank.wants_delta:
            found.append(0.0)
            continue
        end = pair.x_end if member == "driver" else pair.x_start
        relief = flank.profile(pair, member, 0.0)
        found.append(max(0.0, float(relief.removal(pair.roll_angle(end, member)))))
    return found[0], found[1]
