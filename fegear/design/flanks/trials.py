"""Trying modifications of loaded flanks: transmission error, K_Hbeta and pressure over loads and misalignments."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.shown import shows
from fegear.contact.wide.along_lines import swept_mean
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.load_sharing import (
    growth_by_gaps,
    hat_averages,
    solve_contact,
)
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.design.flanks.forms import FormsAt, GroundRelief, TipPower, powers_of
from fegear.design.flanks.scatter import NOMINAL, Scatter
from fegear.design.load_range import proportions
from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class Tried(ReadOnlyArrays):
    """What a modification leaves at S misalignments, P roll positions and L loads.

    Parameters
    ----------
    found : tuple of LoadedFlanks
        One for each misalignment.
    slope : ndarray, shape (S, 9, P, L)
        Growth of `te` by each number of a ground relief; empty, (S, 0, P, L), where it was not asked for.
    force_slope : ndarray, shape (S, 9, P, M, L)
        And of the forces at the stations [N].
    """

    found: tuple[LoadedFlanks, ...]
    slope: Array
    force_slope: Array

    @cached_property
    def te(self) -> Array:
        """Transmission error, shape (S, P, L) [m]."""
        return np.stack([one.transmission_error for one in self.found])

    @property
    @shows("um", "left", name="te_peak_to_peak", label="peak-to-peak value")
    def peak_to_peak(self) -> Array:
        """Shape (S, L) [m]."""
        return np.asarray(np.ptp(self.te, axis=1))

    @cached_property
    def over_face(self) -> Array:
        """Load over each cell of the face, over the mean, shape (S, cells, L)."""
        found = self._swept(np.concatenate([one.line_load for one in self.found], axis=2))
        return np.moveaxis(found.reshape(found.shape[0], len(self.found), -1), 1, 0)

    @cached_property
    def over_face_slope(self) -> Array:
        """Growth of `over_face` by each number of a ground relief, shape (S, 9, cells, L)."""
        scatters, numbers, p, m, loads = self.force_slope.shape
        support = self.found[0].lines.support[:, :, None]
        force = np.moveaxis(self.force_slope, (2, 3), (0, 1)).reshape(p, m, -1)
        found = self._swept(np.divide(force, support, out=np.zeros_like(force), where=support > 0.0))
        return np.moveaxis(found.reshape(-1, scatters, numbers, loads), 0, 2)

    def _swept(self, line_load: Array) -> Array:
        """Line loads of shape (P, M, N L) swept over the cells of the face, over their means, shape (cells, N L)."""
        first = self.found[0]
        swept = swept_mean(first.lines, line_load, first.cells, first.pair.base_pitch) / np.diff(first.cells)[:, None]
        mean = first.load / (first.lines.high - first.lines.low)
        return np.asarray(swept / np.tile(mean, line_load.shape[2] // mean.size))

    @property
    @shows("", "maximum / mean load per face width", name="K_Hbeta", label="K_{Hβ}")
    def face_load_factor(self) -> Array:
        """K_Hbeta, shape (S, L); all misalignments are swept over the face in one go."""
        return np.asarray(self.over_face.max(axis=1))

    @cached_property
    @shows("MPa", "maximum, excluding tip and form circles", name="hertz_pressure")
    def pressure(self) -> Array:
        """Largest Hertzian pressure, see `LoadedFlanks.smooth`, shape (S, L) [Pa]."""
        inner = self.found[0].smooth
        return np.stack([np.where(inner[:, :, None], one.pressure, 0.0).max(axis=(0, 1)) for one in self.found])


@dataclass(frozen=True)
class FlankTrials:
    """A pair's flanks set up for trying modifications under several loads and misalignments.

    Parameters
    ----------
    pair : GearPair
    known : FlankCompliance
    apart : ndarray, shape (P, M) or (P, M, L)
        Gap that is there besides, a nominal misalignment say, or what shafts open under each load [m].
    loads : ndarray, shape (L,)
        [N].
    scatter : Scatter
    weights : tuple of float, optional
        What each load counts; all the same by default.
    tip_power : float or tuple of float
        1 for straight tip reliefs, 2 for parabolas; one for each gear where they differ.
    """

    pair: GearPair
    known: FlankCompliance
    apart: Array
    loads: Array
    scatter: Scatter = NOMINAL
    weights: tuple[float, ...] | None = None
    tip_power: TipPower = 1.0

    @cached_property
    def forms(self) -> FormsAt:
        """The stations, as modifications count them."""
        return FormsAt.on(self.pair, self.known.lines, self.tip_power)

    def relief(self, numbers: Array) -> GroundRelief:
        """A ground relief by its nine numbers; where shapes differ a gear without relief has the straight one."""
        return GroundRelief.of(numbers, max(powers_of(self.tip_power)))

    def apart_under(self, load: int) -> Array:
        """The gap under a load, by its number, shape (P, M) [m]."""
        return self.apart[:, :, load] if self.apart.ndim > 2 else self.apart

    @property
    def cells(self) -> int:
        """Parts of the face whose loads K_Hbeta compares."""
        nothing = solve_contact(self.known, self.apart_under(0), self.loads[:1])
        return LoadedFlanks(self.pair, self.known, nothing, self.loads[:1], {}).cells.size - 1

    @cached_property
    def deviations(self) -> Array:
        """Gaps by misalignment, shape (S, P, M) [m]."""
        return self.scatter.gaps(self.known.lines)

    def gap(self, numbers: Array) -> Array:
        """Gap by the nine numbers of a ground relief, shape (P, M) [m]."""
        return np.asarray(np.where(self.known.lines.present, self.forms.removed(numbers), 0.0))

    def of_gap(self, gap: Array) -> Tried:
        """Try any gap of shape (P, M) [m]."""
        return self._tried(gap, np.empty((0, *gap.shape)))

    def of_numbers(
        self, numbers: Array, *, slope: bool = False, near: Tried | None = None, step: Array | None = None
    ) -> Tried:
        """Try nine numbers of a ground relief, with derivatives where asked for.

        Begun from what some like these, tried before, have found: the same in a third of the time. With the `step`
        from those to these, shape (9,), and derivatives there, forces are led ahead by it.
        """
        lines = self.known.lines
        wanted = self.forms.slopes(numbers) if slope else np.empty((0, *lines.x.shape))
        forms = [hat_averages(lines, np.where(lines.present, form, 0.0)) for form in wanted]
        return self._tried(self.gap(numbers), np.array(forms).reshape(-1, *lines.x.shape), near, step)

    def _tried(self, gap: Array, forms: Array, near: Tried | None = None, step: Array | None = None) -> Tried:
        found, slopes, forces = [], [], []
        for number, deviation in enumerate(self.deviations):
            whole = [self.apart_under(i) + deviation + gap for i in range(self.loads.size)]
            alike = self.apart.ndim == 2
            begun = None if near is None else near.found[number].contact.force
            if begun is not None and near is not None and step is not None:
                begun = np.maximum(begun + np.tensordot(step, near.force_slope[number], axes=1), 0.0)
            contact = solve_contact(self.known, whole[0] if alike else np.stack(whole, axis=2), self.loads, near=begun)
            found.append(LoadedFlanks(self.pair, self.known, contact, self.loads, {}))
            slope = np.empty((len(forms), *contact.approach.shape))
            moved = np.empty((len(forms), *contact.force.shape))
            for i in range(self.loads.size if len(forms) else 0):
                slope[..., i], moved[..., i] = growth_by_gaps(self.known, contact.force[:, :, i], forms)
            slopes.append(slope)
            forces.append(moved)
        return Tried(tuple(found), np.stack(slopes), np.stack(forces))

    @property
    def proportion(self) -> Array:
        """Largest load over each, times its weight over the largest, shape (L,): excitations count in proportion."""
        weights = None if self.weights is None else np.array(self.weights)
        return np.asarray(proportions(self.loads, weights), dtype=float)

    def value(self, peak_to_peak: Array) -> float:
        """What is to be least, of values of shape (S, L): means over the misalignments, of the worst load [m]."""
        return float((self.scatter.weights @ peak_to_peak * self.proportion).max())


@dataclass(frozen=True)
class Tries:
    """Nine numbers tried one after the other, each begun from what the nearest of those before has found.

    Parameters
    ----------
    trials : FlankTrials
    scale : ndarray, shape (9,)
        By which differences of numbers count beside each other; zero for those that do not.
    before : mapping of bytes to (ndarray, Tried), optional
        What has been tried, none to begin with.
    """

    trials: FlankTrials
    scale: Array
    before: dict[bytes, tuple[Array, Tried]] = field(default_factory=dict)

    def of(self, numbers: Array) -> Tried:
        """What these leave; the same numbers are tried once."""
        key = numbers.tobytes()
        if key not in self.before:
            near = min(self.before.values(), key=lambda one: self._apart(one[0], numbers), default=None)
            self.before[key] = numbers, self.trials.of_numbers(numbers, near=None if near is None else near[1])
        return self.before[key][1]

    def _apart(self, one: Array, other: Array) -> float:
        return float(np.abs((one - other)[self.scale > 0.0] / self.scale[self.scale > 0.0]).sum())
