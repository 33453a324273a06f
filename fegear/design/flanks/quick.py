"""Loaded flanks with few stations and straight compliances, for trying many thousand modifications.

The compliances between all stations are pressed together: the coarse hats of longer panels are sums of the fine ones,
so C_coarse = R^T C R with the forces R of unit coarse hats (Galerkin's way), and gaps are averaged alike. Widths of the
contacts are those of the design load: the compliances are the tangents there. Contact itself is solved exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.errors import ConvergenceError
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.lines import ContactLines
from fegear.contact.wide.load_sharing import (
    deflection,
    hat_averages,
    tangent_compliance,
)

#: All roll positions.
_ALL = slice(None)

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
        averaged = hat_averages(self.lines, gap.reshape(-1, *gap.shape[-2:]))
        found = np.moveaxis(np.moveaxis(averaged, 0, 1) @ self.spread, 0, 1)
        return np.ascontiguousarray(found).reshape(*gap.shape[:-1], -1)

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
            approach[part], force, _ = self.contact(gap[part], load)
            over = np.einsum("cpm,pfm->cf", force, self.over_face)
            factor[part] = over.max(axis=1) * over.shape[1] / load
        return approach, factor

    def contact(
        self, gap: Array, load: float, at: slice = _ALL, near: Array | None = None
    ) -> tuple[Array, Array, Array]:  # fmt: skip
        """Load C candidates at some of the roll positions.

        Parameters
        ----------
        gap : ndarray, shape (C, p, m)
            From `gaps`, at these positions [m].
        load : float
            [N].
        at : slice
            Roll positions, all by default.
        near : ndarray, shape (C, p, m), optional
            Forces with about the same gaps, from which most contacts are found in one step [N].

        Returns
        -------
        approach : ndarray, shape (C, p)
            [m].
        force : ndarray, shape (C, p, m)
            [N].
        growth : ndarray, shape (C, p, m)
            Of the approach by the gap at each station.
        """
        gap, size = gap + self.constant[at], gap.shape[2]
        present, compliance = self.present[at], self.matrix[at]
        inverse, unit = (one[at] for one in self._all_on)
        held = np.einsum("pij,cpj->cpi", inverse, np.where(present, gap, 0.0))
        z = (load + held.sum(axis=2)) / unit.sum(axis=1)
        force = z[:, :, None] * unit - held
        growth = np.broadcast_to(unit / unit.sum(axis=1, keepdims=True), force.shape).copy()
        left = np.argwhere((force < 0.0).any(axis=2))
        c, p = left.T
        force = np.maximum(force, 0.0)
        active = (force if near is None else near)[c, p] > 0.0
        place = np.arange(c.size)
        for steps in range(_MOST_STEPS):
            if not place.size:
                return z, force, growth
            on = active[place]
            matrix, e = compliance[p[place]], np.where(present[p[place]], gap[c[place], p[place]], 0.0)
            system = np.where(on[:, :, None] & on[:, None, :], matrix, 0.0)
            system[:, range(size), range(size)] += ~on
            y = np.linalg.solve(system, np.stack([on.astype(float), on * e], axis=2))
            rate = y[:, :, 0].sum(axis=1)
            zeta = (load + y[:, :, 1].sum(axis=1)) / rate
            new = zeta[:, None] * y[:, :, 0] - y[:, :, 1]
            distance = np.einsum("bij,bj->bi", matrix, new) + e - zeta[:, None]
            leaves = on & (new <= 0.0)
            enters = present[p[place]] & ~on & (distance < -1e-12 * np.abs(zeta)[:, None])
            changes = leaves | enters
            done = ~changes.any(axis=1)
            solved = place[done]
            z[c[solved], p[solved]], force[c[solved], p[solved]] = zeta[done], new[done]
            growth[c[solved], p[solved]] = (y[:, :, 0] / rate[:, None])[done]
            if steps > _MANY_AT_ONCE:
                only = np.zeros_like(changes)
                only[np.arange(place.size), changes.argmax(axis=1)] = True
                changes &= only
            active[place] = on ^ changes
            place = place[~done]
        raise ConvergenceError(f"No load distribution found with the coarse contact model for {place.size} problems.")


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
