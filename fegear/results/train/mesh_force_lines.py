"""Lines of a mesh force, at a speed and over speeds, as they are tabulated and drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.results.train.ripple_spectrum import DrawnLines, RippleLines, Strongest

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.mesh_force_spectrum import MeshForceSpectrum
    from fegear.dynamics.train.tooth_force import Pull
    from fegear.dynamics.train.torque_response import RippleSpectrum

#: Lines weaker than these shares of the strongest are not drawn in spectrum and waterfall.
WEAKEST, WEAKEST_OVER_SPEED = 1e-3, 1e-2
#: Whole harmonics that are stronger than this share of the strongest line bear their number.
_NUMBERED = 1e-2
#: Lines are drawn until this share of the mean square is left, within these harmonics of the highest mesh frequency.
_LEFT, _LEAST_HARMONICS, MOST_HARMONICS = 1e-3, 8, 24
#: Force that is none [N].
_NO_FORCE = 1e-12


@dataclass(frozen=True)
class MeshLines:
    """Lines in the force of one mesh, a row for each line and speed, the speed fastest."""

    found: MeshForceSpectrum
    train: GearTrain
    mesh: int

    @property
    def _lines(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Exciting mesh and number of each line."""
        from_pair, line = np.nonzero(self.found.present)
        return np.repeat(from_pair, self.found.speeds.size), np.repeat(line, self.found.speeds.size)

    @property
    def n(self) -> NDArray[np.generic]:
        """Harmonic; fractions are rotational harmonics."""
        order = self.found.orders[self._lines[1]]
        return order.astype(int) if np.all(self.found.orders % 1.0 == 0.0) else order

    @property
    @shows("", "mesh whose transmission error excites the line")
    def from_pair(self) -> NDArray[np.str_]:
        """Names."""
        return np.array(self.train.names, dtype=str)[self._lines[0]]

    @property
    @shows("rpm", "speed")
    def speed(self) -> Array:
        """Of the body that speeds refer to [rad/s]."""
        return np.tile(self.found.speeds * self.train.speed_ratio, self.found.present.sum())

    @property
    def frequency(self) -> Array:
        """[Hz]."""
        return self.found.frequencies[self.found.present].ravel()

    @property
    def amplitude(self) -> Array:
        """[N]."""
        return self.found.amplitudes[self.mesh][self.found.present].ravel()

    @property
    def power(self) -> Array:
        """[N^2]."""
        return self.found.power_lines[self.mesh][self.found.present].ravel()


@dataclass(frozen=True)
class SeriesLines(MeshLines):
    """Lines by M terms of Mark's series, with products of as many harmonics, beside the exact ones."""

    exact: MeshForceSpectrum

    @property
    @shows("N^2", "by quadrature between all discontinuities")
    def power_exact(self) -> Array:
        """[N^2]."""
        power = self.exact.power_lines[self.mesh, :, self.exact.orders % 1.0 == 0.0, 0].T
        return np.asarray(power[self.found.present])

    @property
    def rms(self) -> dict[str, float]:
        """Root mean square of all lines of each exciting mesh [N]."""
        power = self.found.power_lines[self.mesh, :, :, 0]
        return {name: math.sqrt(power[j].sum()) for j, name in enumerate(self.train.names)}


@dataclass(frozen=True)
class PowerPanel:
    """Every mesh harmonic of one exciting mesh as one-sided power; with the square of the mean force for its own."""

    name: str
    role: str
    notes: tuple[str, ...]
    ends: tuple[float, float]
    frequency: Array = shown("kHz", "frequency")
    power: Array = shown("N^2", "power of the spectral line")
    mean: Array | None = shown("N^2", "mean force squared")
    zero: Array = shown("kHz", "no frequency", default_factory=lambda: np.zeros(1))


@dataclass(frozen=True)
class SpectrumData:
    """Forces in one mesh at the case's speed, over its speeds (the waterfall) where it gives a range, and its pull.

    `series` has the lines by Mark's series, None where they are not wanted or the series does not apply; `ripple` and
    `ripple_waterfall` are the same of torque ripple; None without it.
    """

    train: GearTrain
    mesh: int
    spectrum: MeshForceSpectrum
    waterfall: MeshForceSpectrum | None
    pull: Pull | None
    ripple: RippleSpectrum | None = None
    ripple_waterfall: RippleSpectrum | None = None
    series: MeshForceSpectrum | None = None

    @cached_property
    def lines(self) -> MeshLines:
        """Lines at the case's speed."""
        return MeshLines(self.spectrum, self.train, self.mesh)

    @cached_property
    def lines_over_speed(self) -> MeshLines | None:
        """The waterfall."""
        return None if self.waterfall is None else MeshLines(self.waterfall, self.train, self.mesh)

    @cached_property
    def of_ripple(self) -> RippleLines | None:
        """Lines of torque ripple at the case's speed."""
        return None if self.ripple is None else RippleLines(self.ripple, self.train, self.mesh)

    @cached_property
    def of_ripple_over_speed(self) -> RippleLines | None:
        """Those of the waterfall."""
        return None if self.ripple_waterfall is None else RippleLines(self.ripple_waterfall, self.train, self.mesh)

    @cached_property
    def by_series(self) -> SeriesLines | None:
        """Lines by Mark's series."""
        return None if self.series is None else SeriesLines(self.series, self.train, self.mesh, self.spectrum)

    @property
    @shows("rpm", "speed of the spectrum")
    def speed(self) -> float:
        """Of the body that speeds refer to [rad/s]."""
        return float(self.spectrum.speeds[0]) * self.train.speed_ratio

    @property
    def amplitudes(self) -> Array:
        """At the case's speed [N], shape (meshes, harmonics)."""
        return self.spectrum.amplitudes[self.mesh, :, :, 0]

    @property
    def strongest(self) -> list[Strongest]:
        """Of each exciting mesh."""
        power, orders = self.spectrum.power_lines[self.mesh, :, :, 0], self.spectrum.orders
        return [
            Strongest(name, f"harmonic {orders[int(size.argmax())]:.6g}", float(size.max()), math.sqrt(power[j].sum()))
            for j, (name, size) in enumerate(zip(self.train.names, self.amplitudes, strict=True))
        ]

    @cached_property
    def drawn_to(self) -> tuple[float, float]:
        """Frequency up to which lines are drawn [Hz], and the share of the mean square that those above it hold."""
        return _highest_shown(self.spectrum, self.amplitudes)

    @property
    def stems(self) -> list[DrawnLines]:
        """Lines of the meshes at the case's speed, those of torque ripple behind them."""
        found, strongest, drawn = self.spectrum, float(self.amplitudes.max()), []
        for j, (name, amplitude) in enumerate(zip(self.train.names, self.amplitudes, strict=True)):
            frequency = found.frequencies[j, :, 0]
            shown = (amplitude > max(WEAKEST * strongest, _NO_FORCE)) & (frequency <= self.drawn_to[0])
            orders, size = found.orders[shown], amplitude[shown]
            whole = (orders % 1.0 == 0.0) & (size > _NUMBERED * strongest)
            drawn.append(
                DrawnLines(
                    f"from mesh {name}", f"series:{j}", tuple(f"harmonic {n:.6g}" for n in orders), frequency[shown],
                    size, numbers=tuple(f"{n:.0f}" if known else "" for n, known in zip(orders, whole, strict=True)),
                )
            )  # fmt: skip
        return [*drawn, *(self.of_ripple.stems if self.of_ripple is not None else ())]

    @property
    def between(self) -> bool:
        """Whether there are rotational harmonics."""
        return not np.all(self.spectrum.orders % 1.0 == 0.0)

    @property
    def power_panels(self) -> list[PowerPanel]:
        """One for each exciting mesh, its own first: how the paper draws them."""
        found, names, panels = self.spectrum, self.train.names, []
        power, whole = found.power_lines[self.mesh, :, :, 0], found.orders % 1.0 == 0.0
        top = float(found.frequencies[:, -1, 0].max())
        ends = (-0.02e-3 * top, 1.02e-3 * top)  # the mean stands on the ordinate
        for j in sorted(range(len(names)), key=lambda j: j != self.mesh):
            shown = found.present[j] & (power[j] > _NO_FORCE**2) & whole
            notes = tuple(f"harmonic {n:.6g}" for n in found.orders[shown])
            mean = np.array([float(found.static[self.mesh]) ** 2]) if j == self.mesh else None
            panels.append(
                PowerPanel(names[j], f"series:{j}", notes, ends, found.frequencies[j, shown, 0], power[j, shown], mean)
            )
        return panels

    @cached_property
    def points(self) -> DrawnLines | None:
        """Strong lines over speed; None where there are none."""
        lines = self.lines_over_speed
        if lines is None:
            return None
        size = lines.amplitude
        strong = size > max(WEAKEST_OVER_SPEED * float(size.max()), _NO_FORCE)
        notes = tuple(f"{force:.4g} N" for force in size[strong])
        found = DrawnLines("", "", notes, lines.frequency[strong], size[strong], lines.speed[strong])
        return found if strong.any() else None


def _highest_shown(found: MeshForceSpectrum, amplitudes: Array) -> tuple[float, float]:
    """Frequency up to which lines are drawn [Hz], and the share of the mean square that those above it hold."""
    frequencies, power = found.frequencies[:, :, 0], amplitudes**2
    total, pitch = float(power.sum()), float(np.max(frequencies[:, 0] / found.orders[0]))
    order = np.argsort(frequencies, axis=None)
    held = np.cumsum(power.ravel()[order])
    enough = float(frequencies.ravel()[order][min(int(np.searchsorted(held, (1.0 - _LEFT) * total)), held.size - 1)])
    top = min(max(enough, _LEAST_HARMONICS * pitch), MOST_HARMONICS * pitch)
    return top, float(power[frequencies > top].sum()) / total if total > 0.0 else 0.0
