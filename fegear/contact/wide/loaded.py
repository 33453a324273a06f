"""Loaded flanks: line load, pressure, shares and transmission error of a pair of gears with a width."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.base.shown import shows
from fegear.base.solution_cache import SolutionCache
from fegear.contact.fourier import Panels
from fegear.contact.wide.along_lines import averaged_along, load_below, swept_mean
from fegear.contact.wide.compliance import FlankCompliance, Hertz, flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import BESIDE_EDGE, ContactLines, MissingPart, base_twist, contact_lines, long_line
from fegear.contact.wide.load_sharing import Contact
from fegear.contact.wide.roll_points import roll_points
from fegear.contact.wide.spots import solve_spots
from fegear.contact.wide.tip_edges import edge_reach
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.pair import MEMBERS, GearPair, Member

#: Parts of the face whose loads are distinguished: so long at most [modules], so many at least.
_CELL, _FEWEST_CELLS = 0.5, 4
#: Nearer to a sharp edge than this share of a base pitch is on it.
_ON_EDGE = 1e-6
#: Share of the largest gap of a tip edge from which on it is one of the last.
_LAST = 0.8


@dataclass(frozen=True)
class LoadedFlanks(ReadOnlyArrays):
    """A pair's flanks at P roll positions of one base pitch, under L loads.

    Parameters
    ----------
    pair : GearPair
    known : FlankCompliance
    contact : Contact
    load : ndarray, shape (L,)
        [N], along the transverse line of action.
    seconds : mapping of str to float
    """

    pair: GearPair
    known: FlankCompliance
    contact: Contact
    load: Array
    seconds: Mapping[str, float]

    @property
    def lines(self) -> ContactLines:
        """Stations of all contact lines."""
        return self.known.lines

    @property
    @shows("um", "loaded transmission error along the line of action", name="te")
    def transmission_error(self) -> Array:
        """zeta [m], shape (P, L)."""
        return self.contact.approach

    @property
    def mean_transmission_error(self) -> Array:
        """Mean over a base pitch [m], shape (L,)."""
        return self.lines.mean(self.transmission_error)

    @cached_property
    @shows("N/mm", "total line load (transverse force per face width)", label="line load")
    def line_load(self) -> Array:
        """f at the stations [N/m], transverse force per length along the face, shape (P, M, L).

        Of panels that are short beside a contact's width it is averaged over that width: forces of single stations mean
        nothing there, and alternate where a gap has a kink. Spots, no longer than they are wide, keep theirs.
        """
        support = self.lines.support[:, :, None]
        force = self.contact.force
        load = np.divide(force, support, out=np.zeros_like(force), where=support > 0.0)
        return averaged_along(self.lines, load, None if self.known.spot is not None else self.known.window)

    @cached_property
    @shows("MPa", "maximum pressure of smooth flanks (line contact)", name="hertz_pressure", label="pressure")
    def pressure(self) -> Array:
        """Largest Hertzian pressure at the stations [Pa], shape (P, M, L)."""
        return self.known.pressure(self.line_load)

    @cached_property
    def long(self) -> Mask:
        """Whether stations are on contact lines that are long enough to decide largest values, shape (P, M)."""
        return self.lines.long(long_line(self.pair))

    @cached_property
    def smooth(self) -> Mask:
        """Whether flanks have a largest pressure at the stations: on long lines, clear of tips, form circles, edges."""
        return np.asarray(self.long & self.lines.clear(self.pair, BESIDE_EDGE * self.pair.driver.module))

    @cached_property
    def smooth_pressure(self) -> Array:
        """Pressure at the stations of smooth flanks [Pa], zero elsewhere, shape (P, M, L).

        At a station just beyond their limits stands what it is at the limit, between stations: where these happen to
        stand decides no largest value.
        """
        found = np.where(self.smooth[:, :, None], self.pressure, 0.0)
        apart = self.lines.clearance(self.pair, BESIDE_EDGE * self.pair.driver.module)
        same = (self.lines.panel > 0.0) & self.long[:, 1:]
        before, behind = (slice(None), slice(None, -1)), (slice(None), slice(1, None))
        for inner, outer in ((before, behind), (behind, before)):
            at = same & self.smooth[inner] & ~self.smooth[outer] & (apart[outer] < 0.0)
            near, far = (np.where(at, apart[one], end) for one, end in ((inner, 0.0), (outer, -1.0)))
            share = near / (near - far)
            load, factor = (
                one[inner] + (share[..., None] if one.ndim > 2 else share) * (one[outer] - one[inner])
                for one in (self.line_load, self.known.width_factor)
            )
            limit = 2.0 / np.pi * np.sqrt(load / np.where(at, factor, 1.0)[..., None])
            found[outer] = np.where(at[..., None], np.maximum(found[outer], limit), found[outer])
        return found

    @cached_property
    def bounded_line_load(self) -> Array:
        """Line load on long lines [N/m], zero at ends at tips or form circles, where panels bound it, (P, M, L)."""
        bounded = self.smooth
        if self.lines.edges is not None:  # on tip edges line loads are finite
            on_path = (self.lines.edges.gap == 0.0) & (self.lines.edges.tilt < -_ON_EDGE * self.pair.base_pitch)
            bounded = self.long & ~(self.lines.at_edge & on_path)
        return np.asarray(np.where(bounded[:, :, None], self.line_load, 0.0))

    @cached_property
    def largest_line_loads(self) -> Array:
        """At each roll position [N/m], shape (P, L), see `bounded_line_load`."""
        return np.asarray(self.bounded_line_load.max(axis=1))

    @cached_property
    def largest_pressures(self) -> Array:
        """Hertzian at each roll position [Pa], shape (P, L), see `smooth_pressure`."""
        return np.asarray(self.smooth_pressure.max(axis=1))

    @property
    def largest_line_load(self) -> Array:
        """Of all roll positions [N/m], shape (L,)."""
        return np.asarray(self.largest_line_loads.max(axis=0))

    @property
    def largest_pressure(self) -> Array:
        """Of all roll positions [Pa], shape (L,)."""
        return np.asarray(self.largest_pressures.max(axis=0))

    @property
    def reaches_the_last_edges(self) -> bool:
        """Whether tip edges are loaded that are as far from their mates as contact lines go on: to be continued."""
        edges = self.lines.edges
        if edges is None:
            return False
        far = edges.gap > _LAST * edges.gap[self.lines.present].max()
        return bool((self.contact.force * (far & (edges.gap > 0.0))[:, :, None]).any())

    @property
    def pair_numbers(self) -> Array:
        """j of all pairs that are ever in reach, ascending."""
        return np.unique(self.lines.pair[self.lines.present])

    @cached_property
    def pair_load(self) -> Array:
        """W_j [N], shape (pairs, P, L)."""
        on = [(self.lines.pair == j) & self.lines.present for j in self.pair_numbers.tolist()]
        return np.stack([(self.contact.force * here[:, :, None]).sum(axis=1) for here in on])

    @property
    @shows("", "load of one tooth pair", name="largest_share")
    def share(self) -> Array:
        """W_j / W, shape (pairs, P, L)."""
        return self.pair_load / self.load

    @property
    @shows("", "equilibrium residual: (sum of forces - load) / load")
    def equilibrium(self) -> Array:
        """|sum of all forces - load| / load, shape (P, L)."""
        return np.abs(self.contact.force.sum(axis=1) - self.load) / self.load

    @cached_property
    def cells(self) -> Array:
        """Ends of equal parts of the face over which load is summed, shape (cells + 1,) [m]: half a module, or less.

        Neither panels nor roll positions change them, and half a module is longer than what both do to a mean.
        """
        lines = self.lines
        count = max(_FEWEST_CELLS, math.ceil((lines.high - lines.low) / (_CELL * self.pair.driver.module) - 1e-6))
        return np.linspace(lines.low, lines.high, count + 1)

    @cached_property
    @shows("N/mm", "over all mesh positions", label="line load")
    def over_face(self) -> Array:
        """Load of all lines together per face width, averaged over each of `cells`, shape (P, cells, L) [N/m]."""
        return self.load_between(self.cells)

    def load_between(self, ends: Array) -> Array:
        """The same between any heights, shape (P, n - 1, L) [N/m]."""
        lines = self.lines
        total = np.zeros((lines.roll.size, ends.size, self.load.size))
        for p in range(lines.roll.size):
            for s in lines.at(p):
                total[p] += load_below(lines.z[p, s], self.line_load[p, s], ends)
        return np.asarray(np.diff(total, axis=1) / np.diff(ends)[:, None])

    def mean_between(self, ends: Array) -> Array:
        """The same averaged over a base pitch, shape (n - 1, L) [N/m]: see `fegear.contact.wide.load_factors`."""
        swept = swept_mean(self.lines, self.line_load, ends, self.pair.base_pitch)
        return np.asarray(swept / np.diff(ends)[:, None])

    @cached_property
    @shows("N/mm", "total over all tooth pairs, mean over a base pitch", name="mean_line_load")
    def mean_over_face(self) -> Array:
        """Load over each of `cells` averaged over a base pitch, shape (cells, L) [N/m]."""
        return self.mean_between(self.cells)

    @property
    def face_load_factor(self) -> Array:
        """K_Hbeta, shape (L,): largest load per face width over the mean one, averaged over a base pitch.

        ISO 6336-1, 7.2: (F / b)_max / (F_m / b).
        """
        return np.asarray(self.mean_over_face.max(axis=0) / (self.load / (self.lines.high - self.lines.low)))

    def over_plane(self, x: Array, z: Array, case: int) -> Array:
        """Line load of a tooth pair as its contact line moves through the plane of action, shape (z, x) [N/m].

        Straight between the roll positions; NaN before the first and after the last of them.

        Parameters
        ----------
        x, z : ndarray
            Along the line of action and along the face [m].
        case : int
            Number of the load.
        """
        return self.spread(x, z, self.line_load[:, :, case])

    def spread(self, x: Array, z: Array, values: Array) -> Array:
        """The same of anything that is known at the stations, shape (P, M)."""
        lines, slope = self.lines, base_twist(self.pair)
        seen = [(float(lines.roll[p] + lines.pair[p, s.start] * self.pair.base_pitch), p, s)
                for p in range(lines.roll.size) for s in lines.at(p)]  # fmt: skip
        seen.sort(key=lambda found: found[0])
        ends = [self._along_edge(x_end, values) for x_end in (self.pair.x_start, self.pair.x_end)]
        # Of every contact line, then of both edges beyond the last roll position that brings a line up to a height.
        at = np.array([*([roll] * z.size for roll, _, _ in seen), *(x + slope * z for x in
                       (self.pair.x_start, self.pair.x_end))])  # fmt: skip
        known, there = np.zeros(at.shape), np.zeros(at.shape, dtype=bool)
        for row, on, (_, p, s) in zip(known, there, seen, strict=False):
            own = lines.z[p, s]
            row[:], on[:] = np.interp(z, own, values[p, s]), (own[0] <= z) & (z <= own[-1])
        for row, on, (heights, of_edge) in zip(known[len(seen) :], there[len(seen) :], ends, strict=True):
            if heights.size:
                row[:], on[:] = np.interp(z, heights, of_edge), True
        found = np.full((z.size, x.size), np.nan)
        for row, height in enumerate(z.tolist()):
            place, value = at[there[:, row], row], known[there[:, row], row]
            if place.size > 1:
                order = np.lexsort((value, place))
                found[row] = np.interp(x + slope * height, place[order], value[order], left=np.nan, right=np.nan)
        return found

    def _along_edge(self, x: float, values: Array) -> tuple[Array, Array]:
        """Heights at which contact lines end on the tip or form circle at x, ascending, and the values there."""
        lines = self.lines
        on = lines.present & lines.at_edge & (np.abs(lines.x - x) < 1e-6 * self.pair.base_pitch)
        order = np.argsort(lines.z[on])
        return lines.z[on][order], values[on][order]


#: Matrices that a pair keeps: four for itself, four for its error, as many for other effects.
_KEPT = 16


@dataclass(frozen=True)
class FlankPair:
    """A pair of gears with a width, ready to be loaded.

    Parameters
    ----------
    pair : GearPair
    gears : mapping of {"driver", "driven"} to FlankBody
    coupling : bool
        Whether tooth pairs deflect each other.
    hertz : {"load-dependent", "linear", "none"}
    panel : float
        Length of a panel along the face, at most [modules].
    positions : int
        Roll positions over one base pitch.
    most_gap : float
        Contact lines go on along tip edges up to this distance from the mate's flank [m]; 0 for lines that end there.
    missing : tuple of MissingPart
        Of flanks of single teeth: panels end where these do.
    cache : SolutionCache
        Where what gaps and loads do not change is recalled from and kept; by default a memory of this pair's own.
    progress : callable or None
        Receives the fraction of every `solve` that is done.
    """

    pair: GearPair
    gears: Mapping[Member, FlankBody]
    coupling: bool = True
    hertz: Hertz = "load-dependent"
    panel: float = 0.5
    positions: int = 16
    most_gap: float = 0.0
    missing: tuple[MissingPart, ...] = ()
    cache: SolutionCache = field(default_factory=partial(SolutionCache, most=_KEPT), compare=False, repr=False)
    progress: Callable[[float], None] | None = field(default=None, compare=False, repr=False)

    @property
    def points(self) -> Panels:
        """Roll positions and their weights over a base pitch, for means and Fourier series: see `roll_points`."""
        return roll_points(self.pair, self.positions, edge_reach(self.pair, self.most_gap))

    @property
    def roll(self) -> Array:
        """Roll positions [m]."""
        return self.points.x

    def compliance(self, load: float, roll: Array | None = None, cycle: int = 0) -> FlankCompliance:
        """Lines and compliances at all roll positions, or at those given; see `flank_compliance` for `load`, `cycle`.

        Recalled where they are known: changed gaps change nothing of them.
        """
        for member in MEMBERS:
            if self.gears[member].reach == 0 and self.coupling:
                raise InputError("reach", 0, "includes no neighbouring teeth", "solve the gears with reach >= 1")
        if roll is not None:  # places between these, which the next gaps move
            return _compliance(self, load, cycle, roll)
        every = math.lcm(*(self.gears[member].period for member in MEMBERS))
        return self.cache.call(_compliance, self, load, cycle % every).value

    def solve(
        self, load: ArrayLike, gaps: FlankGaps | None = None, known: FlankCompliance | None = None
    ) -> LoadedFlanks:
        """Load the flanks.

        Parameters
        ----------
        load : array_like, shape (L,)
            Along the transverse line of action [N].
        gaps : FlankGaps, optional
        known : FlankCompliance, optional
            What `compliance` gave: the same for all gaps of a base pitch, of all where all teeth are alike, and for
            all loads about the one it was made for.

        Returns
        -------
        LoadedFlanks

        Raises
        ------
        InputError
            If a load is not positive.
        """
        started = time.perf_counter()
        loads = np.atleast_1d(np.asarray(load, dtype=float))
        if not (np.isfinite(loads) & (loads > 0.0)).all():
            raise InputError("load", f"{loads.min()} N", "must be positive and finite")
        gaps = gaps or FlankGaps()
        known = self.compliance(float(loads.max()), cycle=gaps.base_pitch) if known is None else known
        assembled = time.perf_counter()
        with one_thread(with_scipy=False):
            apart = gaps.at(self.pair, known.lines, loads)
            known, contact = solve_spots(known, apart, loads, self.progress)
        seconds = {"compliance": assembled - started, "contact": time.perf_counter() - assembled}
        return LoadedFlanks(self.pair, known, contact, loads, seconds)


def _compliance(flanks: FlankPair, load: float, cycle: int, roll: Array | None = None) -> FlankCompliance:
    if roll is None:
        points = flanks.points
        roll, weight = points.x, points.weights / points.period
    else:
        weight = np.empty(0)
    panel = flanks.panel * flanks.pair.driver.module
    lines = contact_lines(flanks.pair, roll, panel, weight, flanks.most_gap, flanks.missing)
    with one_thread(with_scipy=False):
        return flank_compliance(
            flanks.pair, flanks.gears, lines, load, coupling=flanks.coupling, hertz=flanks.hertz, cache=flanks.cache,
            cycle=cycle,
        )  # fmt: skip
