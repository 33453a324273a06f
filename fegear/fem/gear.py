"""Influence functions of a real gear in SI, with their own error estimate and the seconds that they took."""

from __future__ import annotations

import functools
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.boundary import check_bore
from fegear.fem.influence import Influence, Side, solve_influence
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import MeshSettings
from fegear.fem.shape_cache import kept_or_solved

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.gear import Gear, Plane
    from fegear.geometry.tooth import Tooth

    Array = NDArray[np.float64]
    Progress = Callable[[str], None]

#: The second mesh of the error estimate is this much coarser everywhere.
_COARSER = 1.6
#: Share of the difference between two meshes that is taken as left in the finer one. Second-order elements would leave
#: 1 / (1.6^4 - 1) = 0.18 in energy and 0.5 in stress, but meshes that gmsh draws anew scatter about that.
_MESH_SHARE = 0.5
_SCATTER_SHARE = 1.0
#: In plane strain beyond this Poisson's ratio elements begin to lock: the order of convergence falls, more is left.
_LOCKING_RATIO, _LOCKING_SHARE = 0.45, 1.2
#: The second patch is this much wider. The patch's own error grows about linearly with its width, so a difference
#: over half a width more stands for about itself.
_WIDER = 1.5
_PATCH_SHARE = 1.2


@functools.lru_cache(maxsize=32)
def influence_of_shape(
    tooth: Tooth, bore_radius: float, poisson_ratio: float, plane: Plane, settings: MeshSettings, reach: int
) -> Influence:
    """Solve one gear shape (lengths in modules); equal shapes in a process are solved once."""

    def solve() -> Influence:
        return solve_influence(
            tooth,
            mesh_sector(tooth, bore_radius, settings),
            poisson_ratio,
            plane,
            order=settings.order,
            reach=reach,
            corner_distance=settings.corner_distance,
        )

    return kept_or_solved(tooth, (bore_radius, poisson_ratio, plane, settings, reach), solve)


@dataclass(frozen=True)
class GearInfluence:
    """Compliance and root-stress influence of one gear, per unit face width, in SI.

    Parameters
    ----------
    gear : Gear
    fine : Influence
        The solution that every number comes from.
    coarse : Influence
        A cheaper (or, on a user's own mesh, a higher-order) one whose difference tells the error of `fine`.
    share : float
        Part of that difference taken as the error of `fine`.
    settings : MeshSettings
    seconds : mapping of str to float
    """

    gear: Gear
    fine: Influence
    coarse: Influence | None
    share: float
    settings: MeshSettings
    seconds: Mapping[str, float]

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside the loaded one are known."""
        return self.fine.reach

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts [m]."""
        return self.fine.flank.lowest_radius * self.gear.module

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends [m]."""
        return self.fine.flank.highest_radius * self.gear.module

    @property
    def patch_half_width(self) -> float:
        """Half-width of the pressure that loaded the mesh [m]."""
        return self.settings.patch_half_width * self.gear.module

    @property
    def log_slope(self) -> float:
        """2 (1 - nu^2) / (pi E) (no nu in plane stress) [1/Pa]: d c_0 / d ln(1 / half-width)."""
        return self.fine.log_slope / self.gear.material.young_modulus

    def _modules(self, radius: ArrayLike) -> Array:
        return np.atleast_1d(np.asarray(radius, dtype=float)) / self.gear.module

    def self_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0(p, p) of a contact with a given half-width.

        Parameters
        ----------
        radius : array_like, shape (P,)
            Contact radius [m].
        half_width : array_like
            Half-width of the contact [m], broadcast against `radius`.

        Returns
        -------
        ndarray, shape (P,)
            [m^2/N].
        """
        b = np.asarray(half_width, dtype=float) / self.gear.module
        c = self.fine.self_compliance(self._modules(radius), self.settings.patch_half_width, b)
        return c / self.gear.material.young_modulus

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q): deflection at p of tooth k per unit line load at q of tooth 0, shape (P, Q) [m^2/N]."""
        a = self.settings.patch_half_width
        c = self.fine.neighbour(k, self._modules(radius_p), self._modules(radius_q), a)
        return c / self.gear.material.young_modulus

    def fillet_stress(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Tangential stress along a fillet of tooth k per unit line load on tooth 0, shape (points, P) [1/m]."""
        r = self._modules(radius)
        return self.fine.fillet_stress(k, side, r, self.settings.patch_half_width) / self.gear.module

    def largest_root_stress(self, k: int, side: Side, radius: ArrayLike) -> tuple[Array, Array]:
        """Largest root tension or compression per unit line load [1/m] and its arc length from the root land [m]."""
        m = self.gear.module
        value, arc = self.fine.largest_root_stress(k, side, self._modules(radius), self.settings.patch_half_width)
        return value / m, arc * m

    def self_error(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """Estimated error of `self_compliance` [m^2/N]: what a second mesh and a wider patch change."""
        r, b = self._modules(radius), np.asarray(half_width, dtype=float) / self.gear.module
        a = self.settings.patch_half_width
        c = self.fine.self_compliance(r, a, b)
        error = _PATCH_SHARE * np.abs(self.fine.self_compliance(r, _WIDER * a, b) - c)
        if self.coarse is not None:
            error = error + self.share * np.abs(self.coarse.self_compliance(r, a, b) - c)
        return error / self.gear.material.young_modulus

    def neighbour_error(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Estimated error of `neighbour` [m^2/N], shape (P, Q)."""
        if self.coarse is None:
            return np.full((np.size(radius_p), np.size(radius_q)), np.nan)
        a = self.settings.patch_half_width

        def difference(p: Array, q: Array) -> Array:
            return np.abs(self.fine.neighbour(k, p, q, a) - self._other.neighbour(k, p, q, a))

        usual = _root_mean_square(difference(self._samples, self._samples))
        own = difference(self._modules(radius_p), self._modules(radius_q))
        return _SCATTER_SHARE * np.maximum(own, usual) / self.gear.material.young_modulus

    def root_stress_error(self, k: int, side: Side, radius: ArrayLike) -> Array:
        """Estimated error of `largest_root_stress` [1/m], shape (P,)."""
        if self.coarse is None:
            return np.full(np.size(radius), np.nan)
        a = self.settings.patch_half_width

        def both(r: Array) -> tuple[Array, Array]:
            fine, other = (i.largest_root_stress(k, side, r, a)[0] for i in (self.fine, self._other))
            return fine, np.abs(fine - other)

        value, difference = both(self._modules(radius))
        usual = _root_mean_square(np.divide(*both(self._samples)[::-1]))
        return _SCATTER_SHARE * np.maximum(difference, usual * np.abs(value)) / self.gear.module

    @property
    def _other(self) -> Influence:
        return self.fine if self.coarse is None else self.coarse

    @property
    def _samples(self) -> Array:
        """Radii over the flank at which the usual difference of two meshes is taken [modules]."""
        low, high = self.fine.flank.lowest_radius, self.fine.flank.highest_radius
        return np.linspace(low + 0.05 * (high - low), high, 12)


def _root_mean_square(values: Array) -> float:
    """One position's difference may vanish by chance; the mean over the flank does not."""
    return float(np.sqrt(np.mean(values**2)))


def solve_gear(
    gear: Gear,
    settings: MeshSettings | None = None,
    *,
    reach: int = 1,
    estimate_error: bool = True,
    mesh: SectorMesh | None = None,
    progress: Progress | None = None,
) -> GearInfluence:
    """Solve a gear for its influence functions.

    Parameters
    ----------
    gear : Gear
    settings : MeshSettings, optional
    reach : int
        K: neighbours -K..K.
    estimate_error : bool
        Whether to spend about half as much again on a second solution.
    mesh : SectorMesh, optional
        A user's own sector mesh (in modules) instead of the generated one; its error is estimated with elements one
        order higher.
    progress : callable, optional
        Called with the name of each stage as it starts.

    Returns
    -------
    GearInfluence

    Raises
    ------
    RangeError
        If the bore lies too near the centre or the outline to be meshed.
    """
    started = time.perf_counter()
    settings = settings or MeshSettings()
    say = progress or (lambda _stage: None)
    material = gear.material
    shape = (gear.tooth, gear.bore_radius / gear.module, material.poisson_ratio, gear.plane_assumption)
    coarse: Influence | None = None
    if mesh is not None:
        say("influence functions on the given mesh")
        _, _, nu, plane = shape
        orders = (settings.order, min(settings.order + 1, 4) if settings.order < 4 else 3)

        def solve(order: int) -> Influence:
            closest = settings.corner_distance
            return kept_or_solved(
                gear.tooth,
                (mesh, nu, plane, order, reach, closest),
                lambda: solve_influence(gear.tooth, mesh, nu, plane, order=order, reach=reach, corner_distance=closest),
            )

        found = [solve(p) for p in (orders if estimate_error else orders[:1])]
        fine, coarse, share = found[0], found[-1] if estimate_error else None, 1.0
    else:
        check_bore(gear.tooth, gear.bore_radius / gear.module, gear.module)
        say("influence functions")
        locking = gear.plane_assumption == "strain" and material.poisson_ratio > _LOCKING_RATIO
        fine, share = influence_of_shape(*shape, settings, reach), _LOCKING_SHARE if locking else _MESH_SHARE
        if estimate_error:
            say("influence functions on a coarser mesh, for the error")
            coarse = influence_of_shape(*shape, settings.scaled(_COARSER), reach)
    seconds = {**fine.seconds, "total": time.perf_counter() - started}
    return GearInfluence(gear, fine, coarse, share, replace(settings), seconds)
