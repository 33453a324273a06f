"""Bands that press on the teeth of a rack that is meshed in 3D, its section slid along its helix."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.solid.extruded import band_forces

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.solid.extruded import SolidMesh
    from fegear.geometry.rack_tooth import RackTooth


def pressed_band_on_rack(
    mesh: SolidMesh, tooth: RackTooth, height: float, half_width: float, hat: tuple[float, float, float], number: int
) -> Array:
    """Nodal forces of a band that presses on the right flank of a tooth of a rack.

    Parameters
    ----------
    mesh : SolidMesh
        Of a `rack_section`, with stations at the hat's ends and its top.
    tooth : RackTooth
        The transverse section.
    height : float
        Of the middle of the band above the reference line [modules].
    half_width, hat : float
        As of `pressed_band`.
    number : int
        Of the tooth, from 0.

    Returns
    -------
    ndarray, shape (3, P)
        As of `pressed_band`.

    Raises
    ------
    RangeError
        As of `pressed_band`.
    """
    flank, cos = mesh.section.boundaries["flank", number], math.cos(tooth.pressure_angle)
    y = mesh.section.points[1]
    up = np.where(y[flank[0]] < y[flank[1]], flank, flank[[1, 0, 2]])
    edges = up[:, np.argsort(y[up[2]])]
    arc = (np.append(y[edges[0]], y[edges[1, -1]]) - tooth.form_height) / cos
    normal = np.array([-cos, -math.sin(tooth.pressure_angle), mesh.slide * cos])

    def inward(along: Array, zeta: Array) -> Array:
        shape = (zeta.shape[0], *along.shape, zeta.shape[1])
        return np.asarray(np.broadcast_to(normal[:, None, None, None, None], (3, *shape)))

    return band_forces(mesh, edges, arc, (height - tooth.form_height) / cos, half_width, hat, inward)
