"""Where each root-stress formula is high, low or breaks down: a sweep of teeth compared with finite elements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import FegearError, InputError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.compared.crosscheck import RootStressAnswers, root_stress_answers
from fegear.contact.compared.population import Population
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear

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
        return f"within {100.0 * BAND:g} %"
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
                gear, reason = None, f"no FE solution: {error}"
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
