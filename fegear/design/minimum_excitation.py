"""Relief that removes the transmission error at the design load (Mark 4.6a, b), with the full influence matrix.

Each gear's tooth is relieved by the largest of its deflections less its deflection under the design loads on itself and
on its neighbours, so that the loaded flanks are perfect involutes: m(x) = const - sum_j' c_jj'(x) W_j'(x). Beyond the
design zone, where the tooth carries nothing at the design load, the part from its own load goes on as a straight line
(the paper's extrapolation) and the part from its neighbours' loads as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.contact.engagement import Engagement
    from fegear.contact.pair_compliance import PairCompliance
    from fegear.design.loading import LoadingFunction
    from fegear.geometry.pair import Member

    Array = NDArray[np.float64]

#: The extrapolation takes its slope from the end of the design zone to this fraction of the ramp inside it: the slope
#: at the very end is infinite with a load-dependent contact (W ln W).
_SECANT = 0.05


@dataclass(frozen=True)
class MinimumExcitationRelief:
    """Relief of one gear by (4.6), evaluated from the influence functions wherever it is asked for.

    Parameters
    ----------
    compliance : PairCompliance
        With or without neighbour coupling: without, it is the diagonal-only design of the paper's (5.4).
    member : {"driver", "driven"}
    loading : LoadingFunction
    load : float
        W_d [N].
    """

    compliance: PairCompliance
    member: Member
    loading: LoadingFunction
    load: float

    def __post_init__(self) -> None:
        """Refuse design zones that reach beyond the path of contact."""
        pair, slack = self.compliance.pair, 1e-9 * self.compliance.pair.base_pitch
        if self.loading.x_start < pair.x_start - slack or self.loading.x_end > pair.x_end + slack:
            raise RangeError(
                "design.length",
                f"{self.loading.x_start * 1e3:.6g} to {self.loading.x_end * 1e3:.6g} mm",
                f"reaches beyond the path of contact, {pair.x_start * 1e3:.6g} to {pair.x_end * 1e3:.6g} mm",
                "choose a shorter design length or another centre",
            )

    def _radius(self, x: Array) -> Array:
        return np.asarray(self.compliance.pair.radius(x, self.member))

    def deflection_by_own_load(self, x: ArrayLike) -> Array:
        """Deflection of a tooth of this gear at x under its own share of the design load [m]; zero off the zone."""
        at, pair = np.asarray(x, dtype=float), self.compliance.pair
        inside = np.clip(at, self.loading.x_start, self.loading.x_end)
        w = self.load * self.loading.fraction(at)
        source, face = self.compliance.source(self.member), self.compliance.face_width
        radius = self._radius(inside)
        own = source.own(radius)
        line = np.maximum(w / face, 1e-30)
        if source.log_slope > 0.0 and self.compliance.hertz != "none":
            curvature = [pair.flank_curvature_radius(inside, m) for m in ("driver", "driven")]
            relative = np.maximum(curvature[0] * curvature[1] / (curvature[0] + curvature[1]), 1e-9)
            nominal = self.compliance.nominal_load
            loaded = line * face if self.compliance.hertz == "load-dependent" else np.asarray(nominal)
            b = self.compliance.half_width(loaded, relative)
            own = own + source.log_slope * np.log(source.reference_half_width(radius) / b)
        if source.power > 0.0:
            fixed = {"load-dependent": line, "linear": np.asarray(self.compliance.nominal_load / face)}
            own = own + source.power * fixed.get(self.compliance.hertz, np.asarray(1e5)) ** -0.1
        return np.asarray(own * w / face)

    def deflection_by_neighbours(self, x: ArrayLike) -> Array:
        """Deflection of a tooth of this gear at x under the design loads on the other pairs [m]."""
        at, pair = np.asarray(x, dtype=float), self.compliance.pair
        total = np.zeros_like(at)
        source, face = self.compliance.source(self.member), self.compliance.face_width
        if not self.compliance.coupling or source.reach == 0:
            return total
        here = self._radius(np.clip(at, pair.x_start, pair.x_end))
        sign = 1 if self.member == "driver" else -1
        for ahead in range(-source.reach, source.reach + 1):
            other = at + ahead * pair.base_pitch
            loaded = (other > self.loading.x_start) & (other < self.loading.x_end)
            if ahead == 0 or not loaded.any():
                continue
            there = self._radius(other[loaded])
            w = self.load * self.loading.fraction(other[loaded])
            total[loaded] += source.neighbour(-sign * ahead, here[loaded], there) * w / face
        return total

    @cached_property
    def offset(self) -> float:
        """Largest deflection over the design zone [m]: where the relief is zero."""
        x = np.concatenate([np.linspace(self.loading.x_start, self.loading.x_end, 1201), self.loading.kinks])
        return float((self.deflection_by_own_load(x) + self.deflection_by_neighbours(x)).max())

    @cached_property
    def end_slopes(self) -> tuple[float, float]:
        """Growth of the relief per length beyond the start and the end of the design zone [m/m], not negative."""
        ramp = self.loading.terms[0][2]
        step = max(_SECANT * ramp, 1e-6 * self.loading.length)
        x = np.array([self.loading.x_start + step, self.loading.x_end - step])
        first, last = self.deflection_by_own_load(x) / step
        return max(float(first), 0.0), max(float(last), 0.0)

    def at(self, x: ArrayLike) -> Array:
        """Removal at positions x on the line of action [m]."""
        where = np.asarray(x, dtype=float)
        before = np.maximum(self.loading.x_start - where, 0.0)
        after = np.maximum(where - self.loading.x_end, 0.0)
        first, last = self.end_slopes
        deflection = self.deflection_by_own_load(where) + self.deflection_by_neighbours(where)
        return np.asarray(self.offset - deflection + first * before + last * after)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles where the loading, or a neighbour's, has a kink."""
        pair = self.compliance.pair
        places = {
            x + k * pair.base_pitch for x in self.loading.kinks for k in range(-3, 4)
            if pair.x_start <= x + k * pair.base_pitch <= pair.x_end
        }  # fmt: skip
        return tuple(sorted(float(pair.roll_angle(x, self.member)) for x in places))

    def removal(self, roll: ArrayLike) -> Array:
        """Removal at roll angles [m] (the interface of a relief)."""
        pair = self.compliance.pair
        sign = 1.0 if self.member == "driver" else -1.0
        length = np.asarray(roll, dtype=float) * pair.gear(self.member).base_radius
        return self.at(sign * (length - float(pair.flank_curvature_radius(0.0, self.member))))


def minimum_excitation(
    engagement: Engagement, loading: LoadingFunction, load: float, *, full_matrix: bool = True
) -> Engagement:
    """Give both gears of a pair the relief of (4.6) for a design load.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    loading : LoadingFunction
        How the pairs are to share the load.
    load : float
        W_d [N].
    full_matrix : bool
        Whether the design counts what a loaded tooth does to its neighbours; False is the paper's (5.4).
    """
    c = engagement.compliance if full_matrix else replace(engagement.compliance, coupling=False)
    return replace(
        engagement,
        driver_relief=MinimumExcitationRelief(c, "driver", loading, load),
        driven_relief=MinimumExcitationRelief(c, "driven", loading, load),
    )


@dataclass(frozen=True, slots=True)
class ReliefTable:
    """Relief of one gear over its path, as a drawing gives it; arrays of shape (P,).

    Parameters
    ----------
    x, radius, roll_angle : ndarray
        [m], [m], [rad].
    load : ndarray
        Design load on the pair there [N].
    relief : ndarray
        Removal [m].
    """

    x: Array
    radius: Array
    roll_angle: Array
    load: Array
    relief: Array


def relief_table(relief: MinimumExcitationRelief, positions: int = 121) -> ReliefTable:
    """Tabulate a designed relief over the whole path of contact."""
    pair = relief.compliance.pair
    x = np.linspace(pair.x_start, pair.x_end, positions)
    return ReliefTable(
        x,
        np.asarray(pair.radius(x, relief.member)),
        np.asarray(pair.roll_angle(x, relief.member)),
        relief.load * relief.loading.fraction(x),
        relief.at(x),
    )
