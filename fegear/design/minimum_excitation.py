"""Relief that removes the transmission error at the design load (Mark 4.6a, b), with the full influence matrix.

Each gear's tooth is relieved by the largest of its deflections less its deflection under the design loads on itself and
on its neighbours, so that the loaded flanks are perfect involutes: m(x) = const - sum_j' c_jj'(x) W_j'(x). Beyond the
design zone, where the tooth carries nothing at the design load, the part from its own load goes on as a straight line
(the paper's extrapolation) and the part from its neighbours' loads as it is.

The layer of oil between loaded flanks, half of which each relief makes up for (Mark, after Eq. 4.6).

A film that is equally thick everywhere only turns the gears a little; one that thins along the path is an error of the
transmission, which the relief takes back where the film's thickness is known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.loading import LoadingFunction, refuse_beyond_path
from fegear.design.relief_bound import refuse_deeper_than_the_tooth
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.relief import Relief, TabulatedRelief

#: The extrapolation takes its slope from the end of the design zone to this fraction of the ramp inside it: the slope
#: at the very end is infinite with a load-dependent contact (W ln W).
_SECANT = 0.05


#: Largest distance of a tabulated relief from the designed one, over the pair's largest deflection.
_CHORD = 1e-6


#: Nodes no nearer than this fraction of the path: nearer ones would print as the same roll angle.
_NEAREST = 1e-7


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
        refuse_beyond_path(self.loading, self.compliance.pair)

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


def minimum_excitation(
    engagement: Engagement,
    loading: LoadingFunction,
    load: float,
    *,
    full_matrix: bool = True,
    film: OilFilm | None = None,
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
    film : OilFilm, optional
        Between the flanks at the design load.

    Raises
    ------
    RangeError
        If a relief is deeper than its tooth can take: a design contact ratio at or just above a whole number loads a
        tooth almost at once, and the straight line beyond the design zone is then all but vertical.
    """
    c = engagement.compliance if full_matrix else replace(engagement.compliance, coupling=False)
    driver = MinimumExcitationRelief(c, "driver", loading, load, film)
    driven = MinimumExcitationRelief(c, "driven", loading, load, film)
    refuse_deeper_than_the_tooth(driver, driven)
    return replace(engagement, driver_relief=driver, driven_relief=driven)


@dataclass(frozen=True, slots=True)
class ReliefTable:
    """Relief of one gear over its path, as a drawing gives it; arrays of shape (P,)."""

    x: Array = shown("mm", "position on the line of action, positive toward the driver's tip", table="flank")
    radius: Array = shown("mm", "radius of the flank point", table="flank")
    roll_angle: Array = shown("deg", "roll angle of the flank point", label="roll angle", table="flank")
    load: Array = shown("N", "design load on the pair there", label="load", table="flank")
    relief: Array = shown("um", "material to remove, along the normal", label="material to remove", table="flank")
    deflection: Array = shown(
        "um",
        "of this flank under the design loads, which the relief makes up for",
        label="deflection of the flank",
        table="flank",
    )

    def relieved(self) -> TabulatedRelief:
        """The relief that straight lines between the nodes make."""
        order = np.argsort(self.roll_angle)
        return TabulatedRelief(self.roll_angle[order], self.relief[order])


def relief_nodes(*reliefs: MinimumExcitationRelief, tolerance: float | None = None) -> Array:
    """Positions at which designed reliefs are to be tabulated so that straight lines between them keep to the design.

    Every kink of the loading and of a table of compliances is a node, and pieces are cut until the straight line
    over each is near enough: nodes crowd where the load starts, W ln W having an infinite slope there.

    Parameters
    ----------
    reliefs : MinimumExcitationRelief
        Of one pair.
    tolerance : float, optional
        Largest distance from any of them [m]; by default 1e-6 of the pair's largest deflection.

    Returns
    -------
    ndarray, shape (P,)
        From the start to the end of the path of contact [m].
    """
    pair = reliefs[0].compliance.pair
    bound = _CHORD * sum(r.offset for r in reliefs) if tolerance is None else tolerance
    places = [pair.x_start, pair.x_end]
    for r in reliefs:
        places += [float(x) for x in pair.x_of_roll(np.array(r.kinks), r.member)]
        radii = np.array(r.compliance.source(r.member).kinks)
        places += [float(x) for x in pair.x_of_radius(radii, r.member)]
    x = np.unique(np.clip(places, pair.x_start, pair.x_end))
    nearest = _NEAREST * pair.path_length
    x = x[np.concatenate([[True], np.diff(x) > nearest])]
    x[-1] = pair.x_end
    inside = np.array([0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95])
    left, right, done = x[:-1], x[1:], [x]
    while left.size:
        trial = left + np.multiply.outer(inside, right - left)
        off = np.zeros(left.size)
        for r in reliefs:
            a, b = r.at(left), r.at(right)
            off = np.maximum(off, np.abs(r.at(trial) - a - np.multiply.outer(inside, b - a)).max(axis=0))
        split = (off > bound) & (right - left > 4.0 * nearest)
        left, right = left[split], right[split]
        # Halved while far off; near the goal into just as many pieces as the square of their length asks for.
        pieces = np.where(off > 16.0 * bound, 2, np.ceil(np.sqrt(off / bound)))[split].astype(int)
        cuts = [np.linspace(a, b, n + 1) for a, b, n in zip(left, right, pieces, strict=True)]
        done += [cut[1:-1] for cut in cuts]
        left, right = np.concatenate([x[:0], *(c[:-1] for c in cuts)]), np.concatenate([x[:0], *(c[1:] for c in cuts)])
    return np.sort(np.concatenate(done))


def relief_table(relief: MinimumExcitationRelief, positions: int | ArrayLike | None = None) -> ReliefTable:
    """Tabulate a designed relief over the whole path of contact.

    Parameters
    ----------
    relief : MinimumExcitationRelief
    positions : int or array_like, optional
        Positions on the line of action [m], or how many, evenly spaced; by default `relief_nodes`.
    """
    pair = relief.compliance.pair
    if positions is None:
        x = relief_nodes(relief)
    elif np.ndim(positions) == 0:
        x = np.linspace(pair.x_start, pair.x_end, int(np.asarray(positions)))
    else:
        x = np.array(positions, dtype=float)
    return ReliefTable(
        x,
        np.asarray(pair.radius(x, relief.member)),
        np.asarray(pair.roll_angle(x, relief.member)),
        relief.load * relief.loading.fraction(x),
        relief.at(x),
        relief.deflection(x),
    )


@dataclass(frozen=True)
class OilFilm:
    """Thickness of the film at the design load over the path of contact: straight between places, level beyond.

    Parameters
    ----------
    x : tuple of float
        Places on the line of action, rising [m].
    thickness : tuple of float
        There, of the whole film [m].
    """

    x: tuple[float, ...]
    thickness: tuple[float, ...]

    def half(self, x: ArrayLike) -> Array:
        """What each flank's relief makes up for at x [m]."""
        return np.asarray(0.5 * np.interp(np.asarray(x, dtype=float), self.x, self.thickness))

    def between(self, engagement: Engagement) -> Engagement:
        """The pair with the film between its flanks, which it holds apart as if they were so much thicker."""
        pair, e = engagement.pair, engagement
        return replace(
            e, driver_relief=Coated(e.driver_relief, self, pair, "driver"),
            driven_relief=Coated(e.driven_relief, self, pair, "driven"),
        )  # fmt: skip


@dataclass(frozen=True)
class Coated:
    """A flank's relief less its half of the film, as contact meets it.

    Parameters
    ----------
    relief : Relief
    film : OilFilm
    pair : GearPair
    member : {"driver", "driven"}
    """

    relief: Relief
    film: OilFilm
    pair: GearPair
    member: Member

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles of the relief's and of the film's places."""
        places = (float(self.pair.roll_angle(x, self.member)) for x in self.film.x)
        return tuple(sorted({*self.relief.kinks, *places}))

    def removal(self, roll: ArrayLike) -> Array:
        """Removal less half the film at roll angles [m]."""
        return np.asarray(self.relief.removal(roll) - self.film.half(self.pair.x_of_roll(roll, self.member)))
