"""Displacement and stress of a whole solid tooth under one band, for pictures and other programs; dimensionless."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index, Mask
from fegear.base.one_thread import one_thread
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.gear_section import Section as PlaneSection
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring_closure import closed_ring
from fegear.fem.solid.bands import Bands, loads_of
from fegear.fem.solid.dissection import condense_solid
from fegear.fem.solid.extruded import SolidMesh, extruded, planes_of, with_stations
from fegear.fem.solid.face import face_functions, solid_unknowns
from fegear.fem.solid.section import HUB, Section, make_section
from fegear.fem.solid.sector import flank_nodes, section_flank, section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.body_along import BodyAlong
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide

#: Places along the face this near to each other, as a share of its width, are one.
_NEAR = 1e-6
#: Six-node triangles want edges so much shorter than those of third order.
_SIX_NODE_EDGES = 0.7


@dataclass(frozen=True)
class _AtNodes:
    """What strains at the elements' own nodes follow from: nodes, gradients and places of each element."""

    nodes: Index
    gradient: Array
    place: Array


@dataclass(frozen=True)
class _Layer:
    """Elements at one place along the face: which are material, lean of their web, length over places of their hub."""

    filled: Mask
    lean: Array | None
    stretch: Array


@dataclass(frozen=True)
class SolidField:
    """What a unit force on a band of tooth 0 does to that tooth and its neighbours; module 1, E = 1.

    Parameters
    ----------
    sector : SectorMesh
        The section's mesh, of six-node triangles.
    mesh : SolidMesh
        The tooth as wedges over its nodes.
    displacement : mapping of int to ndarray, shape (3, P)
        Of the nodes of tooth k, in the axes of its own section at z = 0.
    von_mises : mapping of int to ndarray, shape (P,)
        Equivalent stress there, averaged over the elements around a node.
    """

    sector: SectorMesh
    mesh: SolidMesh
    displacement: dict[int, Array]
    von_mises: dict[int, Array]


def solid_field(
    tooth: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings,
    band: Bands,
    stations: ArrayLike,
    *,
    reach: int = 1,
    body: GearBody | None = None,
) -> SolidField:
    """Solve the ring under one band, and everything inside the tooth.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius
        As for `solid_influence`.
    settings : SolidSettings
        Its section is meshed with six-node triangles, which other programs read; edges meant for a higher order are
        shortened.
    band : Bands
        One.
    stations : array_like, shape (L + 1,)
        Places along the face between the layers [modules].
    reach : int
        Teeth -reach .. reach.
    body : GearBody, optional
        As for `solid_influence`; its ends along the face become stations.

    Returns
    -------
    SolidField
    """
    with one_thread():
        chosen = replace(settings.section.scaled(_SIX_NODE_EDGES), order=2)
        sector = section_mesh(tooth, bore_radius, chosen, body, fewest=settings.body_layers)
        along = None if body is None else body.along(width)
        section = make_section(sector, 2, tau, poisson_ratio, tooth.base_radius, body, side=tooth.side, along=along)
        cuts = () if along is None else along.ends
        face = face_functions(
            width, settings.degree(width), cuts, settings.least_piece_degree, settings.fewer_on_pieces
        )
        known = solid_unknowns(section, face, settings, None if along is None else along.hub)
        ports = 3 * flank_nodes(section)
        sides = [(3 * nodes[:, None] + np.arange(3)).ravel() for nodes in (section.side_a, section.side_b)]
        inner = np.setdiff1d(ports, np.concatenate(sides))
        condensed = condense_solid(section, face, known, np.concatenate([*sides, inner]), expandable=True)
        ring = closed_ring(condensed, known.of(sides[0]).size, None, tooth.teeth, reach)
        loads = loads_of(band, section_flank(sector, section, tooth), face)
        numbers = sorted({k % tooth.teeth if 2 * k > tooth.teeth else k for k in range(-reach, reach + 1)})
        response = ring.field(known.of(ports), loads, numbers)
        plane = PlaneSection(
            sector.points, sector.triangles, np.empty((8, 0), dtype=np.int64),
            {(name, 0): edges for name, edges in sector.edges.items()}, tooth.teeth, closed=False,
        )  # fmt: skip
        layers = np.asarray(stations, dtype=float)
        mesh = extruded(plane, layers if along is None else with_stations(layers, along.ends), tau, body)
        elements = sector_elements(sector, order=2)
        node = elements.point_nodes
        planes = planes_of(mesh)
        nodes = elements.element_nodes
        at = _AtNodes(nodes, elements.gradients_at_nodes(), section.places[:, nodes])
        heights = np.split(mesh.points[2], np.cumsum([points.size for _, points in planes])[:-1])
        displacement, stress = {}, {}
        for k, u in response.items():
            waves = np.where(known.number >= 0, u[known.number, 0], 0.0).reshape(-1, 3, face.count)
            waves = np.einsum("ncd,ndk->nck", section.axes, waves)
            moved, von_mises = [], []
            for (z, points), height in zip(planes, heights, strict=True):
                value, slope = (x[:, 0] for x in face.at(np.array([z])))
                v, dv = waves @ value, waves @ slope
                c, s = np.cos(tau * height), np.sin(tau * height)
                x, y, axial = v[node[points]].T
                moved.append(np.stack([c * x - s * y, s * x + c * y, axial]))
                layer = _layer(section, along, z, _NEAR * width)
                von_mises.append(_von_mises(at, v, dv, tau, poisson_ratio, layer)[node[points]])
            displacement[k] = np.hstack(moved)
            stress[k] = np.concatenate(von_mises)
    return SolidField(sector, mesh, displacement, stress)


def _layer(section: Section, along: BodyAlong | None, place: float, near: float) -> _Layer:
    filled = np.array([low - near <= place <= high + near for low, high in section.spans])[section.zone]
    stretch = 1.0 if along is None else float(along.stretched(np.array(place)))
    return _Layer(filled, section.lean, np.where(section.zone == HUB, stretch, 1.0))


def _von_mises(at: _AtNodes, v: Array, slope: Array, tau: float, poisson_ratio: float, layer: _Layer) -> Array:
    """Equivalent stress at the nodes of a section, averaged over the elements of material at each, shape (N,)."""
    from fegear.fem.forms import stresses, turned_strains

    value, along = (part[at.nodes].transpose(2, 0, 1) for part in (v, slope))
    x, y = np.einsum("mnkq,cmn->kcmq", at.gradient, value, optimize=True)
    turned = tau * (at.place[1] * x - at.place[0] * y)
    along = along / layer.stretch[:, None]
    if layer.lean is not None:
        out = layer.lean[:, None] * at.place / np.hypot(*at.place)
        x, y = x + out[0] * along, y + out[1] * along
    along = along + turned
    strain = turned_strains(value, np.stack([x, y, along], axis=1), tau)[:, layer.filled].reshape(6, -1)
    around, count = at.nodes[layer.filled].ravel(), v.shape[0]
    times = np.maximum(np.bincount(around, minlength=count), 1)
    mean = np.stack([np.bincount(around, part, count) for part in strain]) / times
    xx, yy, zz, xy, xz, yz = stresses(mean, *lame(poisson_ratio, "strain"))
    squares = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + xz**2 + yz**2)
    return np.asarray(np.sqrt(squares))
