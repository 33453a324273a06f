"""ISO 6336-6: service life and safety under a load spectrum by Miner's rule, and the equivalent load of a spectrum.

Source: ISO 6336-6:2019 (and 2006), clauses 4 and 5 (damage sums, safety by iteration) and annex A (application factor
from a spectrum). Stress over load cycles is the polyline in logarithms of parts 2 and 3 (`life.Knots`): above its first
value no cycle is borne, below its last one none does damage. Stresses in Pa.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.formulas.iso6336.life import Knots

#: Halvings of the interval of the safety: to round-off.
_HALVINGS = 200
#: By how much the line of annex C goes on below the load cycles of static strength.
_ABOVE = 10.0


def cycles_to_failure(curve: Knots, stress: float) -> float:
    """N of a stress on an S-N curve: 0 above its static value, inf at and below its last one.

    Parameters
    ----------
    curve : Knots
        Permissible stress [Pa] over load cycles, falling.
    stress : float
        [Pa].
    """
    if stress > curve.values[0]:
        return 0.0
    if stress <= curve.values[-1]:
        return math.inf
    for (n_0, n_1), (s_0, s_1) in zip(itertools.pairwise(curve.cycles), itertools.pairwise(curve.values), strict=True):
        if stress > s_1:
            return float(n_0 * (n_1 / n_0) ** (math.log(stress / s_0) / math.log(s_1 / s_0)))
    raise AssertionError(stress)


@dataclass(frozen=True, slots=True)
class ServiceLife:
    """Life of flank and root of one gear.

    Parameters
    ----------
    flank, root : float
        [s]; inf where nothing does damage, NaN where it is not known.

    Raises
    ------
    RangeError
        If a life is negative.
    """

    flank: float
    root: float

    def __post_init__(self) -> None:
        """Refuse lives below zero."""
        for name in ("flank", "root"):
            if getattr(self, name) < 0.0:
                raise RangeError(f"life of the {name}", f"{getattr(self, name):.6g} s", "must not be negative")


@dataclass(frozen=True, slots=True)
class Bin:
    """One level of a spectrum.

    Parameters
    ----------
    stress : float
        [Pa], 0 for idle running.
    cycles : float
        n_i, load cycles at it.
    curve : Knots
        What is borne at the speed of this level.
    """

    stress: float
    cycles: float
    curve: Knots

    def __post_init__(self) -> None:
        """Refuse stresses and load cycles below zero."""
        for name in ("stress", "cycles"):
            if not getattr(self, name) >= 0.0:
                raise RangeError(name, getattr(self, name), "must not be negative")

    def damage(self, safety: float = 1.0) -> float:
        """n_i / N_i of the stress times a safety."""
        if self.cycles == 0.0 or self.stress == 0.0:
            return 0.0
        bearable = cycles_to_failure(self.curve, self.stress * safety)
        return math.inf if bearable == 0.0 else self.cycles / bearable


def damage(bins: Sequence[Bin], safety: float = 1.0) -> float:
    """Miner sum U of a spectrum whose stresses are raised by a safety; failure is at 1."""
    return sum(one.damage(safety) for one in bins)


def spectrum_safety(bins: Sequence[Bin]) -> float:
    """Safety factor in stress: the largest by which all stresses may be raised before the Miner sum passes 1.

    Raises
    ------
    RangeError
        If no bin has stress and cycles.
    """
    bounds = [one.curve.values[0] / one.stress for one in bins if one.stress > 0.0 and one.cycles > 0.0]
    if not bounds:
        raise RangeError("spectrum", "(no load)", "must have a bin with a load and a share of the time")
    high = min(bounds)
    if damage(bins, high) <= 1.0:
        return high
    low = min(one.curve.values[-1] / one.stress for one in bins if one.stress > 0.0 and one.cycles > 0.0)
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high)
        if not low < middle < high:
            break
        low, high = (middle, high) if damage(bins, middle) <= 1.0 else (low, middle)
    return low


def service_life(bins: Sequence[Bin], life: float) -> float:
    """Life until the Miner sum is 1, in the unit of `life`, which the bins' cycles are for; inf without damage."""
    total = damage(bins)
    return math.inf if total == 0.0 else life / total


def annex_c_line(life: Knots, endurance: float) -> Knots:
    """S-N line of the flanks of the example in annex C: sigma_Hlim Z_NT with the film factors of reference throughout.

    ISO 6336-2 lets the film factors come in between static strength and reference, so that Z_NT = 1.6 is borne without
    them. The line goes on above Z_NT = 1.6, down to a tenth of its load cycles: the printed example has stresses there.

    Parameters
    ----------
    life : Knots
        Z_NT over load cycles.
    endurance : float
        Stress borne at the reference number of load cycles, all factors counted [Pa].
    """
    (n_0, n_1), (z_0, z_1) = life.cycles[:2], life.values[:2]
    first = z_0 * (z_0 / z_1) ** (math.log(_ABOVE) / math.log(n_1 / n_0))
    reference = life.values[-2]
    values = tuple(endurance / reference * z for z in (first, *life.values))
    return Knots((n_0 / _ABOVE, *life.cycles), values)


def wohler_exponent(curve: Knots) -> float:
    """p of the S-N line between its static and its reference knot: N ~ stress^-p; inf of a level one."""
    reference = len(curve.cycles) - 2
    rise = math.log(curve.values[0] / curve.values[reference])
    return math.log(curve.cycles[reference] / curve.cycles[0]) / rise if rise > 0.0 else math.inf


def equivalent_torque(torque: Array, cycles: Array, exponent: float, limit: float) -> float:
    """T_eq, whose N_Lref load cycles do the damage of a spectrum (ISO 6336-6, annex A); T_eq over T_n is its K_A.

    The cycles n_i of a level count as n_i (T_i / T_eq)^p; levels below T_eq do no damage, as the S-N line has its knee
    at N_Lref.

    Parameters
    ----------
    torque, cycles : ndarray, shape (N,)
        Levels in any order.
    exponent : float
        p in torque: half of that in stress for flanks, that in stress for roots.
    limit : float
        N_Lref, load cycles at the knee.

    Raises
    ------
    RangeError
        If no level has a torque and load cycles.
    """
    levels = [(t, n) for t, n in zip(torque.tolist(), cycles.tolist(), strict=True) if t > 0.0 and n > 0.0]
    if not levels:
        raise RangeError("spectrum", "(no load)", "must have a level with a load and load cycles")
    levels.sort(reverse=True)
    top, summed, found = levels[0][0], 0.0, 0.0
    for t, n in levels:
        if found >= t:  # this level and all lower ones do no damage
            break
        summed += n * (t / top) ** exponent
        found = min(top * (summed / limit) ** (1.0 / exponent), t)
    return found
