"""Influence functions of one gear with a width, with their error estimate and the seconds that they took."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.boundary import check_bore
from fegear.fem.settings import MeshSettings
from fegear.fem.shape_cache import known_or_solved
from fegear.fem.solid.bands import Bands, bands, hats
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.plausible import check_solid
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import SolidSolution, solve_solid
from fegear.fem.trace import LoadedFlank
from fegear.solution_cache import SolutionCache

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.fem.influence import Side
    from fegear.geometry.tooth import Tooth

#: What a solution consists of, for those that keep it.
_KINDS = (SolidSolution, FaceFunctions, LoadedFlank, SolidFillet, SolidSettings, MeshSettings)
#: Where errors are looked for: shares of the flank's length and of the width.
_UP, _ALONG = (0.15, 0.4, 0.65, 0.85), (-1.0, -0.6, 0.0, 0.5, 1.0)
#: How far the hats reach at which errors are looked for [modules].
_HAT = 0.5


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
    """

    fine: SolidSolution
    coarse: SolidSolution | None
    seconds: Mapping[str, float]

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

    def fillet_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> Array:
        """Surface stress of a fillet: see `SolidSolution.fillet_stress`."""
        return self.fine.fillet_stress(k, side, pressed, zeta)

    def largest_root_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> tuple[Array, Array]:
        """Largest tension or compression up a fillet: see `SolidSolution.largest_root_stress`."""
        return self.fine.largest_root_stress(k, side, pressed, zeta)

    @cached_property
    def error(self) -> Mapping[str, float]:
        """Largest estimated relative errors over flank and face; empty without a second solution.

        Returns
        -------
        dict of str to float
            deflection (of hats half a module to either side, under their own load), neighbour (over the same),
            root_tension and root_compression (of the largest of each hat).
        """
        if self.coarse is None:
            return MappingProxyType({})
        one, other = self.fine, self.coarse
        sample = sample_hats(one)
        first, second = one.deflection(0, sample, sample), other.deflection(0, sample, sample)
        own = np.diagonal(first)
        found = {"deflection": float((np.abs(np.diagonal(second - first)) / own).max())}
        if self.reach:
            off = np.abs(one.deflection(1, sample, sample) - other.deflection(1, sample, sample))
            found["neighbour"] = float((off / own).max())
        zeta = np.linspace(-0.5, 0.5, 9) * self.width
        for side in ("tension", "compression"):
            a, b = (x.largest_root_stress(0, side, sample, zeta)[0] for x in (one, other))
            found[f"root_{side}"] = float((np.abs(b - a).max(axis=0) / np.abs(a).max(axis=0)).max())
        return MappingProxyType(found)


def contact_line(solution: SolidSolution, radius: ArrayLike, stations: ArrayLike) -> Bands:
    """Hats on the stations of a contact line, as wide as the section resolves."""
    return hats(radius, stations, solution.band_half_width(radius), slope=solution.line_slope(radius))


def sample_hats(solution: SolidSolution) -> Bands:
    """Hats all over the flank, of half a module to either side at most."""
    flank, half = solution.flank, 0.5 * solution.width
    arc = flank.flank_start + np.array(_UP) * (flank.flank_end - flank.flank_start)
    radius, z = np.meshgrid(flank.radius_of_arc(arc), half * np.array(_ALONG), indexing="ij")
    before, after = np.minimum(_HAT, half + z), np.minimum(_HAT, half - z)
    return bands(radius, z, before, solution.band_half_width(radius.ravel()).reshape(z.shape), after=after)


def solid_influence(
    section: Tooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings | None = None,
    *,
    reach: int = 1,
    held: tuple[float, float] | None = None,
    estimate_error: bool = True,
    cache: SolutionCache | None = None,
) -> SolidInfluence:
    """Solve a gear with a width for its influence functions.

    Parameters
    ----------
    section : Tooth
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
    check_solid(section, tau, width, poisson_ratio, settings, held)

    def solve(chosen: SolidSettings) -> SolidSolution:
        return known_or_solved(
            cache or SolutionCache(),
            section,
            ("solid", tau, width, poisson_ratio, bore_radius, chosen, reach, held),
            lambda: solve_solid(section, tau, width, poisson_ratio, bore_radius, chosen, reach=reach, held=held),
            _KINDS,
        )

    fine = solve(settings)
    coarse = solve(settings.coarser()) if estimate_error else None
    seconds = {**fine.seconds, "total": time.perf_counter() - started}
    return SolidInfluence(fine, coarse, MappingProxyType(seconds))
