"""What would explain a trace clearly better: sign, direction, zero or scale of its angle, fillet or torque.

Each alternative is fitted as the trace itself is, its scale always free: what is compared is the part of the variance
that a curve leaves unexplained, 1 - r^2 with the correlation r of the shapes, noise aside (1 where the fitted scale is
not positive). An alternative is stated where it leaves far less than the trace as it is described, fits in shape, and
noise cannot be the reason; of several the one that changes least.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Literal

from fegear.contact.curve_fit import NothingToCompareError, fit_curve
from fegear.contact.turns import going_on

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.fitted_line import Fitted

#: What may be otherwise than described.
Change = Literal["sign", "reverse", "curve", "shift", "turning"]
#: Least correlation of an alternative that is stated.
_FITS = 0.9
#: Times less that it leaves unexplained; where the trace fits in shape already, that many times.
_LESS, _LESS_OF_ALIKE, _ALIKE = 4.0, 9.0, 0.98
#: Least gain of the fit, as chi squared by the residual of the alternative.
_CERTAIN = 50.0
#: Part of the variance left unexplained below which nothing better is looked for; for an angle reversed, which changes
#: little of a curve that is nearly symmetric and which no fit makes up for, the smaller one.
_EXPLAINED, _EXPLAINED_REVERSED = 2e-3, 1e-4
#: Alternatives that leave at most that many times what the best one leaves are as good.
_AS_GOOD = 2.0
#: Less than this is left by rounding.
_NOTHING = 1e-6
#: Standard errors of what noise leaves unexplained.
_BY_NOISE = 3.0
#: Tooth pitches by which one miscounts at most, and how near to them a shift is.
_PITCHES, _NEAR = 2, 0.1
#: Samples that are fitted at most, and with another scale of the angle, of which there are many descriptions.
_MOST, _MOST_TURNING = 20_000, 4_000


@dataclass(frozen=True)
class Alternative:
    """A description of a trace that fits clearly better.

    Parameters
    ----------
    changes : tuple of {"sign", "reverse", "curve", "shift", "turning"}
        In what it differs: measured with the other sign, angle counted the other way, another computed curve, zero of
        the angle elsewhere, angle of another shaft or of an encoder that counts other than stated.
    curve : str
        Name of the other curve; empty for the trace's own.
    fitted : FittedCurve
    turning : str
        Name of the factor of the angle; empty for the angle as measured.
    factor : float
        Of the angle.
    """

    changes: tuple[Change, ...]
    curve: str
    fitted: FittedCurve
    turning: str = ""
    factor: float = 1.0


@dataclass(frozen=True)
class _Description:
    """Signs of trace and angle, computed curve, factor of the angle, and what is fitted besides."""

    changes: tuple[Change, ...]
    curve: str
    sign: float
    sense: float
    turning: str
    fits: tuple[Fitted, ...]


def unexplained(found: FittedCurve) -> float:
    """Part of the variance of a trace, less its noise, that its curve leaves, 0 to 1."""
    return 1.0 - found.likeness**2 if found.gain > 0.0 and found.likeness > 0.0 else 1.0


def _left(found: FittedCurve) -> float:
    """The same with the noise."""
    return 1.0 - found.correlation**2 if found.gain > 0.0 and found.correlation > 0.0 else 1.0


def alternatives(
    found: FittedCurve, angle: Array, measured: Array, curve_angle: Array, curves: Mapping[str, Array],
    fit: Collection[Fitted], *, shifts: bool = True, turnings: Mapping[str, float] | None = None,
) -> tuple[Alternative, ...]:  # fmt: skip
    """Descriptions of a trace that fit it clearly better, the likeliest first; none where it fits as described.

    Parameters
    ----------
    found : FittedCurve
        The trace as it is described.
    angle, measured : ndarray, shape (N,)
    curve_angle : ndarray, shape (Q,)
    curves : mapping of str to ndarray, shape (Q,)
        Computed: under the empty name the trace's own, and others by their names.
    fit : collection of str
        What was asked for.
    shifts : bool
        Whether the zero of the angle may be elsewhere, if it is not fitted.
    turnings : mapping of str to float, optional
        Factors by which the angle may have to be multiplied, by their names; its zero is then anywhere.
    """
    left, factors = unexplained(found), {"": 1.0, **(turnings or {})}
    if left < _EXPLAINED_REVERSED:
        return ()
    going = going_on(angle)
    likely: list[Alternative] = []
    for one in _descriptions(curves, factors, shifts=shifts and "shift" not in fit):
        if left < _EXPLAINED and one.changes != ("reverse",):
            continue
        some = slice(None, None, -(-angle.size // (_MOST_TURNING if one.turning else _MOST)))
        at = going[some] * factors[one.turning] if one.turning else angle[some]
        try:
            again = fit_curve(
                one.sense * at, one.sign * measured[some], curve_angle, curves[one.curve], {*fit, "scale", *one.fits}
            )
        except NothingToCompareError:
            continue
        likely.append(Alternative(one.changes, one.curve, again, one.turning, factors[one.turning]))
    good = [one for one in likely if clearly_better(one.fitted, found)]
    if not good:
        return ()
    best = min((one.fitted for one in good), key=_left)
    by_noise = _BY_NOISE * _left(best) * math.sqrt(2.0 / best.samples)
    most = _AS_GOOD * max(unexplained(best), by_noise, _NOTHING)
    alike = [one for one in good if unexplained(one.fitted) <= most]
    fewest = min(len(one.changes) for one in alike)
    return tuple(sorted((one for one in alike if len(one.changes) == fewest), key=lambda one: unexplained(one.fitted)))


def _descriptions(curves: Collection[str], turnings: Collection[str], *, shifts: bool) -> Iterator[_Description]:
    """Each other description."""
    for name, turning, sign, sense, shifted in product(
        curves, turnings, (1.0, -1.0), (1.0, -1.0), (False, True)[: 1 + shifts]
    ):
        if turning and shifted:  # another angle has another zero
            continue
        wrong: tuple[tuple[Change, bool], ...] = (
            ("sign", sign < 0.0), ("reverse", sense < 0.0), ("curve", bool(name)), ("shift", shifted),
            ("turning", bool(turning)),
        )  # fmt: skip
        changes = tuple(change for change, is_so in wrong if is_so)
        if changes:
            yield _Description(changes, name, sign, sense, turning, ("shift",) if shifted or turning else ())


def clearly_better(one: FittedCurve, than: FittedCurve) -> bool:
    """Whether a fit leaves so much less unexplained that noise cannot be the reason."""
    of, left = unexplained(one), unexplained(than)
    times = _LESS_OF_ALIKE if left < 1.0 - _ALIKE**2 else _LESS
    chi_squared = one.samples * (_left(than) - _left(one)) / max(_left(one), 1e-12)
    return of <= min(left / times, 1.0 - _FITS**2) and chi_squared > _CERTAIN


def whole_pitches(shift: float, teeth: int) -> int:
    """Tooth pitches that a shift [rad] is, 0 where it is not close to a few of them."""
    pitch = 2.0 * math.pi / abs(teeth)
    count = round(shift / pitch)
    return count if 0 < abs(count) <= _PITCHES and abs(shift / pitch - count) < _NEAR else 0
