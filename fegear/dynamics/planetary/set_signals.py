"""Transmission error and mesh forces of a set until the same teeth mesh again: orders, indicators, lines at the ring.

What repeats after C base pitches has lines at whole multiples of 1/C of the mesh frequency: of one odd tooth of a
planet C is the number of its teeth, of sun and ring theirs; of odd teeth of two gears it is the hunting period. A
pick-up on the ring sees the force of each planet's mesh while the planet passes, by the window (1 + cos theta) / 2 with
theta its angle from the pick-up (McFadden and Smith 1985), so that a line k / C has neighbours at k / C +- 1 / z_r.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import shown
from fegear.contact.plane.sidebands import HIGHEST, ConditionIndicators, amplitudes, indicators_of

if TYPE_CHECKING:
    from fegear.base.arrays import Complex
    from fegear.dynamics.planetary.planet_set import PlanetarySet

#: Lines of the pick-up up to this mesh harmonic; smaller ones than this share of the largest are none.
_HARMONICS, _NO_LINE = 3, 1e-9


@dataclass(frozen=True)
class SetOrders:
    """Harmonics over C base pitches, by their number n = 1..N."""

    n: Index = shown("", "harmonic of all base pitches until the same teeth mesh again")
    mesh_order: Array = shown("", "order of the tooth-mesh frequency")
    frequency: Array | None = shown("Hz", "frequency of the line, relative to the carrier")
    te: Array = shown("um", "amplitude of this order of the transmission error", label="transmission error")
    load: Array = shown(
        "N", "amplitude of this order of the mesh force of the planet with odd teeth", label="mesh force"
    )


@dataclass(frozen=True)
class RingLines:
    """Lines of a pick-up on the ring that planets pass, in ascending order."""

    order: Array = shown("", "order of the tooth-mesh frequency, observed at the ring")
    frequency: Array | None = shown("Hz", "frequency of the line, observed at the ring")
    force_order: Array = shown("", "order of the mesh forces that makes the line; integers are mesh harmonics")
    passing: Index = shown("", "revolutions of the carrier added by the planets passing: -1, 0 or 1")
    force: Array = shown("N", "amplitude of the ring mesh forces as the planets pass", label="force at the ring")


@dataclass(frozen=True)
class SetSignals:
    """Even samples over all base pitches until the same teeth mesh again, M of them.

    Parameters
    ----------
    found : PlanetarySet
    base_pitches : int
        C.
    odd_planet : int
        The planet that has the odd teeth of the planets, from 0.
    teeth : tuple of int
        Numbers of teeth of the gears with odd teeth.
    frequency : float
        Mesh frequency [Hz]; NaN without a speed.
    clockwise : bool
        Whether the sun turns clockwise relative to the carrier.
    mean_force : float
        In every mesh with the sun where all planets carry alike [N].
    te : ndarray, shape (M,)
        Transmission error at the driving member [m].
    mesh_force : ndarray, shape (2, planets, M)
        At sun (0) and ring (1) [N].
    """

    found: PlanetarySet
    base_pitches: int
    odd_planet: int
    teeth: tuple[int, ...]
    frequency: float
    clockwise: bool
    mean_force: float
    te: Array
    mesh_force: Array

    @cached_property
    def orders(self) -> SetOrders:
        """Lines up to eight mesh harmonics."""
        n = np.arange(1, HIGHEST * self.base_pitches + 1)
        te, load = (amplitudes(one, n.size) for one in (self.te, self.mesh_force[0, self.odd_planet]))
        order = n / self.base_pitches
        return SetOrders(n, order, self._at_speed(order), te, load)

    def _at_speed(self, order: Array) -> Array | None:
        return None if math.isnan(self.frequency) else order * self.frequency

    @cached_property
    def indicators(self) -> ConditionIndicators:
        """Condition indicators of the transmission error."""
        return indicators_of(self.te, self.base_pitches, self.teeth)

    @cached_property
    def at_ring(self) -> RingLines:
        """What a pick-up on the ring, at the angle zero of the planets when the cycle begins, sees of their meshes."""
        count, ring = self.base_pitches, self.found.ring_teeth
        even = self.mesh_force[1]
        series: Complex = np.fft.rfft(even)[:, : _HARMONICS * count + 1] / even.shape[1]
        lines = _passing(series, self.found.angles, -1.0 if self.clockwise else 1.0)
        # k / C + b / z_r in whole parts of 1 / (C z_r); negative orders are the conjugates of positive ones
        added: dict[int, list[tuple[complex, int, int]]] = {}
        for passing, line in lines.items():
            for k, value in enumerate(line.tolist()):
                number = k * ring + passing * count
                if number and (k or passing > 0):
                    part = value if number > 0 else value.conjugate()
                    added.setdefault(abs(number), []).append((part, k, passing))
        return self._ring_lines(added, count * ring)

    def _ring_lines(self, added: dict[int, list[tuple[complex, int, int]]], parts: int) -> RingLines:
        numbers = sorted(added)
        largest = [max(added[number], key=lambda one: abs(one[0])) for number in numbers]
        force = 2.0 * np.array([abs(sum(one[0] for one in added[number])) for number in numbers])
        kept = force > _NO_LINE * self.mean_force
        order = np.array(numbers)[kept] / parts
        force_order = np.array([k for _, k, _ in largest])[kept] / self.base_pitches
        passing = np.array([turns for _, _, turns in largest], dtype=int)[kept]
        return RingLines(order, self._at_speed(order), force_order, passing, force[kept])


def _passing(series: Complex, angles: Array, sense: float) -> dict[int, Complex]:
    """Sums over the planets of their lines, shape (lines,), by the revolutions of the carrier that passing adds."""
    turned = np.exp(1j * sense * angles)[:, None]
    found = {0: 0.5 * series.sum(axis=0)}
    # the window's e^{i theta} and e^{-i theta}, of planets that stand at their angles when the cycle begins
    found[1] = 0.25 * (turned * series).sum(axis=0)
    found[-1] = 0.25 * (np.conj(turned) * series).sum(axis=0)
    return found
