"""A loaded pair over one base pitch: the roll positions of its curves, and the secant stiffness along them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import distinct
from fegear.contact.plane.transmission_error import TransmissionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded


#: Distance from a jump at which both sides of it are looked at [base pitches].
BESIDE = 1e-7


def secant_stiffness(loaded: Loaded) -> Array:
    """K_T = sum of K_Sj over the pairs in contact, with the secant compliances of their loads, shape (P, L) [N/m].

    It is W / transmission error of the same pairs without modifications and errors (Mark, A.11).
    """
    secant = loaded.grid.matrices.at_load(loaded.loads)
    active = loaded.loads > 0.0
    n = active.shape[0]
    c = np.where(active[:, None] & active[None, :], secant, np.eye(n)[:, :, None, None])
    right = np.moveaxis(active.astype(float), 0, -1)[..., None]
    return np.asarray(np.linalg.solve(np.moveaxis(c, (0, 1), (-2, -1)), right)[..., 0].sum(axis=-1))


def mean_secant_stiffness(te: TransmissionError) -> float:
    """Mean of `secant_stiffness` over the base pitch, under the load of a transmission error [N/m]."""
    return float(secant_stiffness(te.loaded)[:, 0] @ te.points.weights / te.points.period)


def roll_positions(engagement: Engagement, count: int, changes: Sequence[float] = ()) -> Array:
    """Evenly over one base pitch from the start of contact, and on either side of every jump [m].

    Parameters
    ----------
    engagement : Engagement
    count : int
        Even steps over the base pitch.
    changes : sequence of float
        Further jumps: where pairs come into or out of contact under a load [m]. The secant stiffness jumps there.
    """
    start, pitch = engagement.pair.x_start, engagement.pair.base_pitch
    jumps = (*engagement.breaks, *changes)
    beside = np.array([b + side * BESIDE * pitch for b in jumps for side in (-1.0, 1.0)])
    x = np.concatenate([np.linspace(start, start + pitch, count + 1), beside])
    inside = (x > start + 0.5 * BESIDE * pitch) & (x < start + (1.0 - 0.5 * BESIDE) * pitch)
    ends = np.array([start + BESIDE * pitch, start + (1.0 - BESIDE) * pitch])
    return distinct(ends, x[inside], within=0.1 * BESIDE)
