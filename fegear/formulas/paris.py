"""Paris' law of crack growth: da/dN = C dK^m between a threshold and the toughness (Paris and Erdogan 1963)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.given import given


@dataclass(frozen=True)
class ParisLaw:
    """Growth per load cycle in metres, stress intensity in MPa m^(1/2)."""

    paris_coefficient: float = given(
        meaning="Coefficient C of da/dN = C ΔK^m, in m per cycle with ΔK in MPa·m^(1/2).", above=0.0
    )
    paris_exponent: float = given(meaning="Exponent m of da/dN = C ΔK^m.", above=0.0, at_most=20.0)
    threshold: float = given(
        meaning="Threshold of ΔK in MPa·m^(1/2), below which the crack does not grow.", default=0.0, at_least=0.0
    )

    def rate(self, intensity: Array, factors: Sequence[float] = (1.0,), shares: Sequence[float] = (1.0,)) -> Array:
        """Mean growth per cycle [m].

        Parameters
        ----------
        intensity : ndarray, shape (S,)
            Range of stress intensity at the nominal load [Pa m^(1/2)].
        factors, shares : sequence of float
            Loads over the nominal one, and in which share of the cycles they act.
        """
        found = np.zeros(np.shape(intensity))
        for factor, share in zip(factors, shares, strict=True):
            k = factor * np.asarray(intensity) * 1e-6
            grows = k > self.threshold
            found[grows] += share * self.paris_coefficient * k[grows] ** self.paris_exponent
        return found


def cycles_to(length: Array, rate: Array) -> Array:
    """Load cycles up to each length, the rate a power of the length between two of them, shape (S,).

    Infinite from where the crack stops.

    Parameters
    ----------
    length : ndarray, shape (S,)
        Of the crack, ascending [m].
    rate : ndarray, shape (S,)
        Growth per cycle [m].
    """
    total = np.zeros(length.size)
    for n in range(length.size - 1):
        a, ratio = float(length[n]), float(length[n + 1] / length[n])
        if min(rate[n], rate[n + 1]) <= 0.0:
            total[n + 1 :] = math.inf
            break
        power = 1.0 - math.log(rate[n + 1] / rate[n]) / math.log(ratio)
        # integral of (x / a)^(power - 1) from a to b
        along = math.log(ratio) if abs(power) < 1e-9 else math.expm1(power * math.log(ratio)) / power
        total[n + 1] = total[n] + a * along / float(rate[n])
    return total


def length_at(length: Array, intensity: Array, limit: float) -> float | None:
    """Where stress intensity reaches a limit first, a power of the length between two; None if it does not."""
    for n in range(length.size):
        if intensity[n] >= limit:
            if n == 0 or intensity[n] == intensity[n - 1]:
                return float(length[n])
            share = math.log(limit / intensity[n - 1]) / math.log(intensity[n] / intensity[n - 1])
            return float(length[n - 1] * (length[n] / length[n - 1]) ** share)
    return None
