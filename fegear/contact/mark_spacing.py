"""Mark's closed forms for what tooth spacing errors add to the transmission error (1.27 to 1.32).

(1.29) is printed without its sum. It is read as j_0(pi g L/A) less its own values at the harmonics n' of the mesh,
spread by the window w_00: then evenly displaced teeth (g = 0) count in full and errors that are alike in every base
pitch (g = n') add nothing, as exact load sharing has it.

It holds for contact ratios from 1.2 to 1.8: within 0.09 of the errors' own spectrum below the first mesh harmonic, by
load sharing with tooth compliances after Cornell. Above two it is no better than j_0(pi g L/A) alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import FourierSeries

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.contact.engagement import Engagement


#: Contact ratios for which the closed form is compared with load sharing.
SPACING_RANGE = (1.2, 1.8)


def spacing_transfer(order: ArrayLike, contact_ratio: float) -> Array:
    """How much of a spacing error of so many waves per base pitch reaches the transmission error (1.29 to 1.31).

    Parameters
    ----------
    order : array_like
        g = n / N, frequency over the tooth-mesh frequency.
    contact_ratio : float
        L / A (1.32); the form holds from 1.2 to 1.8.
    """
    g = np.abs(np.asarray(order, dtype=float))
    below = np.floor(g)
    found = np.sinc(g * contact_ratio)
    for n in (below, below + 1.0):
        window = 0.5 * (1.0 + np.cos(np.pi * (g - n)))
        found = found - np.where(n > 0.0, window * np.sinc(n * contact_ratio), 0.0)
    return np.asarray(found)


def spacing_series(engagement: Engagement, harmonics: int) -> FourierSeries:
    """What the spacing errors of both gears add to the transmission error [m], over all base pitches (1.27, 1.28).

    Parameters
    ----------
    engagement : Engagement
        With spacing errors.
    harmonics : int
        Highest one over the period of `engagement.cycles` base pitches.
    """
    pair, cycles = engagement.pair, engagement.cycles
    n = np.arange(harmonics + 1)
    total = np.zeros(harmonics + 1, dtype=complex)
    for errors in (engagement.driver_spacing, engagement.driven_spacing):
        if errors.size:
            every = cycles // errors.size
            spectrum = np.fft.fft(errors) / errors.size
            total += np.where(n % every == 0, spectrum[(n // every) % errors.size], 0.0)
    order = n / cycles
    middle = 0.5 * (pair.x_start + pair.x_end) / pair.base_pitch
    transfer = spacing_transfer(order, pair.contact_ratio) * np.exp(-2j * np.pi * order * middle)
    return FourierSeries(total * transfer, cycles * pair.base_pitch)
