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
SIDES: tuple[Side, ...] = ("tension", "compression")
#: A contact's usual half-width [modules], at which what depends on it is told.
REFERENCE_HALF_WIDTH = 0.02

#: Half-width of a load that is as good as concentrated [modules].
_POINT = 1e-4
#: A pressure wider than usual takes no more than this share of a contact's height above the fillet.
_FILLET_SHARE = 0.25
#: Nearer to a contact than this [modules] a fillet's stress is the contact's own.
_BESIDE_CONTACT = 0.1
#: The narrower of the two pressures that load the mesh, as a share of the wider one.
_NARROWER = 0.5
#: The wider pressure takes this share of the room to the nearest corner or curvature jump: what the corner does to it
#: goes with the square of that share, which is taken out, and then with higher powers of it.
_ROOM_SHARE = 0.7
#: Mean distance of two points of a semi-elliptic pressure, and of one from its centre, over its half-width.
_MEAN, _CENTRE = 256.0 / (45.0 * np.pi**2), 4.0 / (3.0 * np.pi)


def log_slope(poisson_ratio: float, plane: Plane) -> float:
    """Change of a body's approach with the logarithm of the contact's half-width, per unit line load, E = 1.

    Two semi-elliptic pressures of the same load on a half-plane differ at their centre by exactly
    2 (1 - nu^2) / (pi E) ln(a / b) (plane strain; without the nu in plane stress); Johnson, Contact Mechanics, 4.2.
    """
    return 2.0 * (1.0 - poisson_ratio**2 if plane == "strain" else 1.0) / np.pi


def curvature_slope(poisson_ratio: float, plane: Plane) -> float:
    """How the deflection near a line load on a convex surface of curvature 1/rho departs from the half-plane's, E = 1.

    At a distance s it is larger by curvature_slope * s / rho. The exact disc under pressure of n waves round its rim
    deflects (1/(n - 1) + (3 - 4 nu)/(n + 1)) (1 + nu)/2 (from Michell's stress function; Barber, Elasticity, table
    9.1). Its 1/n is the half-plane's logarithm; its 1/n^2, which vanishes with 1 - 2 nu, is this.
    """
    nu = poisson_ratio
    return 0.5 * (1.0 - 2.0 * nu) * (1.0 + nu) if plane == "strain" else 0.5 * (1.0 - nu)


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
        """Arc position and half-width of the wider pressure that models a contact at `radius`, shape (P,) each.

        Near a corner of the flank, or where the fillet's curvature begins, the patch is narrowed to a part of the room
        there is; a contact at the corner itself is modelled at the corner distance inside it. [modules]
        """
        arc, room = self._room(radius)
        return arc, np.maximum(np.minimum(patch, _ROOM_SHARE * room), self.corner_distance)

    def _room(self, radius: ArrayLike) -> tuple[Array, Array]:
        """Arc position of contacts, off the corners, and the room on either side of them, shape (P,) each [modules]."""
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        low, high, closest = self.flank.flank_start, self.flank.flank_end, self.corner_distance
        # A tip rounded by less than the corner distance is a corner still: the flank's end is as far off as is missing.
        arc = np.minimum(arc, high - max(closest - self.flank.beyond, 0.0))
        if self.flank.lower_corner:
            arc = np.maximum(arc, low + closest)
        return arc, np.maximum(np.minimum(arc - low, high - arc), closest)

    def _remote(self, radius: ArrayLike, patch: float) -> Array:
        """Loads in their exact place for effects away from the contact, where a narrow patch needs no resolution."""
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        room = np.minimum(arc - self.flank.flank_start, self.flank.flank_end - arc)
        return self._mixed(arc, np.minimum(patch, room), 0.0)

    def _beside_fillet(self, radius: ArrayLike, patch: float) -> Array:
        """Loads for the stress in the fillet: contacts of the usual width, told from wider ones where there is room."""
        arc = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius, dtype=float)))
        above = arc - self.flank.flank_start
        wide = np.maximum(np.minimum(patch, _FILLET_SHARE * above), REFERENCE_HALF_WIDTH)
        return self._mixed(arc, np.minimum(wide, self.flank.flank_end - arc), REFERENCE_HALF_WIDTH)

    def _mixed(self, arc: Array, wide: Array, half_width: float) -> Array:
        """Two pressures in such a mixture that the second moment is that of a half-width: the same, seen from afar."""
        low, high = self.flank.arc[0] + _POINT, self.flank.arc[-1] - _POINT
        wide = np.maximum(wide, _POINT)
        narrow = np.maximum(_NARROWER * wide, 0.5 * _POINT)
        loads = self.flank.patches(np.tile(np.clip(arc, low, high), 2), np.concatenate([wide, narrow]))
        share = (np.minimum(half_width, wide) ** 2 - narrow**2) / (wide**2 - narrow**2)
        return share * loads[:, : arc.size] + (1.0 - share) * loads[:, arc.size :]

    def self_compliance(self, radius: ArrayLike, patch: float, half_width: ArrayLike | None = None) -> Array:
        """Deflection at the centre of a contact under its own unit line load, shape (P,) [1/E].

        Parameters
        ----------
        radius : array_like, shape (P,)
            [modules].
        patch : float
            Half-width of the wider of the two pressures that load the mesh [modules].
        half_width : array_like, optional
            Half-width of the true contact [modules], by default `patch`.

        Notes
        -----
        What depends on the width of a narrow contact is known in closed form: the half-plane's logarithm and, on a
        flank of curvature 1/rho, `curvature_slope` times width / rho. What is left varies with the square of the
        width; the two pressures give that, and the value at the true width follows. The pressure-weighted mean
        deflection is used, which converges at twice the order of the deflection at a point; the centre of a contact
        lies log_slope / 4 deeper whatever its width.
        """
        wanted = np.asarray(patch if half_width is None else half_width, dtype=float)
        arc, room = self._room(radius)
        _, wide = self.place(radius, patch)
        curvature = self._curvature(arc)
        (regular_wide, regular_narrow), narrow = self._regular(arc, wide, curvature), _NARROWER * wide
        square = (regular_wide - regular_narrow) / (wide**2 - narrow**2)
        regular = regular_narrow + square * (np.minimum(wanted, room) ** 2 - narrow**2)
        return regular - self.log_slope * np.log(wanted) + self.curvature_slope * curvature * _CENTRE * wanted

    def _regular(self, arc: Array, wide: Array, curvature: Array) -> tuple[Array, Array]:
        """What two pressures leave of c_0 without what depends on their width in closed form, shape (P,) each."""
        places, widths = np.concatenate([arc, arc]), np.concatenate([wide, _NARROWER * wide])
        loads = self.flank.patches(places, widths)
        mean = np.einsum("ip,ip->p", loads, self.compliance[0] @ loads)
        bend = self.curvature_slope * _MEAN * np.tile(curvature, 2) * widths
        both = mean + self.log_slope * (0.25 + np.log(widths)) - bend
        return both[: arc.size], both[arc.size :]

    @property
    def curvature_slope(self) -> float:
        """See `curvature_slope`."""
        return curvature_slope(self.poisson_ratio, self.plane)

    def _curvature(self, arc: Array) -> Array:
        """Curvature of the flank, no nearer to its start than the corner distance, shape (P,) [1/module]."""
        inside = np.maximum(arc - self.flank.flank_start, self.corner_distance) + self.flank.flank_start
        run = self.flank.arc[self.flank.first_flank_edge : self.flank.after_flank_edge + 1]
        return np.asarray(1.0 / (self.flank.base_radius * np.sqrt(np.interp(inside, run, self.flank.roll_squared))))

    def centre_compliance(self, radius: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 read at the centre of a patch as wide as the contact itself, as far as the mesh resolves it: a check."""
        arc, _ = self._room(radius)
        loads = self.flank.patches(arc, np.broadcast_to(half_width, arc.shape))
        return np.asarray(np.einsum("ip,ip->p", self.flank.deflections_at(arc), self.compliance[0] @ loads))

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
        """Largest tension (or compression) of a fillet and the arc length where it sits, shape (Q,) each.

        Within a tenth of a module of the contact the fillet feels its pressure, which is no root stress: there the
        largest value is not looked for.
        """
        fillet = self.fillets[side]
        end = np.full(np.size(radius_q), fillet.length)
        if k == 0 and side == "tension":
            above = np.atleast_1d(self.flank.arc_of_radius(np.asarray(radius_q, dtype=float))) - self.flank.flank_start
            end -= np.maximum(_BESIDE_CONTACT - above, 0.0)
        return extreme(
            self.fillet_stress(k, side, radius_q, patch), fillet.arc, 1.0 if side == "tension" else -1.0, end
        )


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
    import scipy.linalg  # noqa: F401  (loaded before it is limited: scipy brings a BLAS of its own)
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
