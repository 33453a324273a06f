"""A gear with odd teeth as a compliance source: its teeth have numbers, and their answers a period of one revolution.

c_ii of every tooth that answers otherwise than the ordinary ones is a spline, c_ij of two teeth of which one does a
series; all else is the ordinary gear's. Of the base pitches of a revolution those are distinct in which such a tooth
can touch, and only they are solved: the others recall the ordinary one (`same_as`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.fe_compliance import (
    FiniteElementCompliance,
    chebyshev_nodes,
    chebyshev_over,
    finite_element_compliance,
    roll_length,
    tabulated_own,
)
from fegear.contact.plane.shifted_compliance import ShiftedCompliance, neighbours_shifted_by_error, shifted_by_error
from fegear.contact.plane.spline import Spline, spline
from fegear.fem.plane.odd.odd_gear import OddGearInfluence

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import Side
    from fegear.contact.plane.stress_rows import StressRows
    from fegear.fem.plane.root_stress import CutFillet, FilletCurve

#: Radii at which errors of c_ij are looked for.
_FEW = 4


@dataclass(frozen=True)
class OddCompliance:
    """One gear's influence functions, some of its teeth odd, interpolated in the roll length.

    Parameters
    ----------
    influence : OddGearInfluence
    ordinary : FiniteElementCompliance or ShiftedCompliance
        Of the gear whose teeth are all alike.
    own_splines : mapping of int to Spline
        c_ii at the reference half-width [m^2/N] over the roll length [m], by the tooth's number from the middle one.
        Of no missing tooth: it carries no load. Faces of cracks that may close do so under this load.
    series : mapping of (int, int) to ndarray
        Chebyshev coefficients of c_ij(p, q), shape (m, m) each, by such numbers; faces of cracks are free.
    closing : mapping of int to Spline
        What such faces change of c_ii by closing; empty where none may close.
    openings : mapping of int to ndarray
        Chebyshev coefficients of the opening of the nodes of all such faces, free, per line load, shape (N, m).
    free : bool
        Whether root stress is that of free faces, to which `stress_by_faces` adds what their forces do.
    """

    influence: OddGearInfluence
    ordinary: FiniteElementCompliance | ShiftedCompliance
    own_splines: Mapping[int, Spline]
    series: Mapping[tuple[int, int], Array]
    closing: Mapping[int, Spline] = field(default_factory=dict)
    openings: Mapping[int, Array] = field(default_factory=dict)
    free: bool = False

    kinks = ()
    power = 0.0
    remarks = ()

    @cached_property
    def stress_rows(self) -> dict[tuple[Side, int, int], StressRows]:
        """Root stress at the contacts asked for last, by fillet, by how many neighbours count, and by the teeth."""
        return {}

    @property
    def _ends(self) -> tuple[float, float]:
        """Roll lengths of the ends of an ordinary flank [m]."""
        plain = self.ordinary.base if isinstance(self.ordinary, ShiftedCompliance) else self.ordinary
        return plain.lowest, plain.highest

    def _along(self, near: int, radius: ArrayLike) -> Array:
        """Roll lengths on the flank of a tooth [m]: beyond a shorter one's tip that of the tip."""
        length = roll_length(self.influence.gear, radius, *self._ends)
        return np.minimum(length, self.own_splines[near].x[-1]) if near in self.own_splines else length

    @property
    def states_error(self) -> bool:
        """Whether its errors are estimated, and those of ordinary teeth."""
        return self.influence.fine.lower is not None and self.influence.ordinary.estimate is not None

    @property
    def reach(self) -> int:
        """K of the ordinary gear."""
        return self.ordinary.reach

    @property
    def log_slope(self) -> float:
        """kappa [m^2/N]."""
        return self.ordinary.log_slope

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """As of the ordinary teeth."""
        return self.ordinary.tip_wedge

    @property
    def period(self) -> int:
        """The gear's teeth."""
        return self.influence.gear.teeth

    def same_as(self, first: int, count: int) -> int:
        """Those from `first` on by themselves where one of them answers otherwise than ordinary teeth."""
        z, touched = self.period, self.influence.touched
        if any(self._from_middle(first + n) in touched for n in range(min(count, z))):
            return first % z
        return (self.influence.middle + touched[-1] + 1) % z

    def _from_middle(self, tooth: int) -> int:
        return self.influence.from_middle(tooth)

    def _odd(self, i: int, j: int) -> tuple[int, int] | None:
        """Two teeth by their numbers from the middle one; None if they answer as ordinary ones do."""
        known, touched = self.influence.known, self.influence.touched
        near = self._from_middle(i)
        other = near + j - i
        if near not in known and self._from_middle(j) in known:
            other = self._from_middle(j)
            near = other + i - j
        between = range(min(near, other), max(near, other) + 1)
        if near not in known or other not in known or between[0] > touched[-1] or between[-1] < touched[0]:
            return None
        return near, other

    def own(self, i: int, radius: ArrayLike) -> Array:
        """c_ii at the reference half-width [m^2/N]."""
        near = self._from_middle(i)
        if near not in self.own_splines:
            return self.ordinary.own(i, radius)
        return np.asarray(self.own_splines[near](self._along(near, radius)))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """The half-width that `own` is for [m]."""
        return self.ordinary.reference_half_width(radius)

    def by_closing(self, i: int, radius: ArrayLike) -> Array:
        """What faces of cracks that close under a load on tooth i change of `own` [m^2/N]."""
        near = self._from_middle(i)
        if near not in self.closing:
            return np.zeros(np.shape(radius))
        return np.asarray(self.closing[near](self._along(near, radius)))

    def moves_faces(self, i: int) -> bool:
        """Whether loads on a tooth open or close cracks whose faces may close."""
        return self._from_middle(i) in self.openings

    def face_openings(self, i: int, radius: Array) -> Array:
        """Opening of the nodes of all such faces, free, per unit line load on a tooth, shape (N, P) [m^2/N]."""
        near = self._from_middle(i)
        coefficients = np.ascontiguousarray(self.openings[near].T)
        return np.asarray(np.polynomial.chebyshev.chebval(self._share(near, radius), coefficients))

    def stress_by_faces(self, i: int, side: Side) -> Array | None:
        """Stress along a fillet of tooth i per pair of line forces on these faces, (points, N) [1/m]; None if none."""
        if self._from_middle(i) not in self.openings:
            return None
        kept, name = self.influence.tabulated, f"by faces {i % self.period} {side}"
        if name not in kept:
            kept[name] = self.influence.stress_by_faces(i, side)
        return np.asarray(kept[name])

    @cached_property
    def with_free_faces(self) -> OddCompliance:
        """The same with the root stress of free faces."""
        return replace(self, free=True)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_ij(p, q), zero beyond the reach."""
        teeth = self._odd(i, j)
        if teeth is None or teeth not in self.series:
            return self.ordinary.between(i, j, radius_p, radius_q)
        p, q = (self._share(near, radius) for near, radius in zip(teeth, (radius_p, radius_q), strict=True))
        return chebyshev_over(-1.0, 1.0, p, q, self.series[teeth])

    def _share(self, near: int, radius: ArrayLike) -> Array:
        """Place on the flank of a tooth, from -1 to 1 over its roll length."""
        low, high = self._ends
        if near in self.own_splines:
            high = float(self.own_splines[near].x[-1])
        return np.asarray((self._along(near, radius) - 0.5 * (low + high)) / (0.5 * (high - low)))

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Tangential stress along the fillet of tooth i [1/m], shape (points, Q); zero beyond the reach."""
        teeth, missing = self._odd(i, j), self.influence.fine.missing
        if self._from_middle(i) in missing:  # it has no fillet
            known = self.ordinary.root_stress(i, i, radius_q, side)
            return None if known is None else np.zeros_like(known)
        if self._from_middle(j) in missing:
            return np.zeros_like(self.influence.fillet_stress(i, i, side, self._within(i, radius_q)))
        if teeth is None and self._from_middle(i) not in self.influence.fine.odd:
            return self.ordinary.root_stress(i, j, radius_q, side)
        if teeth is None or abs(i - j) > self.reach:
            return np.zeros_like(self.influence.fillet_stress(i, i, side, self._within(i, radius_q)))
        return self.influence.fillet_stress(i, j, side, self._within(j, radius_q), free=self.free)

    def _within(self, tooth: int, radius: ArrayLike) -> Array:
        """Radii, beyond a shorter tooth's tip that of the tip [m]."""
        r, near = np.asarray(radius, dtype=float), self._from_middle(tooth)
        return np.minimum(r, self.influence.ends(near)[1]) if near in self.influence.fine.odd else r

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:
        """That of the tooth's own solution."""
        if self._odd(i, i) is None or self._from_middle(i) in self.influence.fine.missing:
            return self.ordinary.fillet_curve(i, side)
        return self.influence.fillet_curve(i, side)

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:
        """Estimated error of the largest stress of a fillet of tooth i under a load on tooth j [1/m]."""
        if {self._from_middle(i), self._from_middle(j)} & set(self.influence.fine.missing):
            return np.zeros(np.shape(radius_q))  # no fillet, or no load
        if self._odd(i, j) is None or abs(i - j) > self.reach:
            return self.ordinary.root_stress_error(i, j, radius_q, side)
        known = self.influence.ordinary
        return self.influence.root_stress_error(
            i, j, side, np.clip(radius_q, known.lowest_radius, known.highest_radius)
        )

    def describe(self) -> str:
        """Return what it includes."""
        fine = self.influence.fine
        cracked = [number for number, kind in fine.odd.items() if kind.cracked]
        shorter = [number for number in fine.odd if number not in cracked and fine.patch is None]
        said = [self.ordinary.describe(), *(["keyway"] if fine.patch is not None else [])]
        for numbers, what in ((cracked, "cracked"), (shorter, "shorter"), (fine.missing, "missing")):
            odd = sorted((self.influence.middle + number) % self.period for number in numbers)
            if odd:
                which = f"tooth {odd[0]}" if len(odd) == 1 else f"teeth {', '.join(map(str, odd))}"
                said.append(f"{which} {what}")
        return ", ".join(said)


def odd_compliance(influence: OddGearInfluence) -> OddCompliance:
    """Tabulate the influence functions of a gear with odd teeth, once for each solution."""
    ordinary, kept = finite_element_compliance(influence.ordinary), influence.tabulated
    if "odd" not in kept:
        there = [near for near in influence.touched if near not in influence.fine.missing]
        closing = influence.fine.closing
        own = {near: tabulated_own(influence.alone(near))[0] for near in there}
        by_closing = {near: _by_closing(influence, near, own[near].x) for near in there if closing}
        own |= {near: spline(own[near].x, own[near].y + less.y) for near, less in by_closing.items()}
        moves = [near for near in there if any(abs(near - k) <= ordinary.reach for k in closing)]
        openings = {near: _openings(influence, ordinary, near, own) for near in moves}
        kept["odd"] = own, _series(influence, ordinary, own), by_closing, openings
    return OddCompliance(influence, ordinary, *kept["odd"])


def _by_closing(influence: OddGearInfluence, near: int, lengths: Array) -> Spline:
    """What faces of cracks take away of c_ii of a tooth by closing under its load, over the roll length."""
    radius = np.clip(np.hypot(influence.gear.base_radius, lengths), *influence.ends(near))
    return spline(lengths, influence.by_closing(near, radius))


def _nodes(
    influence: OddGearInfluence, ordinary: FiniteElementCompliance, near: int, own: Mapping[int, Spline]
) -> tuple[Array, Array]:
    """Radii on the flank of a tooth at which functions over it are taken, and the matrix to their series."""
    end = own[near].x[-1] if near in own else ordinary.highest
    return chebyshev_nodes(influence.gear, ordinary.lowest, float(end))


def _openings(
    influence: OddGearInfluence, ordinary: FiniteElementCompliance, near: int, own: Mapping[int, Spline]
) -> Array:
    radii, to_series = _nodes(influence, ordinary, near, own)
    return influence.openings(near, radii) @ to_series.T


def _series(
    influence: OddGearInfluence, ordinary: FiniteElementCompliance, own: Mapping[int, Spline]
) -> dict[tuple[int, int], Array]:
    found = {}
    for i, j in _coupled(influence, ordinary.reach):
        (p, to_series), (q, _) = (_nodes(influence, ordinary, near, own) for near in (i, j))
        first, second = (influence.middle + near for near in (i, j))
        found[i, j] = to_series @ influence.between(first, second, p, q, free=True) @ to_series.T
        found[j, i] = found[i, j].T  # reciprocity, exact for pressure-weighted deflections
    return found


def _coupled(influence: OddGearInfluence, reach: int) -> list[tuple[int, int]]:
    """Pairs i < j of teeth, no farther apart than the reach, that do not answer as ordinary ones do."""
    touched = influence.touched
    known = [near for near in influence.known if near not in influence.fine.missing]
    return [(i, j) for i in known for j in known if 0 < j - i <= reach and j >= touched[0] and i <= touched[-1]]


def odd_shifted_by_error(base: OddCompliance) -> OddCompliance:
    """The source with its loaded teeth softer by the estimated error, its neighbours by what they have of it."""
    ordinary = shifted_by_error(_plain(base))
    known, middle = base.influence, base.influence.middle
    radii = ordinary.radii
    own = {}
    for near, curve in base.own_splines.items():
        error = known.own_error(middle + near, radii, base.reference_half_width(radii))
        at = np.clip(np.hypot(known.gear.base_radius, curve.x), radii[0], radii[-1])
        own[near] = spline(curve.x, curve.y + np.interp(at, radii, error))
    series = {teeth: _raised(found, ordinary.neighbour_error) for teeth, found in base.series.items()}
    return replace(base, ordinary=ordinary, own_splines=own, series=series)


def odd_neighbours_shifted_by_error(base: OddCompliance) -> OddCompliance:
    """The source with its neighbours softer by their estimated error, its loaded teeth by what they have of it."""
    ordinary = neighbours_shifted_by_error(_plain(base))
    known, middle = base.influence, base.influence.middle
    few = np.linspace(ordinary.radii[0], ordinary.radii[-1], _FEW)
    common = float(ordinary.own_error[0])
    own = {near: replace(curve, y=curve.y + common) for near, curve in base.own_splines.items()}
    series = {
        (i, j): _raised(found, float(known.between_error(middle + i, middle + j, few, few).max()))
        for (i, j), found in base.series.items()
    }
    return replace(base, ordinary=ordinary, own_splines=own, series=series)


def _plain(base: OddCompliance) -> FiniteElementCompliance:
    assert isinstance(base.ordinary, FiniteElementCompliance)  # noqa: S101  (for mypy: no source is shifted twice)
    return base.ordinary


def _raised(series: Array, by: float) -> Array:
    """A series whose value is larger everywhere."""
    found = series.copy()
    found[0, 0] += by
    return found
