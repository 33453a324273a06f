"""Mesh and bearing forces of a helical pair over speed (Blankenship and Singh, Eqs. 9 to 11, 17, 18 and 22).

The excitation is a set of lines: each follows the driver's speed (transmission error, a force of an order of a shaft)
or keeps its frequency, and carries complex amplitudes ``x(t) = Re(X exp(i w t))``, 0-peak. A transmission error delta
acts on both gears, ``K_M delta + C_M delta'`` on gear i (9); external forces and moments act on one, ``D^-1 F`` (10).
The mesh force on gear i is ``-K_M (q_i + P q_j - delta) - C_M (...)'`` (11), in body coordinates ``D`` times that.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError
from fegear.dynamics.helical_pair.model import HelicalPairModel
from fegear.dynamics.helical_pair.transmissibility import natural_frequencies, transmissibility


@dataclass(frozen=True)
class Line:
    """One harmonic excitation.

    Parameters
    ----------
    order : float
        Frequency over the driver's speed; zero where it does not depend on it.
    frequency : float
        Circular frequency [rad/s] besides.
    error : tuple of complex
        Transmission error over q = (y, z, b theta_x, a theta_y, a theta_z) [m].
    on_driver, on_driven : tuple of complex
        External forces along y, z [N] and moments about x, y, z [N m].
    source : str
        What it is, for tables.
    """

    order: float = 0.0
    frequency: float = 0.0
    error: tuple[complex, ...] = (0.0,) * 5
    on_driver: tuple[complex, ...] = (0.0,) * 5
    on_driven: tuple[complex, ...] = (0.0,) * 5
    source: str = ""

    def __post_init__(self) -> None:
        """Refuse what has no frequency."""
        good = math.isfinite(self.order) and math.isfinite(self.frequency) and min(self.order, self.frequency) >= 0.0
        if not good or self.order + self.frequency <= 0.0:
            raise InputError("line", (self.order, self.frequency), "must have a frequency greater than zero")
        if not np.all(np.isfinite([*self.error, *self.on_driver, *self.on_driven])):
            raise InputError("line", self.source, "must have finite amplitudes")


@dataclass(frozen=True, eq=False)
class PairForces:
    """Forces of every line at every speed, complex 0-peak amplitudes.

    Components are forces along y, z [N] and moments about x, y, z [N m].

    Parameters
    ----------
    speed : ndarray, shape (S,)
        Of the driver [rad/s].
    lines : tuple of Line
        Lines of one frequency are one.
    frequency : ndarray, shape (L, S)
        Circular [rad/s].
    mesh : ndarray, shape (L, S, 5)
        What the mesh exerts on the driver (11).
    normal : ndarray, shape (L, S)
        Its force along the tooth normal [N].
    bearing_driver, bearing_driven : ndarray, shape (L, S, 5)
        What the bearings exert on their gears (22).
    """

    speed: Array
    lines: tuple[Line, ...]
    frequency: Array
    mesh: Complex
    normal: Complex
    bearing_driver: Complex
    bearing_driven: Complex


def joined_lines(lines: Sequence[Line]) -> tuple[Line, ...]:
    """Lines of one frequency added up, by rising order and frequency."""
    groups: dict[tuple[float, float], list[Line]] = defaultdict(list)
    for line in lines:
        groups[float(f"{line.order:.12g}"), float(f"{line.frequency:.12g}")].append(line)

    def total(group: list[Line], key: str) -> tuple[complex, ...]:
        return tuple(complex(v) for v in np.sum([getattr(line, key) for line in group], axis=0))

    return tuple(
        Line(order, frequency, total(group, "error"), total(group, "on_driver"), total(group, "on_driven"),
             " + ".join(dict.fromkeys(line.source for line in group)))
        for (order, frequency), group in sorted(groups.items())
    )  # fmt: skip


def pair_forces(model: HelicalPairModel, lines: Sequence[Line], speed: ArrayLike) -> PairForces:
    """Forces in the mesh and in the bearings of a pair that is excited by lines.

    Parameters
    ----------
    model : HelicalPairModel
    lines : sequence of Line
    speed : array_like, shape (S,)
        Of the driver [rad/s].

    Raises
    ------
    RangeError
        Where a line meets a resonance without damping.
    """
    omega, found = np.atleast_1d(np.asarray(speed, dtype=float)), joined_lines(lines)
    if omega.ndim != 1 or not omega.size or not np.all(np.isfinite(omega)) or np.any(omega <= 0.0):
        raise InputError("speed", speed, "must be finite speeds greater than zero")
    if not found:
        raise InputError("lines", "none", "must be at least one")
    i, j = model.driver, model.driven
    frequency = np.array([line.order * omega + line.frequency for line in found])
    parts = [_of_line(model, line, w) for line, w in zip(found, frequency, strict=True)]
    mesh, at_i, at_j = (np.array(part, dtype=complex) for part in zip(*parts, strict=True))
    c, s = math.cos(model.mesh.base_helix_angle), math.sin(model.mesh.base_helix_angle)
    normal = np.asarray(0.5 * mesh @ np.array([c, s, 0.0, -s, c], dtype=complex))
    size_i, size_j = (1.0 / i.scale).astype(complex), (1.0 / j.scale).astype(complex)
    return PairForces(omega, found, frequency, mesh * size_i, normal, at_i * size_i, at_j * size_j)


def _of_line(model: HelicalPairModel, line: Line, w: Array) -> tuple[Complex, Complex, Complex]:
    """Forces over q of the mesh on the driver and of both bearings, (S, 5) each; over all speeds at once."""
    steady = line.order == 0.0  # one frequency for all speeds
    t = transmissibility(model, w[:1] if steady else w)
    delta = np.array(line.error)
    f_i, f_j = model.driver.scale * np.array(line.on_driver), model.driven.scale * np.array(line.on_driven)
    parts = (
        t.G @ delta - t.R_ii @ f_i - t.R_ij @ f_j,
        -(t.G_B_i @ delta + t.R_B_ii @ f_i + t.R_B_ij @ f_j),
        -(t.G_B_j @ delta + t.R_B_ji @ f_i + t.R_B_jj @ f_j),
    )
    a, b, c = (np.broadcast_to(part, (w.size, 5)) for part in parts)
    return a, b, c


def resonant_speeds(model: HelicalPairModel, lines: Sequence[Line]) -> tuple[Array, Array]:
    """Driver's speeds [rad/s] at which a line meets a natural frequency, and those where nothing damps it, rising."""

    def speeds(natural: Array) -> Array:
        found = [(natural - line.frequency) / line.order for line in joined_lines(lines) if line.order > 0.0]
        met = np.unique(np.concatenate([np.empty(0), *found]))
        return np.asarray(met[met > 0.0])

    every, undamped = natural_frequencies(model)
    return speeds(every), speeds(undamped)


def rms(lines: Complex) -> Array:
    """Root mean square over time of lines of different frequencies, shape (L, ...) -> (...)."""
    return np.asarray(np.sqrt(0.5 * (np.abs(lines) ** 2).sum(axis=0)))
