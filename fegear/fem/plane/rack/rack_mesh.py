"""The mesh of one tooth of a rack, down to its back: its sides are straight, and fit each other one pitch on."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.fem.plane.boundary import Chain, tooth_chains
from fegear.fem.plane.edge_sizes import graded
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.geometry.rack_tooth import RackTooth

#: Bodies below the root that can be meshed [modules].
THINNEST_BODY, THICKEST_BODY = 0.25, 50.0
#: Edges beside the ends of a pin, where the back is held up to there and free beyond, as a share of those along the
#: fillet: stress has no bound there.
_PIN_END = 0.1


def rack_sector(tooth: RackTooth, body: float, settings: MeshSettings, pin_width: float = 0.0) -> SectorMesh:
    """Mesh one tooth of a rack.

    Parameters
    ----------
    tooth : RackTooth
    body : float
        From the back to the root [modules].
    settings : MeshSettings
    pin_width : float
        Part of the back, in the middle, that a pin holds [modules]; 0 for all of it.

    Returns
    -------
    SectorMesh
        Its held edges are named bore, as a gear's; those beside a pin back.

    Raises
    ------
    InputError
        If the body is too thin or too deep to be meshed.
    """
    if not THINNEST_BODY <= body <= THICKEST_BODY:
        raise InputError("body", f"{body:.6g} modules below the root",
                         f"must be between {THINNEST_BODY:g} and {THICKEST_BODY:g} modules")  # fmt: skip
    started = time.perf_counter()
    mesh = mesh_inside(rack_boundary(tooth, body, settings, pin_width), 1, started, settings.side_growth)
    mesh = replace(mesh, pitch=tooth.pitch)
    if settings.order > 2:
        check_cubic_edges(mesh)
    return mesh


def rack_boundary(tooth: RackTooth, body: float, settings: MeshSettings, pin_width: float = 0.0) -> list[Chain]:
    """Discretise the closed boundary of one sector, counterclockwise from the back on the left; as `rack_sector`."""
    pitch, (above, beyond) = tooth.pitch, tooth_chains(tooth, settings)
    top = above[0].vertices
    first = float(np.hypot(*(top[:, 1] - top[:, 0])))
    back = tooth.root_height - body
    widest = min(settings.body_fraction * pitch, settings.rim_fraction * body)
    end = _PIN_END * settings.root_edge_length

    def size(depth: Array) -> Array:
        return np.minimum(first + settings.side_growth * depth, widest)

    at = np.union1d(np.linspace(0.0, body, 513), np.geomspace(0.1 * min(first, body), body, 65))
    heights = tooth.root_height - graded(body, size, at=at)[::-1]
    heights[0], heights[-1] = back, tooth.root_height
    side_b = _upright("side_b", 0.5 * pitch, heights)
    side_a = _upright("side_a", -0.5 * pitch, heights[::-1])
    if not pin_width:
        edges = max(1, round(pitch / float(size(np.array(body)))))
        return [_level("bore", np.linspace(-0.5, 0.5, edges + 1) * pitch, back), side_b, *above, *beyond, side_a]

    def from_end(length: float) -> Array:
        fine = np.union1d(np.linspace(0.0, length, 257), np.geomspace(0.1 * end, length, 129))
        return graded(length, lambda s: np.minimum(end + settings.growth * s, widest), fewest=2, at=fine)

    half = from_end(0.5 * pin_width)
    held = np.concatenate([half[:-1] - 0.5 * pin_width, (0.5 * pin_width - half)[::-1]])
    free = 0.5 * pin_width + from_end(0.5 * (pitch - pin_width))
    free[-1] = 0.5 * pitch
    return [
        _level("back", -free[::-1], back), _level("bore", held, back), _level("back", free, back),
        side_b, *above, *beyond, side_a,
    ]  # fmt: skip


def _upright(name: str, x: float, heights: Array) -> Chain:
    return _straight(name, np.stack([np.full(heights.shape, x), heights]))


def _level(name: str, x: Array, height: float) -> Chain:
    return _straight(name, np.stack([x, np.full(x.shape, height)]))


def _straight(name: str, vertices: Array) -> Chain:
    ahead = vertices[:, -1] - vertices[:, 0]
    tangents = np.repeat((ahead / np.hypot(*ahead))[:, None], vertices.shape[1], axis=1)
    return Chain(name, vertices, 0.5 * (vertices[:, 1:] + vertices[:, :-1]), tangents)
