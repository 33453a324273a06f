"""Relief of one gear that leaves the transmission error constant, by the deflection under its design loads."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.loading import LoadingFunction, refuse_beyond_path
from fegear.design.oil_film import OilFilm
from fegear.geometry.pair import MEMBERS, Member


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
    film : OilFilm, optional
        Between the flanks at that load; half of it is removed from each.
    """

    compliance: PairCompliance
    member: Member
    loading: LoadingFunction
    load: float
    film: OilFilm | None = None

    def __post_init__(self) -> None:
        """Refuse design zones that reach beyond the path of contact, and loads that are none."""
        if not (np.isfinite(self.load) and self.load > 0.0):
            raise InputError("design.load", f"{self.load} N", "must be positive and finite")
        self.compliance.refuse_unequal("a relief by its loading")
        refuse_beyond_path(self.loading, self.compliance.pair)

    def _radius(self, x: Array) -> Array:
        return np.asarray(self.compliance.pair.radius(x, self.member))

    def deflection_by_own_load(self, x: ArrayLike) -> Array:
        """Deflection of a tooth of this gear at x under its own share of the design load [m]; zero off the zone."""
        at, pair = np.asarray(x, dtype=float), self.compliance.pair
        inside = np.clip(at, self.loading.x_start, self.loading.x_end)
        w = self.load * self.loading.fraction(at)
        c, face = self.compliance, self.compliance.face_width
        curvature = [pair.flank_curvature_radius(inside, m) for m in MEMBERS]
        relative = np.maximum(curvature[0] * curvature[1] / (curvature[0] + curvature[1]), 1e-9)
        load = np.maximum(w / face, 1e-30) * face if c.hertz == "load-dependent" else c.contact_load
        own = sum(c.own_parts(self.member, 0, self._radius(inside), relative, load))
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
            total[loaded] += source.between(-sign * ahead, 0, here[loaded], there) * w / face
        return total

    def deflection(self, x: ArrayLike) -> Array:
        """Deflection of this gear's flank at x under the design loads, its own and its neighbours' [m] (4.5)."""
        return self.deflection_by_own_load(x) + self.deflection_by_neighbours(x)

    def half_film(self, x: ArrayLike) -> Array:
        """Half the film at x [m]; zero without one."""
        return np.zeros(np.shape(x)) if self.film is None else self.film.half(x)

    @cached_property
    def offset(self) -> float:
        """Largest deflection, less half the film, over the design zone [m]: where the relief is zero."""
        start, end = self.loading.x_start, self.loading.x_end
        places = [x for x in (self.film.x if self.film else ()) if start < x < end]
        x = np.concatenate([np.linspace(start, end, 1201), self.loading.kinks, places])
        return float((self.deflection(x) - self.half_film(x)).max())

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
        return np.asarray(self.offset - self.deflection(where) + self.half_film(where) + first * before + last * after)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles where the loading, or a neighbour's, or the film has a kink."""
        pair = self.compliance.pair
        places = {
            x + k * pair.base_pitch for x in self.loading.kinks for k in range(-3, 4)
            if pair.x_start <= x + k * pair.base_pitch <= pair.x_end
        }  # fmt: skip
        places.update(x for x in (self.film.x if self.film else ()) if pair.x_start <= x <= pair.x_end)
        return tuple(sorted(float(pair.roll_angle(x, self.member)) for x in places))

    def removal(self, roll: ArrayLike) -> Array:
        """Removal at roll angles [m] (the interface of a relief)."""
        return self.at(self.compliance.pair.x_of_roll(roll, self.member))


#: The extrapolation takes its slope from the end of the design zone to this fraction of the ramp inside it: the slope
#: at the very end is infinite with a load-dependent contact (W ln W).
_SECANT = 0.05
