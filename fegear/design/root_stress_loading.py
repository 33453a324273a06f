"""Loading functions chosen for the least stress (Mark, section 4: F and r for contact ratios above 2).

By the larger root tension of both gears alone, or together with the pressure between the flanks, which the paper says
might be taken into account: then by the larger of both over what the case allows of each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.design.loading import LoadingFunction, Ramp
from fegear.geometry.pair import MEMBERS, Member


@dataclass(frozen=True)
class DesignStress:
    """Largest root tension that design loads cause, per unit design load, as a function of the loading.

    Parameters
    ----------
    roots : mapping of member to RootStress
    rows : mapping of member to list of (x of the load, ndarray (P, points))
        Fillet stress of the tooth at x per unit line load on the pair at x + k A.
    """

    compliance: PairCompliance
    x: Array
    roots: dict[Member, RootStress]
    rows: dict[Member, list[tuple[Array, Array]]]

    def largest(self, loading: LoadingFunction, member: Member) -> float:
        """Largest root tension over the path [Pa] for a design load of 1 N."""
        roots, rows = self.roots[member], self.rows[member]
        felt = [Felt(loading.fraction(where) / self.compliance.face_width, row) for where, row in rows]
        total = roots.superposed(felt, rows[0][1].shape)
        return float(roots.largest(0, total, self.compliance.pair.radius(self.x, member)).max())

    def worst(self, loading: LoadingFunction) -> float:
        """The larger of both gears."""
        return max(self.largest(loading, member) for member in self.roots)

    def pressure(self, loading: LoadingFunction) -> float:
        """Largest Hertzian pressure over the path [Pa] for a design load of 1 N; it grows like the root of the load."""
        pair = self.compliance.pair
        a, b = (pair.flank_curvature_radius(self.x, member) for member in MEMBERS)
        loaded = loading.fraction(self.x) > 0.0
        relative = (a * b / (a + b))[loaded]
        return float(self.compliance.pressure(loading.fraction(self.x[loaded]), relative).max())


@dataclass(frozen=True, slots=True)
class Allowed:
    """What a loading is chosen by where both stresses count.

    Parameters
    ----------
    root_tension, hertz_pressure : float
        That may not be exceeded [Pa].
    load : float
        Design load [N].
    """

    root_tension: float
    hertz_pressure: float
    load: float

    def used(self, tension: float, pressure: float) -> float:
        """The larger share of what is allowed, of tension and pressure under 1 N."""
        return max(tension * self.load / self.root_tension, pressure * self.load**0.5 / self.hertz_pressure)


def design_stress(compliance: PairCompliance, positions: int = 121) -> DesignStress:
    """Collect the rows of root stress along the path once; then any loading costs a few products.

    Raises
    ------
    InputError
        If no gear's source knows root stress.
    """
    compliance.refuse_unequal("loadings by root stress")
    pair = compliance.pair
    x = np.linspace(pair.x_start, pair.x_end, positions)
    rows: dict[Member, list[tuple[Array, Array]]] = {}
    roots = {member: RootStress.of(compliance, member) for member in MEMBERS}
    for member, of_gear in roots.items():
        found = []
        for ahead in range(-of_gear.reach, of_gear.reach + 1):
            there = x + ahead * pair.base_pitch
            radius = pair.radius(np.clip(there, pair.x_start, pair.x_end), member)
            row = of_gear.row(0, of_gear.tooth(ahead), radius)
            if row is not None:
                found.append((there, row))
        if found:
            rows[member] = found
    if not rows:
        raise InputError("design", "root stress", "is not available with these compliance sources", 'set source = "fe"')
    return DesignStress(compliance, x, {member: roots[member] for member in rows}, rows)


@dataclass(frozen=True)
class StressOptimum:
    """Loading with the least largest stress.

    Parameters
    ----------
    loading : LoadingFunction
    stress : float
        Largest root tension of both gears per unit design load [Pa/N].
    pressure : float
        Largest Hertzian pressure under 1 N [Pa].
    candidates : tuple of (exponent or None, peak, stress, pressure)
        Best F of each exponent tried.
    """

    loading: LoadingFunction
    stress: float
    pressure: float
    candidates: tuple[tuple[int | None, float, float, float], ...]


def least_root_stress(
    stress: DesignStress,
    loading: LoadingFunction,
    exponents: Sequence[int | None] = (None, 3, 5, 7, 9),
    allowed: Allowed | None = None,
) -> StressOptimum:
    """Choose F and r so that the largest stress is least; the slope at contact initiation stays as given.

    Parameters
    ----------
    stress : DesignStress
    loading : LoadingFunction
        Contact ratio above 2; its first ramp's slope s is kept, its exponent and peak are replaced.
    exponents : sequence of int or None
        r to try; None is the sinusoidal family. Those too low for the slope are skipped.
    allowed : Allowed, optional
        With it the larger share of root tension and Hertzian pressure counts; without it root tension alone.
    """
    from scipy.optimize import minimize_scalar

    low, high = loading.peak_range
    if high - low <= 0.0:
        raise InputError(
            "design.peak", loading.peak, "is determined for contact ratios up to 2", "choose a longer design length"
        )
    slope = loading.ramp.slope
    found: list[tuple[float, LoadingFunction, int | None]] = []
    for r in exponents:
        if slope > (2.0 if r is None else r):
            continue
        base = replace(loading, ramp=Ramp(slope, r), inner_ramp=Ramp(1.0, r))

        def worst(peak: float, base: LoadingFunction = base) -> float:
            one = replace(base, peak=float(np.clip(peak, low, high)))
            tension = stress.worst(one)
            return tension if allowed is None else allowed.used(tension, stress.pressure(one))

        # The largest of several smooth functions of F has kinks: scan, then refine by golden section.
        scan = np.linspace(low, high, 21)
        values = [worst(float(f)) for f in scan]
        i = int(np.argmin(values))
        bracket = (float(scan[max(i - 1, 0)]), float(scan[min(i + 1, 20)]))
        result = minimize_scalar(worst, bounds=bracket, method="bounded", options={"xatol": 1e-6})
        peak = float(result.x) if result.fun < values[i] else float(scan[i])
        found.append((worst(peak), replace(base, peak=peak), r))
    if not found:
        raise InputError("design.exponent", tuple(exponents), f"has no solution for the initial slope {slope}")
    best = min(found, key=lambda item: item[0])
    candidates = tuple((r, f.peak, stress.worst(f), stress.pressure(f)) for _, f, r in found)
    return StressOptimum(best[1], stress.worst(best[1]), stress.pressure(best[1]), candidates)
