"""The closed forms of `fegear.formulas` compared with the finite elements of the same gear.

What is compared, in every function: one tooth of the whole ring under one load normal to its flank, no other tooth
loaded, per unit line load (secant, not local slope). Formulas outside their range leave a reason in words.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.formulas import hertz
from fegear.formulas.outcome import ComplianceSource, attempt
from fegear.formulas.root_section import load_line
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.formulas.sources import SOURCES, pair_compliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.contact.plane.fe_compliance import SolvedTeeth
    from fegear.contact.plane.pair_compliance import PairCompliance

_REASON = "reason if the formula gives no value"


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
        "um.mm/N", "deflection by the formula along the line of action per line load", name="compliance",
        label="deflection per line load",
    )  # fmt: skip
    parts: Array = shown("um.mm/N", "component of the formula")
    reasons: tuple[str, ...] = shown("", _REASON, name="reason")


@dataclass(frozen=True, slots=True)
class PairReference(ReadOnlyArrays):
    """Finite elements of one tooth pair over contact positions, shape (N,); compliances per unit line load."""

    x: Array = shown(
        "mm", "contact point from the pitch point, positive towards the driver's tip",
        label="contact point from the pitch point",
    )  # fmt: skip
    driver: Array = shown("um.mm/N", "FE, driver tooth with its share of the contact deformation", name="driver_fe")
    driven: Array = shown("um.mm/N", "FE, driven tooth with its share of the contact deformation", name="driven_fe")
    half_width: Array = shown("mm", "Hertzian half-width under the line load", name="contact_half_width")

    @property
    @shows("um.mm/N", "FE, one tooth pair including contact", name="compliance_fe")
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
            reasons[i] = f"gives {values[i, 0]:.3g}: radial compression exceeds bending"
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


def contact_room(pair: GearPair, x: Array, member: Member) -> Array:
    """Length of a gear's flank from contacts at positions x [m] to the nearer end of its involute [m]."""
    gear, r = pair.gear(member), pair.radius(x, member)
    low, high = gear.involute_radii
    return np.asarray(np.minimum(r**2 - low**2, high**2 - r**2) / (2.0 * gear.base_radius))


def contact_fits(pair: GearPair, x: Array, half_width: Array) -> NDArray[np.bool_]:
    """Whether the flanks of both gears hold contacts of these half-widths [m] at positions x [m]."""
    from fegear.fem.plane.contact_width import flank_holds

    fits = np.ones(x.shape, dtype=bool)
    for member in MEMBERS:
        module = pair.gear(member).module
        fits &= flank_holds(half_width / module, contact_room(pair, x, member) / module)
    return fits


def positions_on_flanks(pair: GearPair, line_load: float, count: int) -> Array:
    """Contact positions, even over the path as far as contacts do not reach past a tip or form circle, (count,) [m].

    Nearer to the ends the deflection is that of the last contact that the flank holds, not of the position. Under loads
    so heavy that no contact has room it is the whole path.
    """
    x = np.linspace(pair.x_start, pair.x_end, _LOOKED_AT)
    width = contact_half_width(pair, x, line_load)
    whole = np.flatnonzero(np.all([contact_room(pair, x, member) >= width for member in MEMBERS], axis=0))
    first, last = (0, -1) if not whole.size else (whole[0], whole[-1])
    return np.linspace(x[first], x[last], count)


#: Positions over the path at which contacts are tried, and at which it is looked where they have room.
_TRIED, _LOOKED_AT = 101, 2001


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
        rule = f"gives a contact half-width of at least {width.min() * 1e3:.4g} mm, wider than the flanks"
        raise InputError(key, value, rule, remedy)


def pair_reference(
    pair: GearPair, driver: SolvedTeeth, driven: SolvedTeeth, x: ArrayLike, line_load: float
) -> PairReference:
    """Finite elements of one tooth pair under a Hertzian contact.

    Positions off a meshed flank are skipped, and those near its ends where the contact is wider than the flank.

    Parameters
    ----------
    pair : GearPair
    driver, driven : SolvedTeeth
    x : array_like
        Contact positions [m].
    line_load : float
        w [N/m], > 0; it sets the contact's width.
    """
    at = np.atleast_1d(np.asarray(x, dtype=float))
    members: Sequence[tuple[Member, SolvedTeeth]] = (("driver", driver), ("driven", driven))
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


def mean_mesh_stiffness(pair: GearPair, driver: SolvedTeeth, driven: SolvedTeeth, line_load: float) -> float:
    """Mean of the secant mesh stiffness over a base pitch, per face width [Pa]: what c_gamma_alpha stands for.

    Perfect involutes that touch on the path of contact only, teeth coupled through their gears.

    Parameters
    ----------
    pair : GearPair
    driver, driven : SolvedTeeth
    line_load : float
        Of all tooth pairs together, along the line of action [N/m].

    Raises
    ------
    InputError
        If no tooth pair is on the path at some roll positions.
    """
    from fegear.contact.plane.fe_compliance import finite_element_compliance
    from fegear.contact.plane.pair_compliance import PairCompliance

    teeth = PairCompliance(pair, finite_element_compliance(driver), finite_element_compliance(driven))
    return mean_stiffness_of(teeth, line_load)


def mean_stiffness_of(teeth: PairCompliance, line_load: float) -> float:
    """The same of teeth whose compliance is known, by finite elements or a formula [Pa]."""
    from fegear.contact.plane.base_pitch import mean_secant_stiffness
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.transmission_error import transmission_error

    face_width = teeth.pair.face_width
    return mean_secant_stiffness(transmission_error(Engagement(teeth), line_load * face_width)) / face_width
