"""Trying modifications of loaded flanks: transmission error, K_Hbeta and pressure over loads and misalignments.

Loaded flanks with few stations and straight compliances, for trying many thousand modifications.

The compliances between all stations are pressed together: the coarse hats of longer panels are sums of the fine ones,
so C_coarse = R^T C R with the forces R of unit coarse hats (Galerkin's way), and gaps are averaged alike. Widths of the
contacts are those of the design load: the compliances are the tangents there. Contact itself is solved exactly.

Misalignment that scatters: levels of the gap over the face with weights, and the gap that each of them opens.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.errors import ConvergenceError
from fegear.base.shown import shows
from fegear.contact.wide.complementarity import (
    deflection,
    growth_by_gaps,
    hat_averages,
    solve_contact,
    tangent_compliance,
)
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.lines import ContactLines
from fegear.contact.wide.load_factors import swept_mean
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.design.flanks.forms import FormsAt
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
    @shows("um", "left", name="te_peak_to_peak", label="peak to peak")
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
    @shows("", "largest over mean load per face width", name="K_Hbeta", label="K_{Hβ}")
    def face_load_factor(self) -> Array:
        """K_Hbeta, shape (S, L); all misalignments are swept over the face in one go."""
        return np.asarray(self.over_face.max(axis=1))

    @cached_property
    @shows("MPa", "largest, without tips and form circles", name="hertz_pressure")
    def pressure(self) -> Array:
        """Largest Hertzian pressure, see `LoadedFlanks.smooth`, shape (S, L) [Pa]."""
        inner = self.found[0].smooth
        return np.stack([np.where(inner[:, :, None], one.pressure, 0.0).max(axis=(0, 1)) for one in self.found])


@dataclass(frozen=True)
class Scatter(ReadOnlyArrays):
    """Deviations of the gap over the face from the nominal one, and how often they occur.

    Parameters
    ----------
    over_face : ndarray, shape (S,)
        Gap at the end of the face at +b/2 less that at -b/2 [m].
    weights : ndarray, shape (S,)
        Sum one.
    """

    over_face: Array
    weights: Array

    def gaps(self, lines: ContactLines) -> Array:
        """Gap of each level at the stations, nothing in the middle of the face, shape (S, P, M) [m]."""
        share = (lines.z - 0.5 * (lines.low + lines.high)) / (lines.high - lines.low)
        return np.asarray(np.multiply.outer(self.over_face, np.where(lines.present, share, 0.0)))


#: No deviation.
NOMINAL = Scatter(np.zeros(1), np.ones(1))


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

    def of_numbers(self, numbers: Array, *, slope: bool = False) -> Tried:
        """Try nine numbers of a ground relief, with derivatives where asked for."""
        lines = self.known.lines
        wanted = self.forms.slopes(numbers) if slope else np.empty((0, *lines.x.shape))
        forms = [hat_averages(lines, np.where(lines.present, form, 0.0)) for form in wanted]
        return self._tried(self.gap(numbers), np.array(forms).reshape(-1, *lines.x.shape))

    def _tried(self, gap: Array, forms: Array) -> Tried:
        found, slopes, forces = [], [], []
        for deviation in self.deviations:
            whole = [self.apart_under(i) + deviation + gap for i in range(self.loads.size)]
            alike = self.apart.ndim == 2
            contact = solve_contact(self.known, whole[0] if alike else np.stack(whole, axis=2), self.loads)
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
        """Largest load over each, shape (L,): excitations count in proportion to their load."""
        return np.asarray(self.loads.max() / self.loads)

    def value(self, peak_to_peak: Array) -> float:
        """What is to be least, of values of shape (S, L): means over the misalignments, of the worst load [m]."""
        return float((self.scatter.weights @ peak_to_peak * self.proportion).max())


#: Problems solved at a time, times the square of their size; steps after which one station changes at a time, in all.
_BATCH, _MANY_AT_ONCE, _MOST_STEPS = 4_000_000, 12, 400


#: Points of a fine panel when forces are shared out over the face.
_POINTS = 8


@dataclass(frozen=True)
class QuickFlanks(ReadOnlyArrays):
    """Few stations at P roll positions.

    Parameters
    ----------
    lines : ContactLines
        The fine stations.
    spread : ndarray, shape (P, M, m)
        R: forces on the fine stations by unit forces on the coarse ones.
    present : ndarray of bool, shape (P, m)
    matrix : ndarray, shape (P, m, m)
        Tangent compliances [m/N].
    constant : ndarray, shape (P, m)
        What the tangents leave at zero force [m].
    over_face : ndarray, shape (P, cells, m)
        Part of a station's unit force in equal parts of the face, times the part of a base pitch of its position.
    """

    lines: ContactLines
    spread: Array
    present: Mask
    matrix: Array
    constant: Array
    over_face: Array

    def gaps(self, gap: Array) -> Array:
        """Gaps at the fine stations, shape (..., P, M), averaged over the coarse hats, shape (..., P, m) [m]."""
        flat = gap.reshape(-1, *gap.shape[-2:])
        found = np.stack([np.einsum("pM,pMm->pm", hat_averages(self.lines, g), self.spread) for g in flat])
        return np.asarray(found.reshape(*gap.shape[:-1], -1))

    @cached_property
    def _all_on(self) -> tuple[Array, Array]:
        """Inverse of the compliances of all stations, and forces by unit approach."""
        inverse = np.linalg.inv(self.matrix) * (self.present[:, :, None] & self.present[:, None, :])
        return np.asarray(inverse), np.asarray(inverse.sum(axis=2))

    def solve(self, gap: Array, load: float) -> tuple[Array, Array]:
        """Load C candidates.

        Parameters
        ----------
        gap : ndarray, shape (C, P, m)
            From `gaps` [m].
        load : float
            [N].

        Returns
        -------
        approach : ndarray, shape (C, P)
            [m].
        factor : ndarray, shape (C,)
            K_Hbeta.
        """
        count, positions, size = gap.shape
        approach, factor = np.empty((count, positions)), np.empty(count)
        step = max(1, _BATCH // (positions * size**2))
        for first in range(0, count, step):
            part = slice(first, first + step)
            approach[part], force = self._contact(gap[part] + self.constant, load)
            over = np.einsum("cpm,pfm->cf", force, self.over_face)
            factor[part] = over.max(axis=1) * over.shape[1] / load
        return approach, factor

    def _contact(self, gap: Array, load: float) -> tuple[Array, Array]:
        size = gap.shape[2]
        inverse, unit = self._all_on
        held = np.einsum("pij,cpj->cpi", inverse, np.where(self.present, gap, 0.0))
        z = (load + held.sum(axis=2)) / unit.sum(axis=1)
        force = z[:, :, None] * unit - held
        left = np.argwhere((force < 0.0).any(axis=2))
        c, p = left.T
        force = np.maximum(force, 0.0)
        active = force[c, p] > 0.0
        place = np.arange(c.size)
        for steps in range(_MOST_STEPS):
            if not place.size:
                return z, force
            on = active[place]
            matrix, e = self.matrix[p[place]], np.where(self.present[p[place]], gap[c[place], p[place]], 0.0)
            system = np.where(on[:, :, None] & on[:, None, :], matrix, 0.0)
            system[:, range(size), range(size)] += ~on
            y = np.linalg.solve(system, np.stack([on.astype(float), on * e], axis=2))
            zeta = (load + y[:, :, 1].sum(axis=1)) / y[:, :, 0].sum(axis=1)
            new = zeta[:, None] * y[:, :, 0] - y[:, :, 1]
            distance = np.einsum("bij,bj->bi", matrix, new) + e - zeta[:, None]
            leaves = on & (new <= 0.0)
            enters = self.present[p[place]] & ~on & (distance < -1e-12 * np.abs(zeta)[:, None])
            changes = leaves | enters
            done = ~changes.any(axis=1)
            at = place[done]
            z[c[at], p[at]], force[c[at], p[at]] = zeta[done], new[done]
            if steps > _MANY_AT_ONCE:
                only = np.zeros_like(changes)
                only[np.arange(place.size), changes.argmax(axis=1)] = True
                changes &= only
            active[place] = on ^ changes
            place = place[~done]
        raise ConvergenceError(
            f"Contact over the flank with few stations found no loaded set for {place.size} problems."
        )


def quick_flanks(known: FlankCompliance, force: Array, panels: int, cells: int) -> QuickFlanks:
    """Press the stations of all lines together.

    Parameters
    ----------
    known : FlankCompliance
    force : ndarray, shape (P, M)
        Forces about which compliances are straight [N].
    panels : int
        Over the whole face; shorter lines have as many fewer.
    cells : int
        Equal parts of the face whose loads are distinguished.
    """
    lines = known.lines
    matrix = tangent_compliance(known, np.arange(force.shape[0]), force)
    constant = deflection(known, force) - np.einsum("pij,pj->pi", matrix, force)
    longest = (lines.high - lines.low) / panels
    spread = []
    for p in range(lines.roll.size):
        columns = []
        for s in lines.at(p):
            z = lines.z[p, s]
            count = min(max(1, round((z[-1] - z[0]) / longest)), z.size - 1)
            nodes = np.linspace(z[0], z[-1], count + 1)
            for unit in np.eye(count + 1):
                column = np.zeros(lines.z.shape[1])
                column[s] = np.interp(z, nodes, unit) * lines.support[p, s]
                columns.append(column / column.sum())
        spread.append(np.stack(columns, axis=1))
    most = max(r.shape[1] for r in spread)
    present = np.stack([np.arange(most) < r.shape[1] for r in spread])
    whole = np.stack([np.pad(r, ((0, 0), (0, most - r.shape[1]))) for r in spread])
    pressed = np.einsum("pMi,pMN,pNj->pij", whole, matrix, whole)
    at = np.arange(most)
    # Stations that are not there bear nothing; their own compliance only keeps the matrix from being singular.
    pressed[:, at, at] += np.where(present, 0.0, float(np.abs(pressed).max()))
    weight = lines.mean(np.eye(lines.roll.size))
    over = np.einsum("p,pfM,pMm->pfm", weight, _face_cells(lines, cells), whole)
    return QuickFlanks(lines, whole, present, pressed, np.einsum("pM,pMm->pm", constant, whole), over)


def _face_cells(lines: ContactLines, count: int) -> Array:
    """Part of the unit force of every fine hat in equal cells of the face, shape (P, cells, M)."""
    positions, most = lines.z.shape
    found = np.zeros((positions, count, most))
    width = (lines.high - lines.low) / count
    h, support = lines.panel, lines.support
    for t in (np.arange(_POINTS) + 0.5) / _POINTS:
        z = lines.z[:, :-1] + t * h
        cell = np.clip(((z - lines.low) / width).astype(int), 0, count - 1)
        p, i = np.nonzero(h > 0.0)
        for side, weight in ((0, 1.0 - t), (1, t)):
            np.add.at(found, (p, cell[p, i], i + side), weight * h[p, i] / _POINTS / support[p, i + side])
    return found


def normal_scatter(deviation: float, levels: int) -> Scatter:
    """Levels of a normal distribution by Gauss and Hermite: means of polynomials up to degree 2 levels - 1 are exact.

    Parameters
    ----------
    deviation : float
        Standard deviation of the gap over the face [m]; zero is `NOMINAL`.
    levels : int
    """
    if deviation == 0.0 or levels == 1:
        return NOMINAL
    places, weights = np.polynomial.hermite_e.hermegauss(levels)
    return Scatter(deviation * places, weights / weights.sum())
