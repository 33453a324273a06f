"""How a tooth that vibrates by itself answers the load that it takes up and hands on (Mark, sections 4.15 to 4.22).

A tooth of natural frequency f under a load W(t) that moves it slowly by W/k is an oscillator under one pulse; it has
come to rest when it meets the mating gear again. What vibration the pulse leaves is the load's spectrum at f: its
amplitude over the deflection under the design load is 2 pi f |F(f)| / W_d, which falls like the envelope of (4.22).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.design.loading import LoadingFunction

#: Straight pieces of the load over the path, and orders looked at together.
_PIECES, _TOGETHER = 2000, 64


@dataclass(frozen=True, slots=True)
class ToothResponse:
    """Deflection of a tooth without damping, over that under the design load at rest; arrays of shape (G,).

    Parameters
    ----------
    residual : ndarray
        Amplitude (0-peak) of the vibration that is left when contact ends.
    envelope : ndarray
        What that does not exceed at high frequency (4.22).
    largest : ndarray
        Largest deflection during contact; 1 is that at rest for contact ratios up to 2.
    """

    residual: Array
    envelope: Array
    largest: Array


def tooth_response(function: LoadingFunction, orders: ArrayLike) -> ToothResponse:
    """Answer of a tooth whose natural frequency is `orders` times the tooth-mesh frequency.

    Parameters
    ----------
    function : LoadingFunction
    orders : array_like, shape (G,)
        Positive.
    """
    order, pitch = np.asarray(orders, dtype=float), function.base_pitch
    wave = 2.0 * math.pi * order
    g = order / pitch
    residual = wave * np.abs(function.spectrum(g)) / pitch
    envelope = wave * function.envelope(g) / pitch
    x = np.unique(np.concatenate([np.linspace(function.x_start, function.x_end, _PIECES + 1), function.kinks]))
    load = function.fraction(x)
    parts = [_largest(wave[i : i + _TOGETHER], x / pitch, load) for i in range(0, wave.size, _TOGETHER)]
    return ToothResponse(residual, envelope, np.concatenate(parts))


def _largest(wave: Array, at: Array, load: Array) -> Array:
    """Largest deflection under a load of straight pieces, exact for those; shape of `wave`, per base pitch.

    About W/k the tooth swings by minus the integral of W'(t) cos(w (T - t)): a jump starts it with its height.
    """
    slope = np.diff(load) / np.diff(at)
    turned = np.exp(-1j * np.multiply.outer(wave, at))
    started = np.cumsum(slope * np.diff(turned, axis=1), axis=1) * (1j / wave[:, None])
    swing = load[0] * turned[:, :1] + np.concatenate([np.zeros((wave.size, 1)), started], axis=1)
    return np.asarray((load - np.real(swing * turned.conj())).max(axis=1))
