"""Tooth loading functions that add up to the design load at every roll position (Mark, Eqs. 4.9 to 4.14, Fig. 8).

A pair's load is W(x) = W_d sum_k w_k (rect_kA * p_k)(x): a plateau of k base pitches smeared by a ramp density p_k.
Since plateaus of k base pitches, repeated every base pitch, add up to k, the loads of all pairs add up to W_d exactly
whatever the ramps. For a contact ratio between n and n + 1 there are two such terms, k = n with ramps as wide as
a = L - n A and k = n - 1 with ramps as wide as A - a (Fig. 8 for n = 2; for n = 1 the second is empty).

Closed-form spectra of the loading ramps (Mark, braces of Eqs. 4.15b and 4.16), safe at every argument.

How a tooth that vibrates by itself answers the load that it takes up and hands on (Mark, sections 4.15 to 4.22).

A tooth of natural frequency f under a load W(t) that moves it slowly by W/k is an oscillator under one pulse; it has
come to rest when it meets the mating gear again. What vibration the pulse leaves is the load's spectrum at f: its
amplitude over the deflection under the design load is 2 pi f |F(f)| / W_d, which falls like the envelope of (4.22).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown
from fegear.geometry.pair import GearPair


@dataclass(frozen=True, slots=True)
class Ramp:
    """How a tooth is loaded from 0 (x = -1) to 1 (x = 1): odd about the middle, monotone.

    Parameters
    ----------
    slope : float
        s, dimensionless slope at both ends: 0 to 2 for the sinusoidal family, 0 to r for the polynomial one; 1 with
        either is the straight line.
    exponent : int or None
        r, odd and at least 3, of the polynomial family (4.14); None for the sinusoidal family (4.12).
    """

    slope: float = shown("", "s at initiation", default=1.0)
    exponent: int | None = shown("", "r; 0: sinusoidal family", default=None)

    def __post_init__(self) -> None:
        """Refuse loadings that are not monotone."""
        r = self.exponent
        if r is not None and (int(r) != r or r < 3 or r % 2 == 0):
            raise InputError("design.exponent", r, "must be an odd whole number of at least 3", "choose 3, 5, 7, ...")
        top = 2.0 if r is None else float(r)
        if not 0.0 <= self.slope <= top:
            raise InputError(
                "design.slope",
                self.slope,
                f"must be between 0 and {top:g} for a monotonic load ramp",
                'use family = "polynomial" with a larger exponent for steeper loading',
            )

    def load(self, x: ArrayLike) -> Array:
        """Dimensionless load w(x), -1 to 1, for x from -1 to 1 (clipped outside) (4.12, 4.14)."""
        t, s, r = np.clip(np.asarray(x, dtype=float), -1.0, 1.0), self.slope, self.exponent
        if r is None:
            return np.asarray(t + (1.0 - s) / math.pi * np.sin(math.pi * t))
        return np.asarray(((r - s) * t + (s - 1.0) * t**r) / (r - 1.0))

    def slope_at(self, x: ArrayLike) -> Array:
        """dw/dx for x from -1 to 1."""
        t, s, r = np.asarray(x, dtype=float), self.slope, self.exponent
        if r is None:
            return np.asarray(1.0 + (1.0 - s) * np.cos(math.pi * t))
        return np.asarray(((r - s) + (s - 1.0) * r * t ** (r - 1)) / (r - 1.0))

    def spectrum_factor(self, q: ArrayLike) -> Array:
        """Fourier transform of the ramp's density, q in cycles per ramp width: the braces of (4.15b) and (4.16)."""
        if self.exponent is None:
            return sinusoidal_factor(q, self.slope)
        return polynomial_factor(q, self.slope, self.exponent)

    def asymptotic_factor(self, q: ArrayLike) -> Array:
        """What the factor tends to at high frequency, s sinc(q), whatever the family (4.20); none where s is zero."""
        return np.asarray(self.slope * np.sinc(np.asarray(q, dtype=float)))


@dataclass(frozen=True, slots=True)
class LoadingFunction:
    """Load of one tooth pair over its path of contact as a fraction of the design load.

    Parameters
    ----------
    length : float
        L, length of the path over which a pair is loaded [m]; L / A is the design contact ratio.
    base_pitch : float
        A [m].
    centre : float
        Middle of the path [m].
    ramp : Ramp
        Loading at the ends of contact.
    inner_ramp : Ramp
        Loading between the lower and the upper level for contact ratios above 2 (second box of Fig. 8).
    peak : float
        F, the largest load of a pair as a fraction of the design load: between 1/n and 1/(n - 1) for a contact ratio
        from n to n + 1; 1 for a contact ratio below 2. NaN, the default, takes the middle of that range.

    Raises
    ------
    RangeError
        If the contact ratio is below 1, or the peak outside its range.
    """

    length: float
    base_pitch: float
    centre: float = 0.0
    ramp: Ramp = Ramp()
    inner_ramp: Ramp = Ramp()
    peak: float = shown("", "F, peak load relative to the design load", default=math.nan)

    def __post_init__(self) -> None:
        """Refuse loadings that cannot carry the load at every position."""
        ratio = self.length / self.base_pitch
        if not ratio >= 1.0 - 1e-12:
            raise RangeError(
                "design.length",
                f"{self.length * 1e3:.6g} mm",
                f"is {ratio:.4f} base pitches; must be at least 1",
                f"choose at least the base pitch, {self.base_pitch * 1e3:.6g} mm",
            )
        low, high = self.peak_range
        if math.isnan(self.peak):
            object.__setattr__(self, "peak", 0.5 * (low + high))
        if not low - 1e-12 <= self.peak <= high + 1e-12:
            raise RangeError(
                "design.peak", self.peak, f"must be between {low:.6g} and {high:.6g} for contact ratio {ratio:.4f}"
            )

    @property
    def order(self) -> int:
        """n: between n and n + 1 pairs share the load."""
        return max(math.floor(self.length / self.base_pitch * (1.0 + 1e-12)), 1)

    @property
    def peak_range(self) -> tuple[float, float]:
        """Smallest and largest F for which the loading stays monotone."""
        n = self.order
        return (1.0, 1.0) if n == 1 else (1.0 / n, 1.0 / (n - 1))

    @property
    def terms(self) -> tuple[tuple[float, int, float, Ramp], ...]:
        """(weight w_k, k, ramp width, ramp) of the plateaus."""
        n = self.order
        outer = max(self.length - n * self.base_pitch, 0.0)
        terms = [(1.0 - (n - 1) * self.peak if n > 1 else 1.0, n, outer, self.ramp)]
        if n > 1:
            terms.append((n * self.peak - 1.0, n - 1, self.base_pitch - outer, self.inner_ramp))
        return tuple(terms)

    @property
    def x_start(self) -> float:
        """Where loading starts [m]."""
        return self.centre - 0.5 * self.length

    @property
    def x_end(self) -> float:
        """Where loading ends [m]."""
        return self.centre + 0.5 * self.length

    @property
    def kinks(self) -> tuple[float, ...]:
        """Positions [m] where a ramp starts or ends."""
        places = set()
        for _, k, width, _ in self.terms:
            for side in (-1.0, 1.0):
                for end in (-0.5, 0.5):
                    places.add(self.centre + side * 0.5 * k * self.base_pitch + end * width)
        return tuple(sorted(places))

    def fraction(self, x: ArrayLike) -> Array:
        """W(x) / W_d, shape of x [m]; zero outside the path."""
        distance = np.abs(np.asarray(x, dtype=float) - self.centre)
        total = np.zeros_like(distance)
        for weight, k, width, ramp in self.terms:
            edge = 0.5 * k * self.base_pitch - distance  # positive inside the plateau
            if width > 0.0:
                total += weight * 0.5 * (1.0 + ramp.load(2.0 * edge / width))
            else:
                total += weight * (edge >= 0.0)
        return np.maximum(total, 0.0)

    def initial_slope(self) -> float:
        """Slope d(W / W_d)/dx at contact initiation [1/m] (4.21); infinite for a path that starts with a jump."""
        weight, _, width, ramp = self.terms[0]
        return weight * ramp.slope / width if width > 0.0 else (math.inf if weight > 0.0 else 0.0)

    def spectrum(self, g: ArrayLike) -> NDArray[np.complex128]:
        """Fourier transform of W(x) / W_d [m] at g [cycles/m]: the integral of W exp(-2 pi i g x) (4.15b, 4.16).

        Closed form for every g, zero and the removable singularities included. At g = n/A all but n = 0 vanish: the
        loads of all pairs add up to a constant.
        """
        orders = np.asarray(g, dtype=float)
        total = np.zeros(orders.shape)
        for weight, k, width, ramp in self.terms:
            plateau = k * self.base_pitch
            total = total + weight * plateau * np.sinc(plateau * orders) * ramp.spectrum_factor(width * orders)
        return np.asarray(total * np.exp(-2j * math.pi * orders * self.centre))

    def asymptote(self, g: ArrayLike) -> NDArray[np.complex128]:
        """What the spectrum tends to at high frequency [m], at g [cycles/m] (4.20, 4.22); a jump is its own."""
        orders = np.asarray(g, dtype=float)
        total = np.zeros(orders.shape)
        for weight, k, width, ramp in self.terms:
            factor = ramp.asymptotic_factor(width * orders) if width > 0.0 else 1.0
            total = total + weight * k * self.base_pitch * np.sinc(k * self.base_pitch * orders) * factor
        return np.asarray(total * np.exp(-2j * math.pi * orders * self.centre))

    def envelope(self, g: ArrayLike) -> Array:
        """Largest size of the asymptote about g > 0 [m]: initial slope over (pi g)^2 for one ramp (after 4.22).

        With an inner ramp both slopes add up; a path that starts with a jump J falls like J / (pi g) only.
        """
        wave = math.pi * np.asarray(g, dtype=float)
        total = np.zeros(wave.shape)
        for weight, _, width, ramp in self.terms:
            total = total + (weight * ramp.slope / (width * wave**2) if width > 0.0 else weight / wave)
        return np.asarray(total)


@dataclass(frozen=True, slots=True)
class SlopeTradeOff:
    """What the initial slope buys and costs (Mark, after Eq. 4.22).

    Parameters
    ----------
    initial_slope : ndarray, shape (F,)
        d(W / W_d)/dx at contact initiation [1/m].
    length_per_load : ndarray, shape (F,)
        Rough change of the loaded length when the load grows by its own size, 2 / initial slope [m]: with relief from
        (4.6) the relief's slope follows the loading's.
    high_frequency_content : ndarray, shape (F,)
        Root mean square of the spectrum above the frequency asked for, in plateau areas W_d A.
    """

    initial_slope: Array
    length_per_load: Array
    high_frequency_content: Array


def slope_trade_off(functions: Sequence[LoadingFunction], above: float) -> SlopeTradeOff:
    """Compare loading functions by how steady the loaded length is and how much they excite tooth resonances.

    Parameters
    ----------
    functions : sequence of LoadingFunction
    above : float
        Frequency from which content counts [tooth-mesh orders]; to ten times that.
    """
    orders = np.linspace(above, 10.0 * above, 4001)
    initial = np.array([f.initial_slope() for f in functions])
    content = [np.abs(f.spectrum(orders / f.base_pitch)) / f.base_pitch for f in functions]
    with np.errstate(divide="ignore"):
        return SlopeTradeOff(initial, 2.0 / initial, np.array([math.sqrt(float(np.mean(c**2))) for c in content]))


def sinusoidal_factor(q: ArrayLike, slope: float) -> Array:
    """sinc(q) (1 - s q^2) / (1 - q^2), with sinc(q) = sin(pi q)/(pi q); (1 - s)/2 at q = 1 (Mark 4.15b).

    Beyond q = 1/2 the zero of sin(pi q) at q = 1 is written out, sin(pi q) = sin(pi (1 - q)), so nothing cancels.
    """
    a = np.abs(np.asarray(q, dtype=float))
    near = a < 0.5
    inner, outer = np.where(near, a, 0.0), np.where(near, 1.0, a)
    kernel = np.where(near, np.sinc(inner) / (1.0 - inner * inner), np.sinc(1.0 - outer) / (outer * (1.0 + outer)))
    return np.asarray(kernel * (1.0 - slope * a * a))


def polynomial_factor(q: ArrayLike, slope: float, exponent: int) -> Array:
    """(r - s)/(r - 1) sinc(q) + r (s - 1)/(r - 1) J_{r-1}(pi q) (Mark 4.16)."""
    r, s = exponent, slope
    q = np.asarray(q, dtype=float)
    return np.asarray(((r - s) * np.sinc(q) + r * (s - 1.0) * cosine_moment(math.pi * q, r - 1)) / (r - 1.0))


def cosine_moment(a: ArrayLike, p: int) -> Array:
    """J_p(a), the integral of t^p cos(a t) from 0 to 1, for even p.

    The recurrence J_p = sin a / a + p cos a / a^2 - p (p - 1)/a^2 J_{p-2} shrinks errors when a > p and multiplies them
    when a is smaller; there the integrand is a polynomial times few waves, which Gauss quadrature integrates to
    round-off.
    """
    x = np.abs(np.asarray(a, dtype=float))
    limit = max(40.0, 2.0 * p)
    t, w = np.polynomial.legendre.leggauss(p + 40)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    small, large = np.minimum(x, limit), np.maximum(x, limit)
    quadrature = np.cos(np.multiply.outer(small, t)) @ (w * t**p)
    sine, cosine = np.sin(large) / large, np.cos(large) / large**2
    recurrence = sine
    for k in range(2, p + 1, 2):
        recurrence = sine + k * cosine - k * (k - 1) / large**2 * recurrence
    return np.asarray(np.where(x < limit, quadrature, recurrence))


#: Straight pieces of the load over the path, and orders looked at together.
_PIECES, _TOGETHER = 2000, 64


@dataclass(frozen=True, slots=True)
class ToothResponse:
    """Deflection of a tooth without damping, over that under the design load at rest; arrays of shape (G,)."""

    residual: Array = shown(
        "", "residual vibration amplitude after contact (undamped), relative to the deflection under the design load",
        label="residual vibration amplitude",
    )  # fmt: skip
    envelope: Array = shown("", "high-frequency asymptote (4.22)")
    largest: Array = shown("", "maximum deflection during contact", label="maximum deflection")


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


def refuse_beyond_path(loading: LoadingFunction, pair: GearPair) -> None:
    """Refuse a design zone that reaches beyond the path of contact.

    Raises
    ------
    RangeError
    """
    slack = 1e-9 * pair.base_pitch
    if loading.x_start < pair.x_start - slack or loading.x_end > pair.x_end + slack:
        raise RangeError(
            "design.length",
            f"{loading.x_start * 1e3:.6g} to {loading.x_end * 1e3:.6g} mm",
            f"extends beyond the path of contact, {pair.x_start * 1e3:.6g} to {pair.x_end * 1e3:.6g} mm",
            "choose a shorter design length or another centre",
        )
