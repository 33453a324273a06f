"""Contact pattern as marking compound prints it: where loaded flanks come nearer than the thickness of its coat.

A place on a flank is nearest to its mate when the contact line passes over it. Beside the flanks that touch there, the
deformed flanks stand apart by

    s = u + e - zeta >= 0

along the line of action, u the deflection under all the load, e the gap of the unloaded flanks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.flank.complementarity import deflection, hat_averages
from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.flank.loaded import LoadedFlanks

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
    gap : ndarray, shape (P, M)
        Of the unloaded flanks [m].
    """
    apart = hat_averages(found.lines, gap)
    force, te = found.contact.force, found.transmission_error
    each = [deflection(found.known, force[:, :, i]) + apart - te[:, None, i] for i in range(found.load.size)]
    return np.maximum(np.stack(each, axis=2), 0.0) * (force <= 0.0)


def contact_pattern(found: LoadedFlanks, gap: Array) -> ContactPattern:
    """Follow the contact lines over the flank under every load; `gap` as for `separation`."""
    x = np.linspace(found.pair.x_start, found.pair.x_end, _ACROSS)
    z = np.linspace(found.lines.low, found.lines.high, _ALONG)
    apart = separation(found, gap)
    return ContactPattern(x, z, np.stack([found.spread(x, z, apart[:, :, i]) for i in range(found.load.size)]))
