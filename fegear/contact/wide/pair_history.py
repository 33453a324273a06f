"""One tooth pair with a width followed over the path of contact.

Contact pattern as marking compound prints it: where loaded flanks come nearer than the thickness of its coat.

A place on a flank is nearest to its mate when the contact line passes over it. Beside the flanks that touch there, the
deformed flanks stand apart by

    s = u + e - zeta >= 0

along the line of action, u the deflection under all the load, e the gap of the unloaded flanks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.plane.pair_history import PairHistory
from fegear.contact.wide.load_sharing import averaged_gaps, deflection
from fegear.contact.wide.loaded import LoadedFlanks


def flank_pair_history(found: LoadedFlanks, gap: Array) -> PairHistory:
    """Follow one tooth pair through all roll positions in which its contact line exists.

    Parameters
    ----------
    found : LoadedFlanks
    gap : ndarray, shape (P, M) or (P, M, L)
        Distance of the unloaded flanks at the stations [m].

    Returns
    -------
    PairHistory
        Its x is where the contact line crosses the middle of the face; before x_start and after x_end only a part of
        the face is in contact. The deflection is weighted with the load along the line, the pressure is the largest on
        it; tips, form circles and lines shorter than a module are neglected.
    """
    lines, pitch = found.lines, found.pair.base_pitch
    force, te = found.contact.force, found.transmission_error
    apart = averaged_gaps(lines, gap, found.load.size)
    pressure = found.smooth_pressure
    where = [(p, s) for p in range(lines.roll.size) for s in lines.at(p)]
    x = np.array([lines.roll[p] + lines.pair[p, s.start] * pitch for p, s in where])
    order = np.argsort(x)
    load = np.array([force[p, s].sum(axis=0) for p, s in where])[order]
    moved = np.array([((te[p] - apart[p, s]) * force[p, s]).sum(axis=0) for p, s in where])[order]
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


#: Places over which the pattern is known along the line of action and along the face.
_ACROSS, _ALONG = 121, 81


@dataclass(frozen=True)
class ContactPattern(ReadOnlyArrays):
    """Separation of loaded flanks as the contact line passes, over the plane of action.

    Parameters
    ----------
    x, z : ndarray, shape (X,), (Z,)
        Along the path of contact and along the face [m].
    separation : ndarray, shape (L, Z, X)
        Under every load, along the line of action [m]; NaN where no roll position brings a line.
    """

    x: Array
    z: Array
    separation: Array

    def printed(self, coat: float) -> Array:
        """Where a coat of a thickness [m] touches, shape (L, Z, X) of bool."""
        return np.asarray(np.nan_to_num(self.separation, nan=np.inf) < coat)

    def printed_share(self, coat: float) -> Array:
        """Share of the flank that it prints, of what contact lines reach, shape (L,)."""
        known = np.isfinite(self.separation).sum(axis=(1, 2))
        return np.asarray(self.printed(coat).sum(axis=(1, 2)) / known)


def separation(found: LoadedFlanks, gap: Array) -> Array:
    """Distance of the loaded flanks at the stations along the line of action, shape (P, M, L) [m].

    Parameters
    ----------
    found : LoadedFlanks
    gap : ndarray, shape (P, M) or (P, M, L)
        Of the unloaded flanks [m].
    """
    apart = averaged_gaps(found.lines, gap, found.load.size)
    force, te = found.contact.force, found.transmission_error
    each = [deflection(found.known, force[:, :, i]) + apart[:, :, i] - te[:, None, i] for i in range(found.load.size)]
    return np.maximum(np.stack(each, axis=2), 0.0) * (force <= 0.0)


def contact_pattern(found: LoadedFlanks, gap: Array) -> ContactPattern:
    """Follow the contact lines over the flank under every load; `gap` as for `separation`."""
    x = np.linspace(found.pair.x_start, found.pair.x_end, _ACROSS)
    z = np.linspace(found.lines.low, found.lines.high, _ALONG)
    apart = separation(found, gap)
    return ContactPattern(x, z, np.stack([found.spread(x, z, apart[:, :, i]) for i in range(found.load.size)]))
