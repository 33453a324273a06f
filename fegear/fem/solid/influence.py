"""Influence functions of one gear with a width, with their error estimate and the seconds that they took."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Mask
from fegear.base.plain import pack, read_only, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.fem.plane.bore import check_bore
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.influence import Side
from fegear.fem.plane.root_stress import curves_apart
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import shape_codec
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.bands import Bands, hats
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.holed_teeth import HoledRing, HoledTeeth
from fegear.fem.solid.settings import SolidSettings, check_solid, whole
from fegear.fem.solid.slice_laws import missed_by_slices
from fegear.fem.solid.slices import solver_of
from fegear.fem.solid.solution import SolidSolution
from fegear.fem.solid.tooth_over_holes import as_if_all_were
from fegear.fem.solid.uneven_teeth import UnevenTeeth
from fegear.geometry.gear_body import GearBody, WebHoles
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.rim_support import RimSupport

#: What a solution consists of, for those that keep it.
_KINDS = (
    SolidSolution, FaceFunctions, LoadedFlank, SolidFillet, SolidSettings, MeshSettings, GearBody, WebHoles,
    RimSupport, UnevenTeeth, HoledTeeth, HoledRing,
)  # fmt: skip
#: Where errors are looked for: contact lines through these shares of the flank's length in the middle of the face,
#: where they stay off its ends by a share of it; root tension of what stands above another share.
_UP, _FOOT, _ABOVE_FOOT = (0.12, 0.3, 0.5, 0.7, 0.88), 0.07, 0.35
#: Parts of the difference from the coarser solution, whose edges are longer by a factor of 1.35, that are taken for the
#: largest error of the finer one over flank and face. Neighbours see the body, which has almost as few edges in both.
_SHARES = {"contact": 1.0, "neighbour": 4.0, "root_tension": 1.0, "root_compression": 1.0}
#: The same of single entries, where no largest difference stands in for one that is small by chance: of errors that go
#: with the power 1.7 of the edges, and of stress, whose goes with the first, but of which the worst along the face is
#: taken (`curves_apart`); of neighbours less than what largest ones count, which was 8 times the true errors of gears
#: on a web (33 teeth at 35 degrees need 2.2).
_ENTRY_SHARES = {"contact": 1.5, "neighbour": 2.5, "root_tension": 1.5, "root_compression": 1.5}
#: What of it differs for spur gears, whose loads press on all of a line that lies across the section: of seven on a web
#: and two discs contacts err by at most 1.05, neighbours by 0.53 and compression by 0.78 times these parts; of a wide
#: helical gear a contact errs by more than the usual part at one place.
_OF_SPUR_GEARS = {"contact": 1.0, "neighbour": 1.25, "root_compression": 1.0}
#: Where the coarser solution's elements are an order lower on edges as long, the finer one's deflections err by far
#: less of what it changes: on two gears on a web by at most 0.14 and 0.35 times these parts.
_OF_ANOTHER_ORDER = {"contact": 0.3, "neighbour": 1.0}
#: Of the largest root stress, above which the curve along the face is compared: what two solutions differ by where
#: stress is lower does not reach the largest.
BESIDE_LARGEST = 0.9
#: Both fillets have one shape and edges as long: relatively the one errs by no less than this part of what the other
#: does, should two solutions agree by chance (compression of a gear on a web was 1.94 times the stated error off).
OF_OTHER_FILLET = 0.5
#: Stations along them: so far apart [modules], so many steps at most.
_STATION, _MOST_STATIONS = 0.5, 24


def _errors(data: bytes | memoryview) -> dict[str, float] | None:
    found = unpack(data)
    return found if isinstance(found, dict) else None


#: Errors as they are kept on disk.
_ERRORS: Codec[dict[str, float]] = Codec(pack, _errors)


@dataclass(frozen=True)
class SolidInfluence:
    """c_k(s, z; s', z') and fillet stress of a solid gear; lengths in modules, E = 1.

    Deflections are approaches along the transverse line of action; forces are the transverse components of what the
    flank carries. A deflection in metres is that number times force / (E module); a stress in pascal that number times
    force / module^2.

    Parameters
    ----------
    fine : SolidSolution
        The solution that every number comes from.
    coarse : SolidSolution or None
        A cheaper one whose difference shows the error of `fine`.
    seconds : mapping of str to float
    known_error : mapping of str to float or None
        What `error` found before, for the same solutions.
    """

    fine: SolidSolution
    coarse: SolidSolution | None
    seconds: Mapping[str, float] = field(compare=False)
    known_error: Mapping[str, float] | None = field(default=None, compare=False)

    @property
    def settings(self) -> SolidSettings:
        """What `fine` was solved with."""
        return self.fine.settings

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside the loaded one are known."""
        return self.fine.reach

    @property
    def width(self) -> float:
        """Face width [modules]; the face runs from -width / 2 to width / 2."""
        return self.fine.width

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts [modules]."""
        return self.fine.flank.lowest_radius

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends [modules]."""
        return self.fine.flank.highest_radius

    def band_half_width(self, radius: ArrayLike) -> Array:
        """Half-width of a pressure that the section resolves, shape (P,) [modules]: less beside the flank's ends."""
        return self.fine.band_half_width(radius)

    def deflection(self, k: int, watched: Bands, pressed: Bands) -> Array:
        """c_k of pressed bands: see `SolidSolution.deflection`."""
        return self.fine.deflection(k, watched, pressed)

    def contact_compliance(self, radius: ArrayLike, stations: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 between contacts of Hertzian width along one contact line, shape (P, P) [1/(E module)].

        Parameters
        ----------
        radius : array_like, shape (P,)
            Where the line stands on the flank at its stations [modules].
        stations : array_like, shape (P,)
            Along the face, ascending; the load falls linearly from each to its neighbours [modules].
        half_width : array_like, shape (P,) or ()
            Of the contacts, across the line [modules].

        Returns
        -------
        ndarray
            Approach along the transverse line of action per unit transverse force: see `contact.line_compliance`.
        """
        return line_compliance(self.fine, contact_line(self.fine, radius, stations), half_width)

    def contact_error(self, radius: ArrayLike, stations: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `contact_compliance`, entry by entry: by what the coarser solution makes of it."""
        if self.settings.source == "slices":
            known = self.contact_compliance(radius, stations, half_width)
            own = np.sqrt(np.diagonal(known))
            return np.asarray(self.error["contact"] * np.multiply.outer(own, own))
        if self.coarse is None:
            return np.full((np.size(radius), np.size(radius)), np.nan)
        other = line_compliance(self.coarse, contact_line(self.coarse, radius, stations), half_width)
        return self.entry_shares["contact"] * np.abs(self.contact_compliance(radius, stations, half_width) - other)

    @property
    def entry_shares(self) -> Mapping[str, float]:
        """Parts of what the coarser solution changes that are the error of single entries, by the names of `error`."""
        orders = {one.settings.section.order for one in (self.fine, self.coarse) if one is not None}
        if len(orders) > 1:
            return _ENTRY_SHARES | _OF_ANOTHER_ORDER
        return _ENTRY_SHARES | (_OF_SPUR_GEARS if self.fine.base_twist == 0.0 else {})

    def fillet_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> Array:
        """Surface stress of a fillet: see `SolidSolution.fillet_stress`."""
        return self.fine.fillet_stress(k, side, pressed, zeta)

    def largest_root_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> tuple[Array, Array]:
        """Largest tension or compression up a fillet: see `SolidSolution.largest_root_stress`."""
        return self.fine.largest_root_stress(k, side, pressed, zeta)

    @cached_property
    def error(self) -> Mapping[str, float]:
        """Largest estimated relative errors over flank and face; empty without a second solution.

        Those of slices are the largest misses of `tests/golden/make_slices.py`.

        Returns
        -------
        dict of str to float
            Over contact lines between 7 and 93 % of the flank with contacts .02 modules wide to either side on hats of
            half a module: contact (under their own load alone and under an even load on the line; a single entry off
            the diagonal may be wrong by more, as waves that the polynomials hardly resolve cancel in sums), neighbour
            (of the pressed bands, over the same), root_tension and root_compression (the largest of each hat; tension
            of those above 35 % of the flank).
        """
        if self.known_error is not None:
            return read_only(self.known_error)
        if self.settings.source == "slices":
            return missed_by_slices(self.fine.tau)
        if self.coarse is None:
            return read_only({})
        found = dict.fromkeys(("contact", "neighbour", "root_tension", "root_compression"), 0.0)
        for radius, stations, high in sample_lines(self.fine):
            one, other = (contact_line(x, radius, stations) for x in (self.fine, self.coarse))
            first = line_compliance(self.fine, one, REFERENCE_HALF_WIDTH)
            apart = line_compliance(self.coarse, other, REFERENCE_HALF_WIDTH) - first
            own, even = np.diagonal(first), np.abs(apart.sum(axis=1)) / first.sum(axis=1)
            worst = {"contact": float(np.maximum(np.abs(np.diagonal(apart)) / own, even).max())}
            if self.reach:
                apart = self.fine.deflection(1, one, one) - self.coarse.deflection(1, other, other)
                worst["neighbour"] = float(np.abs(apart).max() / own.max())
            sides: tuple[tuple[Side, float, Mask], ...] = (
                ("tension", 1.0, high),
                ("compression", -1.0, np.ones_like(high)),
            )
            for side, sign, counts in sides:
                first = sign * self.fine.largest_root_stress(0, side, one, stations)[0][:, counts]
                second = sign * self.coarse.largest_root_stress(0, side, other, stations)[0][:, counts]
                if counts.any():
                    worst[f"root_{side}"] = float((curves_apart(first.T, second.T) / first.max(axis=0)).max())
            found = {key: max(value, worst.get(key, 0.0)) for key, value in found.items()}
        return read_only({key: _SHARES[key] * value for key, value in found.items()})

    def with_error(self, cache: SolutionCache) -> SolidInfluence:
        """The same with `error` found now, or recalled: all contact lines of the flank are solved for it."""
        return replace(self, known_error=cache.call_kept(_ERRORS, _error, self.fine, self.coarse).value)


def _error(fine: SolidSolution, coarse: SolidSolution | None) -> dict[str, float]:
    return dict(SolidInfluence(fine, coarse, {}).error)


def contact_line(solution: SolidSolution, radius: ArrayLike, stations: ArrayLike) -> Bands:
    """Hats on the stations of a contact line, as wide as the section resolves."""
    return hats(radius, stations, solution.band_half_width(radius), slope=solution.line_slope(radius))


def sample_lines(solution: SolidSolution) -> Iterator[tuple[Array, Array, Mask]]:
    """Contact lines all over the flank: radii, stations, and which stations stand above its foot."""
    flank, half, rb = solution.flank, 0.5 * solution.width, solution.tooth.base_radius
    steps = max(4, whole(min(solution.width / _STATION, _MOST_STATIONS)))
    stations = np.linspace(-half, half, steps + 1)
    length = flank.flank_end - flank.flank_start
    for share in _UP:
        middle = float(flank.radius_of_arc(np.array([flank.flank_start + share * length]))[0])
        side = solution.tooth.side
        rolled = side * np.sqrt(middle**2 - rb**2) - solution.tau * rb * stations
        radius = np.hypot(rb, np.maximum(side * rolled, 0.0))
        on = (radius > flank.lowest_radius) & (radius < flank.highest_radius)
        place = np.full(radius.shape, -1.0)
        place[on] = (flank.arc_of_radius(radius[on]) - flank.flank_start) / length
        on &= (place > _FOOT) & (place < 1.0 - _FOOT)
        if np.count_nonzero(on) > 1:
            yield radius[on], stations[on], place[on] > _ABOVE_FOOT


def solid_influence(
    section: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings | None = None,
    *,
    reach: int = 1,
    held: tuple[float, float] | None = None,
    body: GearBody | None = None,
    support: RimSupport | None = None,
    estimate_error: bool = True,
    cache: SolutionCache | None = None,
) -> SolidInfluence:
    """Solve a gear with a width for its influence functions.

    Parameters
    ----------
    section : InvoluteSide
        The transverse section, its lengths in modules of that section.
    tau : float
        Twist tan(beta) / r with r the radius at which the helix angle is beta [rad/module], positive for a right
        hand; 0 for a spur gear.
    width : float
        Face width [modules].
    poisson_ratio : float
    bore_radius : float
        [modules].
    settings : SolidSettings, optional
    reach : int
        K: neighbours -K..K.
    held : (float, float), optional
        Part of the face, between -width / 2 and width / 2, on which the bore is held [modules]; by default all of it.
    body : GearBody, optional
        Rim, web and hub, whose bore is held over the hub [modules]; by default a disc as wide as the face. Where its
        web has holes, one tooth or the mean over all is taken for all teeth.
    support : RimSupport, optional
        Of a ring gear's rim, pins or a spline; by default its whole outer cylinder is held.
    estimate_error : bool
        Whether to spend a part again on a coarser solution.
    cache : SolutionCache, optional
        Where solved shapes are recalled from and kept.

    Returns
    -------
    SolidInfluence

    Raises
    ------
    RangeError
        If a width, a twist, a bore or a held part cannot be meshed.
    """
    started = time.perf_counter()
    settings = settings or SolidSettings()
    check_bore(section, bore_radius)
    check_solid(section, tau, width, poisson_ratio, settings, held, reach)
    by, known = solver_of(settings), SolutionCache() if cache is None else cache
    estimate_error &= settings.source == "solid"  # that of slices is known from the gears that they were compared with

    tooth = None if body is None or body.holes is None else body.holes.tooth
    if body is not None and body.holes is not None:  # each tooth follows from one solution
        body = replace(body, holes=replace(body.holes, tooth=None))

    def solve(chosen: SolidSettings) -> SolidSolution:
        found: SolidSolution = known.call_kept(
            shape_codec(section, _KINDS), by, section, tau, width, poisson_ratio, bore_radius, chosen,
            reach=reach, held=held, body=body, support=support,
        ).value  # fmt: skip
        return found if tooth is None else known.call(as_if_all_were, found, tooth).value

    fine = solve(settings)
    coarse = solve(settings.coarser(width)) if estimate_error else None
    seconds = {**fine.seconds, "total": time.perf_counter() - started}
    return SolidInfluence(fine, coarse, read_only(seconds))
