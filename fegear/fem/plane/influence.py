"""Influence functions of a gear's teeth, from one factored ring; dimensionless (module 1, Young's modulus 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

from fegear.fem.plane.contact_width import (
    POINT,
    REFERENCE_HALF_WIDTH,
    check_half_widths,
    corner_angles,
    curvature_slope,
    log_slope,
    wedge_slope,
)
from fegear.fem.plane.rim import PinForces
from fegear.fem.plane.root_stress import FilletCurve, FilletStrain, contact_width
from fegear.fem.plane.sector_rows import SectorRows
from fegear.fem.plane.trace import LoadedFlank

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike
    from scipy.sparse import csr_array

    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_side import InvoluteSide
    from fegear.geometry.rim_support import RimSupport

T = TypeVar("T")
Side = Literal["tension", "compression"]
SIDES: tuple[Side, ...] = ("tension", "compression")
#: The narrower of the two pressures that load the mesh, as a share of the wider one.
_NARROWER = 0.6
#: A load far away is a mixture of pressures of these widths, in shares of the widest one, whose moments of second and
#: fourth order vanish: those go with width^2 and width^4, so the parts are those of the polynomial in width^2 through
#: three values at width 0 (Richardson). What the width moves elsewhere goes with its sixth power.
_REMOTE_WIDTHS = np.array([1.0, 0.5, 0.25])
_REMOTE_PARTS = np.array([1.0, -20.0, 64.0]) / 45.0
#: No pressure reaches over the start of the flank, where the outline's curvature jumps; the nearest one is as wide as
#: this [modules].
_NARROWEST = 1e-6
#: The wider pressure takes this share of the room to the nearest corner or curvature jump: what the corner does to it
#: goes with the square of that share, which is taken out, and then with higher powers of it.
ROOM_SHARE = 0.7
#: Where neighbours give way by so much of what the loaded tooth does, most of it is the gear that turns on its bore.
MOSTLY_TURNED = 0.8
#: From how far beside the tip on a true contact keeps to Hertz's pressure [modules]: there the mating flank stiffens as
#: fast as this one softens.
_BESIDE_TIP = 0.15
#: How far down the flank its compliance is compared, at most [modules] and as a share of the distance from the tip.
_STEP, _STEP_SHARE = 0.05, 0.25
#: Loads at so many sets of places are kept: errors are asked for at a contact's own place and at samples in turn.
_KEPT = 4
#: Mean distance of two points of a semi-elliptic pressure over its half-width.
_MEAN = 256.0 / (45.0 * np.pi**2)


@dataclass(frozen=True)
class Influence:
    """c_k(p, q) and root-stress influence of one gear shape, ready for any position and contact width.

    Parameters
    ----------
    tooth : InvoluteSide
    poisson_ratio : float
    plane : {"strain", "stress"}
    mesh : SectorMesh
    flank : LoadedFlank
    compliance : mapping of int to ndarray, shape (2n, 2n)
        Displacements of the loaded run of tooth k under forces on tooth 0's run.
    fillets : mapping of {"tension", "compression"} to FilletStrain
    stress : mapping of (int, side) to ndarray, shape (points, 2n)
        Tangential fillet stress of tooth k under forces on tooth 0's run.
    corner_distance : float
        Nearer than this to a corner of the flank the exact wedge gives c_0; the narrowest pressure that loads the
        mesh [modules].
    reach : int
        K: neighbours -K..K are known. Tooth k = +1 lies clockwise of tooth 0, on the side that the load comes from.
    unknowns : int
        Size of the sector's system.
    seconds : mapping of str to float
    lower : Influence, optional
        The same on the same mesh with elements one order lower, which shows the error.
    pins : PinForces, optional
        Of a ring on pins what differs from tooth to tooth (`tooth_on_pins`); `compliance` and `stress` are means.
    support : RimSupport, optional
        What carries the rim; by default the whole bore, or outer circle of a ring gear, is held.
    rows : SectorRows, optional
        Its sector by itself, for a ring with odd teeth; not of what comes back from a file.
    """

    tooth: InvoluteSide
    poisson_ratio: float
    plane: Plane
    mesh: SectorMesh
    flank: LoadedFlank
    compliance: Mapping[int, Array]
    fillets: Mapping[Side, FilletStrain]
    stress: Mapping[tuple[int, Side], Array]
    corner_distance: float
    reach: int
    unknowns: int
    seconds: Mapping[str, float] = field(compare=False)
    lower: Influence | None = None
    pins: PinForces | None = None
    support: RimSupport | None = None
    rows: SectorRows | None = field(default=None, compare=False, repr=False)

    @property
    def log_slope(self) -> float:
        """See `log_slope`."""
        return log_slope(self.poisson_ratio, self.plane)

    def place(self, radius: ArrayLike, half_width: ArrayLike) -> tuple[Array, Array]:
        """Arc position and half-width of contacts at `radius`, shape (P,) each [modules].

        A contact that reaches past a corner of the flank stands where it just ends there.

        Raises
        ------
        RangeError
            If no flank holds such a contact (`check_half_widths`).
        """
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        width = np.broadcast_to(np.asarray(half_width, dtype=float), arc.shape)
        return self._placed(arc, width), width

    def _placed(self, arc: Array, width: Array) -> Array:
        """Arc positions as of `place`."""
        low, high = self.flank.flank_start, self.flank.flank_end
        check_half_widths(width, np.minimum(arc - low, high - arc))
        arc = np.minimum(arc, high - np.maximum(width - self.flank.beyond, 0.0))
        if self.flank.lower_corner:
            arc = np.maximum(arc, low + width)
        return arc

    def remote(self, radius: ArrayLike, patch: float, share: float = 1.0) -> Array:
        """Loads in their exact place for effects away from the contact, where a narrow patch needs no resolution.

        The last ones are kept: both neighbours are asked for at the same radii. With a share their pressures are so
        much narrower, beside the flank's ends as well.
        """
        r = np.asarray(radius, dtype=float)

        def loads() -> Array:
            found = self._remote_at(np.atleast_1d(self.flank.arc_of_radius(r)), patch, share)
            found.flags.writeable = False
            return found

        return self._kept("remote", (r.tobytes(), patch, share), loads)

    def _remote_at(self, arc: Array, patch: float, share: float = 1.0) -> Array:
        room = np.minimum(arc - self.flank.flank_start, self.flank.flank_end - arc)
        low = max(self.flank.arc[0] + POINT, self.flank.flank_start + _NARROWEST)
        high = self.flank.arc[-1] - POINT
        # Pressures in such a mixture that second and fourth moment vanish: a concentrated load, seen from afar.
        wide = np.maximum(share * np.minimum(patch, room), _NARROWEST)
        count = len(_REMOTE_WIDTHS)
        loads = self.flank.patches(np.tile(np.clip(arc, low, high), count), np.outer(_REMOTE_WIDTHS, wide).ravel())
        return np.asarray(_REMOTE_PARTS @ loads.reshape(loads.shape[0], count, arc.size))

    def fillet_loads(self, radius: ArrayLike, half_width: ArrayLike) -> tuple[csr_array, Array, Array]:
        """Loads for the stress in the fillet, how far above it they stand and their half-width.

        In their exact place, for it decides about the bending; narrowed where they would reach past an end of the
        flank, for nothing presses on a fillet. The last ones are kept: all teeth and both fillets are asked for at the
        same radii.
        """
        r, half = np.atleast_1d(np.asarray(radius, dtype=float)), np.asarray(half_width, dtype=float)

        def loads() -> tuple[csr_array, Array, Array]:
            arc = np.atleast_1d(self.flank.arc_of_radius(r))
            above = arc - self.flank.flank_start
            width = contact_width(half, above, self.flank.flank_end - arc)
            low, high = self.flank.arc[0] + POINT, self.flank.arc[-1] - POINT
            return self.flank.few_patches(np.clip(arc, low, high), width), above, width

        return self._kept("fillet", (r.tobytes(), half.tobytes()), loads)

    def _kept(self, kind: str, key: object, make: Callable[[], T]) -> T:
        """What was made for one of the last keys of its kind, or is made now."""
        known = self._last.get(kind, {})
        if key in known:
            found: T = known[key]
            return found
        made = make()
        self._last[kind] = {**dict([*known.items()][1 - _KEPT :]), key: made}
        return made

    @cached_property
    def _last(self) -> dict[str, dict[object, Any]]:
        return {}

    def self_compliance(self, radius: ArrayLike, patch: float, half_width: ArrayLike | None = None) -> Array:
        """Deflection of a contact under its own unit line load, shape (P,) [1/E].

        Parameters
        ----------
        radius : array_like, shape (P,)
            [modules].
        patch : float
            Half-width of the wider of the two pressures that load the mesh [modules].
        half_width : array_like, optional
            Half-width of the true contact [modules], by default `patch`; broadcast against `radius`.

        Notes
        -----
        The deflection is the pressure-weighted mean over the contact plus `log_slope` / 4, by which Hertz's centre
        lies deeper than it: the approach of two bodies in contact, for the gap that closes is as deep as that,
        weighted with the pressure. Unlike the deflection of one point it is reciprocal, and it converges at twice
        the order.

        What depends on the width of a narrow contact is known in closed form: the half-plane's logarithm and, on a
        flank of curvature 1/rho, `curvature_slope` times width / rho. What is left varies with the square of the
        width; two pressures that the mesh resolves give that, and the value at the true width follows. Nearer to a
        corner than `corner_distance` the exact wedge says how the deflection grows.
        """
        wanted = np.asarray(patch if half_width is None else half_width, dtype=float)
        if wanted.ndim > 1:  # several widths at every radius
            at, widths = np.broadcast_arrays(np.asarray(radius, dtype=float), wanted)
            return self.self_compliance(at.ravel(), patch, widths.ravel()).reshape(at.shape)
        return self._deflection(*self.place(radius, wanted), patch)

    def contact(self, radius: ArrayLike, patch: float, half_width: ArrayLike) -> tuple[Array, Array]:
        """`self_compliance`, and how much less a true contact beside the tip gives way, shape (P,) each [1/E].

        Towards the tip a tooth grows softer, so a convex body pressed on it carries more of its load below the place
        where it was aimed at, and gives way less. With c' the slope of c_0 and R the body's radius, the load W moves by
        u = c' W R / 2 beside which the approach is c_0 - c' u + u^2 / (2 R W): 3/8 c'^2 R W less, R W from Hertz.

        Parameters
        ----------
        radius, patch, half_width
            As for `self_compliance`.
        """
        arc, width = self.place(radius, half_width)
        end = self.flank.flank_end + self.flank.beyond
        off = np.maximum(end - arc, width)
        step = np.minimum(_STEP_SHARE * off, _STEP)
        below = np.maximum(arc - step, self.flank.flank_start + np.minimum(width, 0.5 * (arc - self.flank.flank_start)))
        both = np.concatenate([arc, self._placed(below, width)]), np.concatenate([width, width])
        at, lower = np.split(self._deflection(*both, patch), 2)
        slope = (at - lower) / np.maximum(arc - below, POINT)
        return at, np.asarray(0.1875 * slope**2 * width**2 / self.log_slope / (1.0 + (off / _BESIDE_TIP) ** 2))

    def _deflection(self, arc: Array, width: Array, patch: float) -> Array:
        """`self_compliance` of contacts as they were placed: these, and those that stand for some, are loaded at once.

        Nearer to a corner than the mesh resolves scaled contacts on a wedge differ by a logarithm alone. What is left
        of first order in the distance follows from contacts at once and twice the corner distance.
        """
        d, beside = self.corner_distance, []
        places, widths = [arc], [width]
        for corner, inward, angle in self._corners:
            near = np.flatnonzero(inward * (arc - corner) < d)
            distance = np.maximum(inward * (arc[near] - corner), 1e-6 * d)
            beside.append((near, distance / d, angle))
            for n in (1.0, 2.0):
                places.append(np.full(near.shape, corner + inward * n * d))
                widths.append(n * d * width[near] / distance)
        regular, *others = np.split(
            self._regular(np.concatenate(places), np.concatenate(widths), patch),
            np.cumsum([one.size for one in places[:-1]]),
        )
        for (near, share, angle), once, twice in zip(beside, others[::2], others[1::2], strict=True):
            slope = (wedge_slope(angle) - 2.0 / np.pi) * self.log_slope * np.pi / 2.0
            regular[near] = once - slope * np.log(share) + (share - 1.0) * (twice - once + slope * np.log(2.0))
        bend = self.curvature_slope * _MEAN * self._curvature(arc)
        return regular - self.log_slope * np.log(width) + bend * width

    @property
    def _corners(self) -> list[tuple[float, float, float]]:
        """Arc position, direction into the flank and angle of the flank's corners."""
        lower, upper = corner_angles(self.tooth)
        found = [(self.flank.flank_start, 1.0, lower)] if self.flank.lower_corner else []
        # A tip rounded by less than the corner distance is a corner still.
        if self.flank.beyond < self.corner_distance:
            found.append((self.flank.flank_end + self.flank.beyond, -1.0, upper))
        return found

    def _regular(self, arc: Array, width: Array, patch: float) -> Array:
        """What contacts leave of c_0 beside what depends on their width in closed form, shape (P,)."""
        room = np.minimum(arc - self.flank.flank_start, self.flank.flank_end - arc)
        wide = np.maximum(np.minimum(patch, ROOM_SHARE * room), self.corner_distance)
        wide = np.maximum(wide, width)
        narrow = _NARROWER * wide
        places, widths = np.concatenate([arc, arc]), np.concatenate([wide, narrow])
        loads = self.flank.patches(places, widths)
        if self._far is None:
            mean = np.einsum("ip,ip->p", loads, self.compliance[0] @ loads)
        else:
            remote = self._remote_at(arc, patch)
            mean = np.einsum("ip,ip->p", loads, (self.compliance[0] - self._far) @ loads)
            mean += np.tile(np.einsum("ip,ip->p", remote, self._far @ remote), 2)
        bend = self.curvature_slope * _MEAN * np.tile(self._curvature(arc), 2) * widths
        both = mean + self.log_slope * (0.25 + np.log(widths)) - bend
        by_wide, by_narrow = both[: arc.size], both[arc.size :]
        return np.asarray(by_narrow + (by_wide - by_narrow) * (width**2 - narrow**2) / (wide**2 - narrow**2))

    @cached_property
    def _far(self) -> Array | None:
        """What the loaded tooth has in common with its neighbours, where that is most of what gives way; else None.

        On a small bore the gear turns as a whole by up to a million times what its teeth deflect. A pressure beside the
        flank's start reaches past it, where its arm about the axis is another: there that counts for loads in their
        exact place, as a neighbour feels them, or the difference, which shares the load between teeth, is lost.
        """
        if not self.reach:
            return None
        flank = self.flank
        middle = np.array([0.5 * (flank.flank_start + flank.flank_end)])
        load = flank.patches(middle, np.array([ROOM_SHARE * 0.5 * (flank.flank_end - flank.flank_start)]))[:, 0]
        own, beside = (float(load @ self.compliance[k] @ load) for k in (0, 1))
        return 0.5 * (self.compliance[1] + self.compliance[1].T) if beside > MOSTLY_TURNED * own else None

    @property
    def curvature_slope(self) -> float:
        """See `curvature_slope`."""
        return curvature_slope(self.poisson_ratio, self.plane)

    def _curvature(self, arc: Array) -> Array:
        """Curvature of the flank, no nearer to its start than the corner distance, shape (P,) [1/module].

        Negative on the hollow flank of an internal tooth.
        """
        inside = np.maximum(arc - self.flank.flank_start, self.corner_distance) + self.flank.flank_start
        run = self.flank.arc[self.flank.first_flank_edge : self.flank.after_flank_edge + 1]
        roll = self.flank.side * np.sqrt(np.interp(inside, run, self.flank.roll_squared))
        return np.asarray(1.0 / (self.flank.base_radius * roll))

    def mean_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 straight from a pressure as wide as the contact itself, as far as the mesh resolves it: a check."""
        arc, width = self.place(radius, half_width)
        loads = self.flank.patches(arc, width)
        return np.asarray(np.einsum("ip,ip->p", loads, self.compliance[0] @ loads)) + 0.25 * self.log_slope

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike, patch: float, share: float = 1.0) -> Array:
        """c_k(p, q): deflection at p of tooth k under a unit line load at q of tooth 0, shape (P, Q) [1/E].

        Weighted with the pressure of a contact at p, so that c_k(p, q) = c_-k(q, p) to round-off. With a share by
        pressures so much narrower.
        """
        return self.remote(radius_p, patch, share).T @ self.compliance[k] @ self.remote(radius_q, patch, share)

    def fillet_stress(
        self, k: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> Array:
        """Tangential stress along a fillet of tooth k per unit line load at q of tooth 0, shape (points, Q) [1/module].

        The tension fillet is the one below the loaded flank.
        """
        loads = self.fillet_loads(radius_q, half_width)[0]
        return np.ascontiguousarray((loads @ self.stress[k, side].T).T)

    def largest_root_stress(
        self, k: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> tuple[Array, Array]:
        """Largest tension (or compression) of a fillet and the arc length where it sits, shape (Q,) each.

        That of the whole fillet, up to the start of the flank, but no nearer than .05 modules to the contact's edge;
        of a fillet that this would leave less than half of, that of its lower half (`search_end`).
        """
        return self.fillet_curve(side).largest_below(*self.stress_below((k,), side, radius_q, half_width))

    def stress_below(
        self, teeth: Sequence[int], side: Side, radius_q: ArrayLike, half_width: ArrayLike
    ) -> tuple[Array, Array, Array]:
        """Stress along the fillets of teeth, beside how far above them contacts stand, infinitely on other flanks.

        Returns
        -------
        stress : ndarray, shape (points, K Q)
            Tooth after tooth [1/module].
        above, width : ndarray, shape (K Q,)
            And half-widths of the contacts [modules].
        """
        loads, above, width = self.fillet_loads(radius_q, half_width)
        stress = np.concatenate([(loads @ self.stress[k, side].T).T for k in teeth], axis=1)
        far = np.full(above.shape, math.inf)
        beside = [above if k == 0 and side == "tension" else far for k in teeth]
        return stress, np.concatenate(beside), np.tile(width, len(teeth))

    def fillet_curve(self, side: Side, module: float = 1.0) -> FilletCurve:
        """Where the largest stress of a fillet is looked for, radii and places in the unit of the module given."""
        fillet, flank = self.fillets[side], self.flank
        ends = float(flank.roll_squared[0]), float(flank.roll_squared[-1])
        return FilletCurve(side, fillet.arc, fillet.length, flank.base_radius, ends, module)
