"""The closed forms of `fegear.formulas` compared with the finite elements of the same gear.

What is compared, in every function: one tooth of the whole ring under one load normal to its flank, no other tooth
loaded, per unit line load (secant, not local slope). Formulas outside their range leave a reason in words.

ISO 6336's nominal root stress of a pair's gears compared with finite elements of the same (virtual) spur tooth.

Finite elements of the virtual spur gear of a helical one, whose number of teeth is not whole.

The wheels with the whole numbers of teeth below and above are solved, and their root stress is interpolated in 1/z_n.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.formulas import hertz
from fegear.formulas.iso6336 import part3_pair as rating
from fegear.formulas.iso6336.part1_stiffness import Stiffness, pair_stiffness
from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.formulas.outcome import ComplianceSource, Outcome, attempt
from fegear.formulas.root_section import load_line
from fegear.formulas.sources import ROOT_STRESS_SOURCES, SOURCES, pair_compliance
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.tooth import Tooth

_REASON = "why the formula gives nothing; empty where it does"


@dataclass(frozen=True, slots=True)
class RootStressAnswers:
    """One root-stress formula over load positions, shape (N,), for a tooth of module 1.

    Parameters
    ----------
    stress : ndarray
        Stress x module / line load; NaN exactly where `reasons` has words.
    radius, tangent_angle : ndarray
        Place of the stress: distance from the gear's centre [modules], fillet tangent to tooth centre line [rad].
    """

    stress: Array
    radius: Array
    tangent_angle: Array
    reasons: tuple[str, ...] = shown("", _REASON, name="reason")


@dataclass(frozen=True, slots=True)
class ComplianceAnswers:
    """One compliance formula over load positions, shape (N,); its parts have shape (K, N).

    The total is NaN exactly where `reasons` has words.
    """

    total: Array = shown(
        "um.mm/N", "by the formula, deflection along the line of action per line load", name="compliance",
        label="deflection per line load",
    )  # fmt: skip
    parts: Array = shown("um.mm/N", "part of the formula's sum")
    reasons: tuple[str, ...] = shown("", _REASON, name="reason")


@dataclass(frozen=True, slots=True)
class PairReference(ReadOnlyArrays):
    """Finite elements of one tooth pair over contact positions, shape (N,); compliances per unit line load."""

    x: Array = shown(
        "mm", "contact point from the pitch point, positive toward the driver's tip",
        label="contact point from the pitch point",
    )  # fmt: skip
    driver: Array = shown("um.mm/N", "FE, the driver's tooth with its side of the contact", name="driver_fe")
    driven: Array = shown("um.mm/N", "FE, the driven tooth with its side of the contact", name="driven_fe")
    half_width: Array = shown("mm", "Hertz's half-width under the line load", name="contact_half_width")

    @property
    @shows("um.mm/N", "FE, one tooth pair with its contact", name="compliance_fe")
    def total(self) -> Array:
        """Deflection of the pair per unit line load [m^2/N]."""
        return self.driver + self.driven


def root_stress_answers(tooth: Tooth, radii: ArrayLike) -> dict[str, RootStressAnswers]:
    """Every root-stress formula under loads normal to the flank at `radii` [modules]."""
    points = [float(r) for r in np.atleast_1d(np.asarray(radii, dtype=float))]
    found = {}
    for name, source in ROOT_STRESS_SOURCES.items():
        outcomes = [attempt(partial(source.formula, tooth, r)) for r in points]
        values = np.array(
            [(o.value.stress, o.value.radius, o.value.tangent_angle) if o.value else (np.nan,) * 3 for o in outcomes]
        ).reshape(-1, 3)
        reasons = [o.reason for o in outcomes]
        for i in np.flatnonzero(values[:, 0] <= 0.0):
            # low loads on teeth with wide roots: there the radial compression outweighs the bending
            reasons[i] = f"gives {values[i, 0]:.3g}, no tension: its compression outweighs its bending"
            values[i] = np.nan
        found[name] = RootStressAnswers(values[:, 0], values[:, 1], values[:, 2], tuple(reasons))
    return found


def contact_zone(gear: Gear, radii: ArrayLike, half_width: ArrayLike) -> Array:
    """Approach of the contact zone per unit line load [m^2/N]: flank against the point on the tooth's centre line.

    Exact half-plane solution (`hertz.approach`), with the depth counted along the line of action.
    """
    r = np.atleast_1d(np.asarray(radii, dtype=float))
    depth = load_line(gear.external_tooth, r / gear.module).depth * gear.module
    m = gear.material
    return hertz.approach(1.0, half_width, depth, m.young_modulus, m.poisson_ratio, gear.plane_assumption)


def _pointwise(parts: Callable[[Array], Array], points: Array) -> ComplianceAnswers:
    """Evaluate a formula for all points at once; where it refuses, one by one, so that each keeps its own reason."""
    whole = attempt(partial(parts, points))
    if whole.value is not None:
        return ComplianceAnswers(whole.value.sum(axis=0), whole.value, ("",) * points.size)
    single = [attempt(partial(parts, points[i : i + 1])) for i in range(points.size)]
    rows = next((len(o.value) for o in single if o.value is not None), 1)
    columns = [o.value if o.value is not None else np.full((rows, 1), np.nan) for o in single]
    values = np.concatenate(columns, axis=1)
    return ComplianceAnswers(values.sum(axis=0), values, tuple(o.reason for o in single))


def tooth_compliance_answers(gear: Gear, radii: ArrayLike) -> dict[str, ComplianceAnswers]:
    """Every compliance formula, tooth and foundation without the contact; parts: bending, shear, axial, foundation."""

    def parts(source: ComplianceSource, r: Array) -> Array:
        c = source.tooth(gear, r)
        return np.stack([c.bending, c.shear, c.axial, c.foundation])

    r = np.atleast_1d(np.asarray(radii, dtype=float))
    return {name: _pointwise(partial(parts, source), r) for name, source in SOURCES.items()}


def pair_compliance_answers(pair: GearPair, x: ArrayLike, line_load: float) -> dict[str, ComplianceAnswers]:
    """Every compliance formula for one tooth pair with its contact; parts: driver, driven, contact."""

    def parts(source: ComplianceSource, at: Array) -> Array:
        c = pair_compliance(source, pair, at, line_load)
        return np.stack([c.driver, c.driven, c.contact])

    points = np.atleast_1d(np.asarray(x, dtype=float))
    return {name: _pointwise(partial(parts, source), points) for name, source in SOURCES.items()}


def contact_half_width(pair: GearPair, x: Array, line_load: float) -> Array:
    """Hertz's half-width of one tooth pair that carries all of a line load [N/m], at positions x [m]."""
    curvature = hertz.relative_curvature(
        pair.flank_curvature_radius(x, "driver"), pair.flank_curvature_radius(x, "driven")
    )
    modulus = 1.0 / sum(1.0 / pair.gear(member).plane_modulus for member in MEMBERS)
    return np.asarray(hertz.line_contact(line_load, curvature, modulus).half_width)


def contact_fits(pair: GearPair, x: Array, half_width: Array) -> NDArray[np.bool_]:
    """Whether the flanks of both gears hold contacts of these half-widths [m] at positions x [m]."""
    from fegear.fem.plane.contact_width import flank_holds

    fits = np.ones(x.shape, dtype=bool)
    for member in MEMBERS:
        gear, r = pair.gear(member), pair.radius(x, member)
        low, high = gear.involute_radii
        room = np.minimum(r**2 - low**2, high**2 - r**2) / (2.0 * gear.base_radius)
        fits &= flank_holds(half_width / gear.module, room / gear.module)
    return fits


#: Positions over the path at which contacts are tried.
_TRIED = 101


def refuse_wide_contacts(pair: GearPair, line_load: float, key: str) -> None:
    """Refuse a line load [N/m] under which no contact of a single tooth pair fits on its flanks.

    Raises
    ------
    InputError
        About `key`.
    """
    x = np.linspace(pair.x_start, pair.x_end, _TRIED)
    value, remedy = f"{line_load * 1e-3:.6g} N/mm", "check load and face_width, or remove crosscheck"
    try:
        width = contact_half_width(pair, x, line_load)
    except InputError as error:
        raise InputError(key, value, f"{error.key} = {error.value} {error.rule}", remedy) from None
    if not contact_fits(pair, x, width).any():
        rule = f"gives contacts of {width.min() * 1e3:.4g} mm half-width at least, wider than the flanks"
        raise InputError(key, value, rule, remedy)


def pair_reference(
    pair: GearPair, driver: GearInfluence, driven: GearInfluence, x: ArrayLike, line_load: float
) -> PairReference:
    """Finite elements of one tooth pair under a Hertzian contact.

    Positions off a meshed flank are skipped, and those near its ends where the contact is wider than the flank.

    Parameters
    ----------
    pair : GearPair
    driver, driven : GearInfluence
    x : array_like
        Contact positions [m].
    line_load : float
        w [N/m], > 0; it sets the contact's width.
    """
    at = np.atleast_1d(np.asarray(x, dtype=float))
    members: Sequence[tuple[Member, GearInfluence]] = (("driver", driver), ("driven", driven))
    on = np.ones(at.shape, dtype=bool)
    for member, known in members:
        r, slack = pair.radius(at, member), 1e-9 * known.gear.module
        on &= (r >= known.lowest_radius - slack) & (r <= known.highest_radius + slack)
    at = at[on]
    width = contact_half_width(pair, at, line_load)
    fits = contact_fits(pair, at, width)
    at, width = at[fits], width[fits]
    c = [
        known.self_compliance(np.clip(pair.radius(at, member), known.lowest_radius, known.highest_radius), width)
        for member, known in members
    ]
    return PairReference(at, c[0], c[1], np.array(width))


@dataclass(frozen=True, slots=True)
class HelicalCheck:
    """A helical pair as ISO 6336 rates it.

    Parameters
    ----------
    pair : GearPair
    overlap_ratio : float
        epsilon_beta of the faces as they stand.
    specific_load : float
        F_t / b [N/m].
    load_factor : float
        K_A K_gamma, which c' takes and a nominal root stress does not.
    """

    pair: GearPair
    overlap_ratio: float
    specific_load: float
    load_factor: float = 1.0

    @property
    def applied_load(self) -> float:
        """F_t K_A K_gamma / b [N/m]."""
        return self.load_factor * self.specific_load


@dataclass(frozen=True, slots=True)
class RatedGear:
    """One gear: its rating or the reason why there is none, and the finite elements' largest root tension.

    Parameters
    ----------
    rating : Outcome of RootRating
    form_stress : float
        F_t/(b m_n) Y_F Y_S [Pa], what a spur tooth alone carries; NaN without a rating.
    fe : float
        Largest root tension of the (virtual) spur tooth under the same load at the same place [Pa]; NaN without one.
    reason : str
        Why a number is missing; empty where none is.
    """

    rating: Outcome[rating.RootRating]
    form_stress: float
    fe: float
    reason: str


@dataclass(frozen=True, slots=True)
class RatedPair:
    """Driver and driven; the stiffness of helical pairs, whose spur twins have theirs in the pair's own comparison."""

    gears: tuple[RatedGear, RatedGear]
    stiffness: Outcome[Stiffness] | None = None


def _nothing(answer: Outcome[rating.RootRating]) -> RatedGear:
    return RatedGear(answer, math.nan, math.nan, answer.reason)


def rated_spur_pair(
    pair: GearPair,
    influences: tuple[GearInfluence, GearInfluence],
    line_load: float,
    choice: rating.RatingChoice,
    rims: Sequence[float | None],
) -> RatedPair:
    """Both gears of a spur pair.

    Parameters
    ----------
    pair : GearPair
    influences : (GearInfluence, GearInfluence)
        Driver and driven.
    line_load : float
        w = F_bt / b, along the line of action [N/m].
    choice : RatingChoice
    rims : sequence of float or None
        Rim thickness [m]; None for a solid gear.
    """
    members: tuple[Member, Member] = ("driver", "driven")
    found = []
    for member, known, rim in zip(members, influences, rims, strict=True):
        gear = pair.gear(member)
        answer = attempt(partial(rating.rate_spur, pair, member, line_load, choice, rim))
        if answer.value is None:
            found.append(_nothing(answer))
            continue
        one = answer.value
        form = pair.tangential_load(line_load) / gear.module * one.form.Y_F * one.form.Y_S
        at = np.array([0.5 * one.load_diameter * gear.module])
        tension = float(known.largest_root_stress(0, "tension", at)[0][0])
        found.append(RatedGear(answer, form, line_load * tension, ""))
    return RatedPair((found[0], found[1]))


def rated_helical_pair(
    check: HelicalCheck,
    choice: rating.RatingChoice,
    rims: Sequence[float | None],
    settings: MeshSettings,
    cache: SolutionCache | None = None,
) -> RatedPair:
    """Both gears of a helical pair through their virtual spur teeth.

    Parameters
    ----------
    check : HelicalCheck
    choice : RatingChoice
    rims : sequence of float or None
        Rim thickness [m]; None for a solid gear.
    settings : MeshSettings
    cache : SolutionCache, optional
    """
    found = []
    for gear, rim in zip((check.pair.driver, check.pair.driven), rims, strict=True):

        def rate(gear: Gear = gear, rim: float | None = rim) -> tuple[rating.RootRating, float]:
            load = rating.ToothLoad(
                check.specific_load, rating.virtual_contact_ratio(gear, check.pair.contact_ratio), check.overlap_ratio,
                gear.helix_angle,
            )  # fmt: skip
            one = rating.rate_helical(gear, load, choice, rim)
            tension = virtual_root_stress(gear, one.load_diameter, settings, cache).tension
            normal = check.specific_load / math.cos(gear.normal_pressure_angle)
            return one, normal * tension / gear.module

        both = attempt(rate)
        if both.value is None:
            found.append(_nothing(Outcome(None, both.reason)))
            continue
        one, fe = both.value
        form = check.specific_load / gear.module * one.form.Y_F * one.form.Y_S
        found.append(RatedGear(Outcome(one), form, fe, ""))
    stiffness = attempt(partial(pair_stiffness, check.pair, specific_load=check.applied_load))
    return RatedPair((found[0], found[1]), stiffness)


@dataclass(frozen=True, slots=True)
class VirtualRootStress:
    """Largest root tension of the virtual spur gear per line load normal to the flank.

    Parameters
    ----------
    teeth : tuple of int
        Whole numbers of teeth that were solved.
    tension : float
        Stress x module / line load.
    """

    teeth: tuple[int, ...]
    tension: float


def virtual_root_stress(
    gear: Gear,
    load_diameter: float,
    settings: MeshSettings,
    cache: SolutionCache | None = None,
) -> VirtualRootStress:
    """Root tension of the virtual spur gear under a load at the standard's point, from finite elements.

    Parameters
    ----------
    gear : Gear
        The helical gear; its virtual one has its rack and profile shift.
    load_diameter : float
        d_en of the virtual gear [modules]; whole gears take the load at the same height above the pitch circle.
    settings : MeshSettings
    cache : SolutionCache, optional
        Of solved teeth.
    """
    z_n = virtual_teeth(gear.teeth, gear.helix_angle, gear.normal_pressure_angle)
    m, addendum = gear.module, gear.tooth.tip_radius - gear.tooth.pitch_radius
    counts = sorted({math.floor(z_n + 1e-9), math.ceil(z_n - 1e-9)})
    found = []
    for z in counts:
        tooth = replace(gear.external_tooth, teeth=z, tip_radius=0.5 * z + addendum, helix_angle=0.0)
        radius = 0.5 * (load_diameter - z_n + z)
        wheel = Gear(tooth, m, 0.5 * tooth.root_radius * m)
        known = solve_gear(wheel, settings, reach=0, estimate_error=False, cache=cache)
        found.append(m * float(known.largest_root_stress(0, "tension", np.array([radius * m]))[0][0]))
    if len(found) == 1:
        return VirtualRootStress(tuple(counts), found[0])
    low, high = counts
    part = (1.0 / low - 1.0 / z_n) / (1.0 / low - 1.0 / high)
    return VirtualRootStress((low, high), found[0] + part * (found[1] - found[0]))
