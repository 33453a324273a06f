"""One tooth pair with a width followed from first to last contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.flank.complementarity import hat_averages
from fegear.contact.pair_history import PairHistory

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.flank.loaded import LoadedFlanks


def flank_pair_history(found: LoadedFlanks, gap: Array) -> PairHistory:
    """Follow one tooth pair through all roll positions in which its contact line exists.

    Parameters
    ----------
    found : LoadedFlanks
    gap : ndarray, shape (P, M)
        Distance of the unloaded flanks at the stations [m].

    Returns
    -------
    PairHistory
        Its x is where the contact line crosses the middle of the face; before x_start and after x_end only a part of
        the face is in contact. The deflection is weighted with the load along the line, the pressure is the largest on
        it, tips and form circles left out.
    """
    lines, pitch = found.lines, found.pair.base_pitch
    force, te = found.contact.force, found.transmission_error
    apart = hat_averages(lines, gap)
    pressure = np.where(lines.at_edge[:, :, None], 0.0, found.pressure)
    where = [(p, s) for p in range(lines.roll.size) for s in lines.at(p)]
    x = np.array([lines.roll[p] + lines.pair[p, s.start] * pitch for p, s in where])
    order = np.argsort(x)
    load = np.array([force[p, s].sum(axis=0) for p, s in where])[order]
    moved = np.array([te[p] * force[p, s].sum(axis=0) - apart[p, s] @ force[p, s] for p, s in where])[order]
    deflection = np.divide(moved, load, out=np.zeros_like(load), where=load > 0.0)
    return PairHistory(
        x[order], np.asarray(found.pair.roll_angle(x[order], "driver")), load, load / found.load, deflection,
        np.array([pressure[p, s].max(axis=0) for p, s in where])[order],
        np.array([te[p] for p, _ in where])[order],
    )  # fmt: skip


def history_error(history: PairHistory, coarse: PairHistory) -> Array:
    """Change of a pair's loads by the coarser solution, shape (positions, L) [N]."""
    again = np.stack([np.interp(history.x, coarse.x, loads) for loads in coarse.load.T], axis=1)
    return np.abs(again - history.load)
