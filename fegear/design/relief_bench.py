"""Transmission error of many reliefs, loads and errors at once, on one grid evaluated once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.fourier import Panels, effective_error, fourier_series, panels
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.roll_grids import RollGrid
from fegear.geometry.relief import Relief

_BATCH = 40_000


@dataclass(frozen=True)
class Bench:
    """A gear pair set up for trying modifications: contacts and compliances stay, only the separations change.

    Parameters
    ----------
    engagement : Engagement
    points : Panels
        Quadrature points with breaks where pairs enter and leave; kinks of the reliefs tried are not break points, so
        harmonics are good to about 1e-3 of the peak-to-peak value, which `transmission_error` improves on.
    grid : RollGrid
    """

    engagement: Engagement
    points: Panels
    grid: RollGrid

    def removal(self, driver: Relief, driven: Relief) -> Array:
        """Modification of every pair, shape (n, P) [m]."""
        c = self.grid.contacts
        return np.asarray(driver.removal(c.roll_driver) + driven.removal(c.roll_driven))

    def errors(self, modifications: Array, load: ArrayLike) -> Metrics:
        """Transmission error metrics of C cases.

        Parameters
        ----------
        modifications : ndarray, shape (n, P, C)
            m_j, spacing errors included [m].
        load : array_like, shape () or (C,)
            [N].
        """
        contacts = self.grid.contacts
        base = np.where(contacts.present, contacts.gap, np.inf)[:, :, None]
        cases = modifications.shape[2]
        loads = np.broadcast_to(np.asarray(load, dtype=float), (cases,))
        step = max(1, _BATCH // self.points.x.size)
        te = np.empty((self.points.x.size, cases))
        for first in range(0, cases, step):
            part = slice(first, min(first + step, cases))
            e = base + np.where(contacts.present[:, :, None], modifications[:, :, part], 0.0)
            te[:, part] = self.grid.matrices.share(e, loads[part]).transmission_error
        series = fourier_series(self.points, te, 12)
        return Metrics(effective_error(series), np.ptp(te, axis=0), np.asarray(series.mean), te)


@dataclass(frozen=True, slots=True)
class Metrics:
    """What excites, of C cases.

    Parameters
    ----------
    effective_error : ndarray, shape (C,)
        A_e [m].
    peak_to_peak : ndarray, shape (C,)
        Over the points [m].
    mean : ndarray, shape (C,)
        [m].
    transmission_error : ndarray, shape (P, C)
        [m].
    """

    effective_error: Array
    peak_to_peak: Array
    mean: Array
    transmission_error: Array

    def of(self, name: str) -> Array:
        """`effective_error` or `peak_to_peak`."""
        return self.effective_error if name == "effective_error" else self.peak_to_peak


def bench(engagement: Engagement, order: int = 12, waves: int = 12, breaks: Sequence[float] = ()) -> Bench:
    """Set up a pair for trying modifications.

    Parameters
    ----------
    engagement : Engagement
        Its own modifications are not used.
    order, waves : int
        See `panels`.
    breaks : sequence of float
        Further break points [m].
    """
    pair = engagement.pair
    places = engagement.meshing.reduced([pair.x_start, pair.x_end, *breaks])
    points = panels(pair.x_start, pair.base_pitch, places, waves=waves, order=order)
    return Bench(engagement, points, engagement.grid(points.x))
