"""Influence functions of a gear's teeth, from one factored ring; dimensionless (module 1, Young's modulus 1)."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.fem.elasticity import assemble
from fegear.fem.ring import close_ring
from fegear.fem.root_stress import FilletStrain, extreme, fillet_strain
from fegear.fem.trace import LoadedFlank, loaded_flank
from fegear.tally import tallied

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.gear import Plane
    from fegear.geometry.tooth import Tooth

    Array = NDArray[np.float64]

Side = Literal["tension", "compression"]

#: Half-width of a load that is as good as concentrated [modules].
_POINT = 1e-4


def log_slope(poisson_ratio: float, plane: Plane) -> float:
    """Change of a body's approach with the logarithm of the contact's half-width, per unit line load, E = 1.

    Two semi-elliptic pressures of the same load on a half-plane differ at their centre by exactly
    2 (1 - nu^2) / (pi E) ln(a / b) (plane strain; without the nu in plane stress); Johnson, Contact Mechanics, 4.2.
    """
    return 2.0 * (1.0 - poisson_ratio**2 if plane == "strain" else 1.0) / np.pi


@dataclass(frozen=True)
class Influence:
    """c_k(p, q) and root-stress influence of one gear shape, ready for any position and contact width.

    Parameters
    ----------
    tooth : Tooth
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
        Contacts nearer than this to a corner of the flank are modelled at this distance [modules].
    reach : int
        K: neighbours -K..K are known. Tooth k = +1 lies clockwise of tooth 0, on the side that the load comes from.
    unknowns : int
        Size of the sector's system.
    seconds : mapping of str to float
    """

    tooth: Tooth
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
    seconds: Mapping[str, float]

    @property
    def log_slope(self) -> float:
        """See `log_slope`."""
        return log_slope(self.poisson_ratio, self.plane)

    def place(self, radius: ArrayLike, patch: ArrayLike) -> tuple[Array, Array]:
        """Arc position and half-width of the pressure that models a contact at `radius`, shape (P,) each [modules].

        Near a corner of the flank, or where the fillet's curvature begins, the patch is narrowed to the room there
        is; a contact at the corner itself is modelled at the corner distance inside it.
        """
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        low, high, closest = self.flank.flank_start, self.flank.flank_end, self.corner_distance
        # A tip rounded by less than the corner distance is a corner still: the flank's end is as far off as is missing.
        arc = np.minimum(arc, high - max(closest - self.flank.beyond, 0.0))
        if self.flank.lower_corner:
            arc = np.maximum(arc, low + closest)
        room = np.minimum(arc - low, high - arc)
        return arc, np.maximum(np.minimum(patch, room), closest)

    def _remote(self, radius: ArrayLike, patch: float) -> Array:
        """Loads in their exact place for effects away from the contact, where a narrow patch needs no resolution."""
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        low, high = self.flank.arc[0] + _POINT, self.flank.arc[-1] - _POINT
        room = np.minimum(arc - self.flank.flank_start, self.flank.flank_end - arc)
        return self.flank.patches(np.clip(arc, low, high), np.maximum(np.minimum(patch, room), _POINT))

    def _beside_fillet(self, radius: ArrayLike, patch: float) -> Array:
        """As `_remote`, but no narrower near the fillet, where the strain is read, than the mesh resolves."""
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        low, high = self.flank.arc[0] + _POINT, self.flank.arc[-1] - _POINT
        width = np.minimum(patch, np.maximum(arc - self.flank.flank_start, 2.0 * self.corner_distance))
        return self.flank.patches(
            np.clip(arc, low, high), np.maximum(np.minimum(width, self.flank.flank_end - arc), _POINT)
        )

    def self_compliance(self, radius: ArrayLike, patch: ArrayLike, half_width: ArrayLike | None = None) -> Array:
        """Deflection at the centre of a contact under its own unit line load, shape (P,) [1/E].

        Parameters
        ----------
        radius : array_like, shape (P,)
            [modules].
        patch : array_like
            Half-width of the pressure that loads the mesh [modules].
        half_width : array_like, optional
            Half-width of the true contact [modules], by default `patch`: the difference is added in closed form.

        Notes
        -----
        The pressure-weighted mean deflection converges at twice the order of the deflection at a point. In the
        contact the surface moves as a parabola whose mean lies 1/4 of its sagitta below the centre's, which for the
        half-plane is log_slope / 4 whatever the width; that is added.
        """
        arc, a = self.place(radius, patch)
        wanted = np.asarray(patch if half_width is None else half_width, dtype=float)
        loads = self.flank.patches(arc, a)
        mean = np.einsum("ip,ij,jp->p", loads, self.compliance[0], loads, optimize=True)
        return mean + self.log_slope * (0.25 + np.log(a / wanted))

    def centre_compliance(self, radius: ArrayLike, patch: ArrayLike) -> Array:
        """As `self_compliance`, but reading the deflection at the patch's centre: an independent check of the mesh."""
        arc, a = self.place(radius, patch)
        at, loads = self.flank.deflections_at(arc), self.flank.patches(arc, a)
        here = np.einsum("ip,ij,jp->p", at, self.compliance[0], loads, optimize=True)
        return here + self.log_slope * np.log(a / np.asarray(patch, dtype=float))

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike, patch: float) -> Array:
        """c_k(p, q): deflection at p of tooth k under a unit line load at q of tooth 0, shape (P, Q) [1/E].

        Weighted with the pressure of a contact at p, so that c_k(p, q) = c_-k(q, p) to round-off.
        """
        return self._remote(radius_p, patch).T @ self.compliance[k] @ self._remote(radius_q, patch)

    def fillet_stress(self, k: int, side: Side, radius_q: ArrayLike, patch: float) -> Array:
        """Tangential stress along a fillet of tooth k per unit line load at q of tooth 0, shape (points, Q) [1/module].

        The tension fillet is the one below the loaded flank.
        """
        return self.stress[k, side] @ self._beside_fillet(radius_q, patch)

    def largest_root_stress(self, k: int, side: Side, radius_q: ArrayLike, patch: float) -> tuple[Array, Array]:
        """Largest tension (or compression) of a fillet and the arc length where it sits, shape (Q,) each."""
        sign = 1.0 if side == "tension" else -1.0
        return extreme(self.fillet_stress(k, side, radius_q, patch), self.fillets[side].arc, sign)


@tallied("tooth shapes")
def solve_influence(
    tooth: Tooth,
    mesh: SectorMesh,
    poisson_ratio: float,
    plane: Plane,
    *,
    order: int = 2,
    reach: int = 1,
    corner_distance: float = 0.02,
    margin: float = 0.15,
    sector_teeth: int = 0,
) -> Influence:
    """Solve one ring for all that can be asked of its teeth.

    Parameters
    ----------
    tooth : Tooth
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    order : {2, 3, 4}
    reach : int
        K: neighbours -K..K; at most (z - 1) // 2.
    corner_distance : float
        Contacts nearer than this to a corner of the flank are modelled at this distance [modules].
    margin : float
        How far below the flank a patch may reach into the fillet [modules].
    sector_teeth : int
        Solve a sector of so many teeth with free sides, loaded in the middle, instead of the ring; the reach is then
        at most (sector_teeth - 1) // 2.

    Returns
    -------
    Influence
    """
    # Loaded before it is limited: scipy brings a BLAS of its own.
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_limits

    # Many small dense matrices: on a busy machine a second BLAS thread makes them ten times slower, never faster.
    with threadpool_limits(limits=1, user_api="blas"):
        return _solve(tooth, mesh, poisson_ratio, plane, order, reach, corner_distance, margin, sector_teeth)


def _solve(
    tooth: Tooth,
    mesh: SectorMesh,
    poisson_ratio: float,
    plane: Plane,
    order: int,
    reach: int,
    corner_distance: float,
    margin: float,
    sector_teeth: int,
) -> Influence:
    started = time.perf_counter()
    reach = min(reach, ((sector_teeth or tooth.teeth) - 1) // 2)
    elasticity = assemble(mesh, poisson_ratio, plane, order)
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    fillets: dict[Side, FilletStrain] = {
        "tension": fillet_strain(mesh, elasticity, "fillet"),
        "compression": fillet_strain(mesh, elasticity, "back_fillet"),
    }
    assembled = time.perf_counter()
    watch = np.concatenate([flank.dofs, fillets["tension"].dofs, fillets["compression"].dofs])
    ring = close_ring(mesh, elasticity, watch, reach, sector_teeth=sector_teeth)
    closed = time.perf_counter()
    response = ring.respond(flank.dofs, watch)
    n, t = flank.dofs.size, fillets["tension"].dofs.size
    modulus = 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0
    compliance: dict[int, Array] = {}
    stress: dict[tuple[int, Side], Array] = {}
    for k, u in response.items():
        compliance[k] = np.ascontiguousarray(u[:n])  # as it comes back from a file, so that sums run in one order
        stress[k, "tension"] = modulus * (fillets["tension"].strain @ u[n : n + t])
        stress[k, "compression"] = modulus * (fillets["compression"].strain @ u[n + t :])
    solved = time.perf_counter()
    seconds = {
        "mesh": mesh.seconds,
        "assembly": assembled - started,
        **ring.seconds,
        "influence": solved - closed,
    }
    return Influence(
        tooth, poisson_ratio, plane, mesh, flank, compliance, fillets, stress,
        corner_distance, reach, ring.size, seconds,
    )  # fmt: skip
