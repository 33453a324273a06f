"""Natural frequencies of a gear's body with its teeth, the bore held: the solid ring in waves round its axis.

Every motion of the ring is a sum of waves with 0, 1, 2, .. nodal diameters: one sector, whose side B moves as its side
A turned by a phase, has them all. Its matrices are the section's times the functions along the face; their lowest waves
are found by inverse iteration about zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fegear.base.arrays import Array, Index, first_of_largest
from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.base.shown import shown, shows
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.solid.face import FaceFunctions, face_functions, solid_unknowns
from fegear.fem.solid.section import Section, make_section, turned_matrices
from fegear.fem.solid.sector import section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.body_along import BodyAlong
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_tooth import InvoluteTooth

#: Functions along the face of a disc or a hub: a body's low waves are as good as linear, at most cubic, through its
#: thickness, and each module of width adds some.
_DEGREE, _PER_MODULE = 4, 0.25
#: Share of the web, or of the hub, that one layer of elements spans at most: modes bend it.
_LAYER = 0.15
#: Short pieces of the face on both sides of a web's end, as a share of the web's thickness: in the sharp corners of
#: rim, web and hub stress has no bound, and without them rims tilt 1 % too fast.
_BESIDE_ENDS = 0.12


@dataclass(frozen=True)
class BodyMode:
    """One wave; module, Young's modulus and density 1, so that the frequency is omega in sqrt(E / rho) / module.

    Parameters
    ----------
    shape : ndarray of complex, shape (3, points)
        Motion of the section's vertices of sector 0 in the middle plane of the web, radial, tangential (clockwise) and
        axial; the largest is 1. Sector k moves by exp(i 2 pi n k / z) of it. Waves with 0 < n < z / 2 come in pairs,
        turned against each other by a quarter of a wave.
    """

    shape: Array
    diameters: int = shown("", "nodal diameters n")
    frequency: float = shown("Hz", "natural frequency")
    axial: float = shown("", "kinetic energy share, axial")
    radial: float = shown("", "kinetic energy share, radial")
    tangential: float = shown("", "kinetic energy share, circumferential")

    @property
    @shows("", "main direction of motion")
    def kind(self) -> str:
        """What moves most: "axial" (umbrella, tilt), "radial" or "tangential" (torsion)."""
        shares = {"axial": self.axial, "radial": self.radial, "tangential": self.tangential}
        return max(shares, key=lambda name: shares[name])


@dataclass(frozen=True)
class BodyModes:
    """Waves of a body, ascending with their nodal diameters and frequencies, and the section that they are drawn on."""

    modes: tuple[BodyMode, ...]
    mesh: SectorMesh
    unknowns: int


def body_modes(
    tooth: InvoluteTooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    body: GearBody | None = None,
    *,
    diameters: int = 4,
    each: int = 3,
    fineness: float = 1.0,
) -> BodyModes:
    """Find the lowest natural frequencies of a gear whose bore is held.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius, settings, body
        As for `solid_influence`.
    diameters : int
        Largest number of nodal diameters, at most z / 2.
    each : int
        How many waves with each.
    fineness : float
        Layers through web and hub, and polynomials along the face, as a multiple of the usual ones.

    Returns
    -------
    BodyModes

    Raises
    ------
    InputError
        If more nodal diameters are asked for than the ring has.
    """
    from scipy.sparse.linalg import LinearOperator, eigsh, splu

    if not 0 <= diameters <= tooth.teeth // 2:
        raise InputError("diameters", diameters, f"must be between 0 and {tooth.teeth // 2}, half the number of teeth")
    with one_thread():
        mesh = section_mesh(tooth, bore_radius, settings.section, body, frontal=True, layer=_LAYER / fineness)
        along = None if body is None else body.along(width)
        section = make_section(
            mesh, settings.section.order, tau, poisson_ratio, tooth.base_radius, body, side=tooth.side, along=along
        )
        degree = max(3, round(fineness * (_DEGREE + math.ceil(_PER_MODULE * width))))
        face = face_functions(width, degree, () if along is None else _cuts(along, width))
        known = solid_unknowns(section, face, settings, None if along is None else along.hub, all_waves=True)
        stiffness, mass, parts = _matrices(mesh, section, face, known.number)
        sides = [(3 * nodes[:, None] + np.arange(3)).ravel() for nodes in (section.side_a, section.side_b)]
        at = face.values(np.array([0.0 if along is None else 0.5 * sum(along.web)]))[:, 0]
        vertices = sector_elements(mesh, settings.section.order).point_nodes[: mesh.vertex_count]
        found = []
        for n in range(diameters + 1):
            ties = _tied(known.of(sides[0]), known.of(sides[1]), known.size, 2.0 * math.pi * n / tooth.teeth)
            k, m = (ties.conj().T @ matrix @ ties for matrix in (stiffness, mass))
            factor = splu(k.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
            inverse = LinearOperator(k.shape, factor.solve, dtype=complex)
            squares, vectors = eigsh(k, each, m, sigma=0.0, v0=np.ones(k.shape[0], dtype=complex), OPinv=inverse)
            for i in np.argsort(squares):
                u = ties @ vectors[:, i]
                energy = [float((u.conj() @ (part @ u)).real) for part in parts]
                shares = [e / sum(energy) for e in energy]
                moved = np.where(known.number >= 0, u[known.number], 0.0) @ at
                shape = _polar(section, moved, vertices)
                top = shape.ravel()[first_of_largest(np.abs(shape))]
                found.append(BodyMode(shape / top, n, math.sqrt(max(float(squares[i]), 0.0)), *shares))
    return BodyModes(tuple(found), mesh, known.size)


def _cuts(body: BodyAlong, width: float) -> list[float]:
    """Where web and hub end, and a little beside each of the web's ends unless something ends there."""
    short, ends = _BESIDE_ENDS * (body.web[1] - body.web[0]), (*body.ends, -0.5 * width, 0.5 * width)
    beside = [end + way * short for end in body.web for way in (-1.0, 1.0)]
    return [*body.ends, *(place for place in beside if min(abs(place - end) for end in ends) > 0.5 * short)]


def _tied(side_a: Index, side_b: Index, size: int, phase: float) -> Any:
    """Matrix from the unknowns without those of side B to all, which follow side A's by a phase, sparse."""
    from scipy.sparse import csr_array

    free = np.setdiff1d(np.arange(size), side_b)
    place = np.full(size, -1)
    place[free] = np.arange(free.size)
    value = np.ones(size, dtype=complex)
    place[side_b], value[side_b] = place[side_a], np.exp(1j * phase)
    return csr_array((value, (np.arange(size), place)), shape=(size, free.size))


def _matrices(mesh: SectorMesh, section: Section, face: FaceFunctions, number: Index) -> tuple[Any, Any, list[Any]]:
    """Stiffness and mass of the sector's unknowns, and the mass's axial, radial and tangential parts, sparse."""
    from scipy.sparse import coo_array, kron

    from fegear.fem.forms import products

    elements = sector_elements(mesh, section.order)
    (values,) = products(elements.basis(), (0,))[0]
    known = np.flatnonzero(number.ravel() >= 0)
    order = np.argsort(number.ravel()[known])
    known = known[order]

    def assembled(matrices: Array, chosen: Array) -> Any:
        dofs = section.element_dofs[chosen]
        rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        return coo_array((matrices[chosen].ravel(), (rows.ravel(), columns.ravel())), shape=(section.size,) * 2)

    def solid(terms: list[tuple[Array, int, bool]]) -> Any:
        """Sum over the zones of section matrices times products along the face: which, and whether transposed."""
        total: Any = 0
        for zone, along in enumerate(over):
            chosen = section.zone == zone
            for matrices, which, across in terms if chosen.any() else ():
                one, other = assembled(matrices, chosen), along[which]
                part = kron(one.T, other.T) if across else kron(one, other)
                total = part + total
        return total.tocsr()[known][:, known].tocsc()

    over = section.products_along(face)
    a00, a01, a11 = section.stiffness
    stiffness = solid([(a00, 0, False), (a01, 1, False), (a01, 1, True), (a11, 2, False)])
    parts = []
    radius = section.places / np.hypot(*section.places)
    outward = np.stack([radius[0], radius[1], 0.0 * radius[0]])
    round_ = np.stack([radius[1], -radius[0], 0.0 * radius[0]])
    axes, nodes = section.axes, (section.element_dofs[:, ::3] // 3)
    for way in (np.broadcast_to(np.array([[0.0], [0.0], [1.0]]), outward.shape), outward, round_):
        seen = np.einsum("cn,ncd->nd", way, axes)[nodes]  # of each node's unknowns in that direction
        one = values[:, :, None, :, None] * seen[:, :, :, None, None] * seen[:, None, None, :, :]
        parts.append(solid([(one.reshape(values.shape[0], 3 * values.shape[1], -1), 0, False)]))
    whole = np.einsum("mij,cd->micjd", values, np.eye(3)).reshape(values.shape[0], 3 * values.shape[1], -1)
    return stiffness, solid([(turned_matrices(whole, axes[nodes]), 0, False)]), parts


def _polar(section: Section, moved: Array, nodes: Index) -> Array:
    """Radial, tangential (clockwise) and axial motion of some nodes, shape (3, n)."""
    u = np.einsum("ncd,nd->cn", section.axes[nodes], moved.reshape(-1, 3)[nodes])
    x, y = section.places[:, nodes] / np.hypot(*section.places[:, nodes])
    return np.stack([x * u[0] + y * u[1], y * u[0] - x * u[1], u[2]])
