"""Trying modifications of loaded flanks: transmission error, K_Hbeta and pressure over loads and misalignments."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.flank.complementarity import approach_by_gap, hat_averages, solve_contact
from fegear.contact.flank.loaded import LoadedFlanks
from fegear.contact.flank.swept import swept_mean
from fegear.design.flank_forms import FormsAt
from fegear.design.flank_scatter import NOMINAL, Scatter
from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.flank.compliance import FlankCompliance
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
    """

    found: tuple[LoadedFlanks, ...]
    slope: Array

    @cached_property
    def te(self) -> Array:
        """Transmission error, shape (S, P, L) [m]."""
        return np.stack([one.transmission_error for one in self.found])

    @property
    def peak_to_peak(self) -> Array:
        """Shape (S, L) [m]."""
        return np.asarray(np.ptp(self.te, axis=1))

    @cached_property
    def face_load_factor(self) -> Array:
        """K_Hbeta, shape (S, L); all misalignments are swept over the face in one go."""
        first = self.found[0]
        loads = np.concatenate([one.line_load for one in self.found], axis=2)
        over_face = swept_mean(first.lines, loads, first.cells, first.pair.base_pitch) / np.diff(first.cells)[:, None]
        largest = over_face.max(axis=0).reshape(len(self.found), -1)
        return np.asarray(largest / (first.load / (first.lines.high - first.lines.low)))

    @cached_property
    def pressure(self) -> Array:
        """Largest Hertzian pressure away from tips and form circles, shape (S, L) [Pa]."""
        inner = self.found[0].lines.present & ~self.found[0].lines.at_edge
        return np.stack([np.where(inner[:, :, None], one.pressure, 0.0).max(axis=(0, 1)) for one in self.found])


@dataclass(frozen=True)
class FlankTrials:
    """A pair's flanks set up for trying modifications under several loads and misalignments.

    Parameters
    ----------
    pair : GearPair
    known : FlankCompliance
    apart : ndarray, shape (P, M)
        Gap that is there besides, a nominal misalignment say [m].
    loads : ndarray, shape (L,)
        [N].
    scatter : Scatter
    """

    pair: GearPair
    known: FlankCompliance
    apart: Array
    loads: Array
    scatter: Scatter = NOMINAL

    @cached_property
    def forms(self) -> FormsAt:
        """The stations, as modifications count them."""
        return FormsAt.over(self.pair, self.known.lines.x, self.known.lines.z)

    @property
    def cells(self) -> int:
        """Parts of the face whose loads K_Hbeta compares."""
        nothing = solve_contact(self.known, self.apart, self.loads[:1])
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

    def of_numbers(self, numbers: Array, *, slope: bool = False) -> Tried:
        """Try nine numbers of a ground relief, with derivatives where asked for."""
        lines = self.known.lines
        wanted = self.forms.slopes(numbers) if slope else np.empty((0, *lines.x.shape))
        forms = [hat_averages(lines, np.where(lines.present, form, 0.0)) for form in wanted]
        return self._tried(self.gap(numbers), np.array(forms).reshape(-1, *lines.x.shape))

    def _tried(self, gap: Array, forms: Array) -> Tried:
        found, slopes = [], []
        for deviation in self.deviations:
            contact = solve_contact(self.known, self.apart + deviation + gap, self.loads)
            found.append(LoadedFlanks(self.pair, self.known, contact, self.loads, {}))
            slope = np.empty((len(forms), *contact.approach.shape))
            for i in range(self.loads.size if len(forms) else 0):
                slope[:, :, i] = np.einsum("pm,kpm->kp", approach_by_gap(self.known, contact.force[:, :, i]), forms)
            slopes.append(slope)
        return Tried(tuple(found), np.stack(slopes))

    @property
    def proportion(self) -> Array:
        """Largest load over each, shape (L,): excitations count in proportion to their load."""
        return np.asarray(self.loads.max() / self.loads)

    def value(self, peak_to_peak: Array) -> float:
        """What is to be least, of values of shape (S, L): means over the misalignments, of the worst load [m]."""
        return float((self.scatter.weights @ peak_to_peak * self.proportion).max())

    def tangent(self, tried: Tried, step: Array) -> tuple[float, Array]:
        """The same a step of the nine numbers ahead, transmission errors taken as straight, and its gradient (9,)."""
        te = tried.te + np.einsum("skpl,k->spl", tried.slope, step)
        high, low = te.argmax(axis=1), te.argmin(axis=1)
        values = self.scatter.weights @ np.ptp(te, axis=1) * self.proportion
        worst = int(values.argmax())
        gradient = np.zeros(tried.slope.shape[1])
        for s, weight in enumerate(self.scatter.weights):
            slope = tried.slope[s, :, :, worst]
            gradient += weight * (slope[:, high[s, worst]] - slope[:, low[s, worst]])
        return float(values[worst]), gradient * self.proportion[worst]
