"""Where each root-stress formula is high, low or breaks down: a sweep of teeth compared with finite elements.

Gears drawn evenly over ranges of their numbers, and where they are loaded: a population for a study of formulas.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import FegearError, InputError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.compared.crosscheck import RootStressAnswers, root_stress_answers
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.gear import Gear
from fegear.geometry.tooth import Tooth

#: Half-width of the band that counts as agreement: what Cornell's abstract claims.
BAND = 0.05


@dataclass(frozen=True, slots=True)
class Variant:
    """One gear of the sweep: its numbers, and the gear itself or the reason why there is none.

    `load_position` is that of this gear alone, where every gear has its own.
    """

    teeth: int
    profile_shift: float
    rack_tip_radius: float
    gear: Gear | None
    reason: str = ""
    load_position: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class VariantStress:
    """Root stress of one gear over load positions, shape (P,), as stress x module / line load.

    Parameters
    ----------
    variant : Variant
    position : ndarray
        Share of the roll angle between the involute's start (0) and its end (1).
    radius : ndarray
        Load radii [m].
    fe, fe_angle : ndarray
        Largest tangential stress of the fillet below the loaded flank, and its tangent angle [rad].
    answers : dict of str to RootStressAnswers
    fe_error : ndarray
        Estimated error of `fe`; NaN where it was not asked for.
    """

    variant: Variant
    position: Array
    radius: Array
    fe: Array
    fe_angle: Array
    answers: dict[str, RootStressAnswers]
    fe_error: Array


def verdict(ratio: float) -> str:
    """Call a formula's ratio to the finite elements "high", "low", "within 5 %", or "breaks down" (NaN)."""
    if not np.isfinite(ratio):
        return "breaks down"
    if abs(ratio - 1.0) <= BAND:
        return f"within {BAND:.0%}".replace("%", " %")
    return "high" if ratio > 1.0 else "low"


def variants(
    base: Gear, teeth: Sequence[int], profile_shift: Sequence[float], rack_tip_radius: Sequence[float]
) -> list[Variant]:
    """Every combination; all keep the base gear's rack, module, tip shape and ratio of bore to root radius."""
    found = []
    share, t = base.bore_radius / base.root_radius, base.external_tooth
    for z, x, rho in product(teeth, profile_shift, rack_tip_radius):
        try:
            tooth = Tooth(
                z, replace(t.rack, tip_radius=rho), profile_shift=x, thickness_allowance=t.thickness_allowance,
                tip_rounding=t.tip_rounding, tip_chamfer=t.tip_chamfer,
            )  # fmt: skip
            bore = share * tooth.root_radius * base.module
            gear = Gear(tooth, base.module, bore, base.face_width, base.material, base.plane)
        except InputError as error:
            found.append(Variant(z, x, rho, None, f"no such gear: {error}"))
        else:
            found.append(Variant(z, x, rho, gear))
    return found


def of_population(population: Population) -> list[Variant]:
    """The gears of a population, each with its own load positions."""
    return [
        Variant(
            d.gear.teeth, d.gear.tooth.profile_shift, d.gear.external_tooth.rack.tip_radius, d.gear,
            load_position=d.load_position,
        )
        for d in population.gears
    ]  # fmt: skip


def load_radii(gear: Gear, position: ArrayLike) -> Array:
    """Radii [m] at shares of the roll angle between start and end of the involute."""
    ends = (gear.form_radius, gear.involute_tip_radius)
    low, high = (np.sqrt(max((r - gear.base_radius) * (r + gear.base_radius), 0.0)) for r in ends)
    return np.clip(np.hypot(gear.base_radius, low + (high - low) * np.asarray(position, dtype=float)), *ends)


def root_stress_study(
    gears: Sequence[Variant],
    position: Sequence[float],
    settings: MeshSettings,
    progress: Callable[[float], None] | None = None,
    cache: SolutionCache | None = None,
    *,
    estimate_error: bool = False,
) -> list[VariantStress]:
    """Root stress of every gear by finite elements and by every formula.

    There are no neighbours, and a second mesh only where the error of the finite elements is to be estimated.
    """
    from fegear.fem.plane.solution import solve_gear

    found = []
    for number, variant in enumerate(gears, start=1):
        gear, reason = variant.gear, variant.reason
        at = np.asarray(variant.load_position or position, dtype=float)
        nothing = np.full(at.shape, np.nan)
        if gear is not None:
            radii = load_radii(gear, at)
            try:
                known = solve_gear(gear, settings, reach=0, estimate_error=estimate_error, cache=cache)
            except FegearError as error:
                gear, reason = None, f"no finite elements: {error}"
            else:
                value, arc = known.largest_root_stress(0, "tension", radii)
                fillet = known.fine.fillets["tension"]
                angle = np.interp(arc / gear.module, fillet.arc, fillet.tangent_angle)
                answers = root_stress_answers(gear.external_tooth, radii / gear.module)
                off = known.root_stress_error(0, "tension", radii) * gear.module if estimate_error else nothing
                found.append(VariantStress(variant, at, radii, value * gear.module, angle, answers, off))
        if gear is None:
            found.append(
                VariantStress(replace(variant, gear=None, reason=reason), at, nothing, nothing, nothing, {}, nothing)
            )
        if progress:
            progress(number / len(gears))
    return found


#: Loads on every gear, one in each of as many equal parts of the range of load positions.
LOADS = 8


#: So many draws for one gear at most: ranges that hold fewer teeth are no population.
_DRAWS = 20


@dataclass(frozen=True, slots=True)
class Drawn:
    """A gear of a population.

    Parameters
    ----------
    gear : Gear
    load_position : tuple of float
        Shares of the roll angle between the involute's start (0) and end (1).
    """

    gear: Gear
    load_position: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Population:
    """What was drawn.

    Parameters
    ----------
    gears : tuple of Drawn
    tried : int
        Draws that it took: the others gave teeth that cannot be cut, pointed ones or none.
    """

    gears: tuple[Drawn, ...]
    tried: int


def drawn_gears(base: Gear, bounds: Mapping[str, tuple[float, float]], samples: int, seed: int = 0) -> Population:
    """Draw gears evenly (a scrambled Sobol sequence) over the part of a box in which teeth can be cut.

    Parameters
    ----------
    base : Gear
        What the box leaves open: module, addendum, tip shape, ratio of bore to root radius.
    bounds : mapping of str to (float, float)
        Lowest and highest ``teeth`` (drawn evenly in their logarithm), ``profile_shift``, ``rack_tip_radius``,
        ``rack_dedendum``, ``pressure_angle`` [rad] and ``load_position``; without one the base gear's own, and all of
        the involute.
    samples : int
    seed : int
        The same seed draws the same gears.

    Raises
    ------
    InputError
        If hardly any draw gives a tooth.
    """
    from scipy.stats import qmc

    t = base.external_tooth
    own = {
        "teeth": t.teeth, "profile_shift": t.profile_shift, "rack_tip_radius": t.rack.tip_radius,
        "rack_dedendum": t.rack.dedendum, "pressure_angle": t.rack.pressure_angle,
    }  # fmt: skip
    box = {**{k: (float(v), float(v)) for k, v in own.items()}, "load_position": (0.0, 1.0), **bounds}
    keys = list(own)
    sequence = qmc.Sobol(len(keys) + 1, seed=seed)
    found: list[Drawn] = []
    tried = 0
    while len(found) < samples and tried < _DRAWS * samples + 256:
        for u in sequence.random(64):
            tried += 1
            tooth = _tooth(t, {k: _between(box[k], float(v), log=k == "teeth") for k, v in zip(keys, u, strict=False)})
            if tooth is None:
                continue
            bore = base.bore_radius / base.root_radius * tooth.root_radius * base.module
            low, high = box["load_position"]
            at = low + (high - low) * (np.arange(LOADS) + u[-1]) / LOADS
            gear = Gear(tooth, base.module, bore, base.face_width, base.material, base.plane)
            found.append(Drawn(gear, tuple(at.tolist())))
            if len(found) == samples:
                break
    if len(found) < samples:
        raise InputError(
            "study", f"{len(found)} of {tried} draws", "gave a tooth that can be cut", "choose narrower ranges"
        )
    return Population(tuple(found), tried)


def share_error(hits: Array) -> float:
    """Standard error of a share over drawn gears, from its spread between them: loads of one gear are not independent.

    Where all gears say the same the next may be the first that does not: that is one of two more (Laplace).

    Parameters
    ----------
    hits : ndarray, shape (gears, loads)
        0 or 1.
    """
    each = np.asarray(hits, dtype=float).mean(axis=1)
    spread = each.std(ddof=1) / math.sqrt(each.size) if each.size > 1 else 0.5
    return math.hypot(float(spread), 1.0 / (each.size + 2.0))


def _between(bounds: tuple[float, float], share: float, *, log: bool) -> float:
    low, high = bounds
    return low * (high / low) ** share if log else low + share * (high - low)


def _tooth(base: Tooth, drawn: Mapping[str, float]) -> Tooth | None:
    """The tooth of a draw, or None where there is none."""
    try:
        rack = replace(
            base.rack, tip_radius=drawn["rack_tip_radius"], dedendum=drawn["rack_dedendum"],
            pressure_angle=drawn["pressure_angle"],
        )  # fmt: skip
        return Tooth(
            round(drawn["teeth"]), rack, drawn["profile_shift"], thickness_allowance=base.thickness_allowance,
            tip_rounding=base.tip_rounding, tip_chamfer=base.tip_chamfer,
        )  # fmt: skip
    except InputError:
        return None


def unevenness(values: Array, low: Array, high: Array) -> float:
    """Largest miss of the share of points in any of the sixteenths of each coordinate's range: 0 is even.

    Parameters
    ----------
    values : ndarray, shape (N, D)
    low, high : ndarray, shape (D,)
    """
    counts = [np.histogram(v, 16, (a, b))[0] / v.size for v, a, b in zip(values.T, low, high, strict=True) if b > a]
    return max((float(np.abs(c * 16.0 - 1.0).max()) for c in counts), default=math.nan)
